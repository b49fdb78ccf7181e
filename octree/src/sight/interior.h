// Hidden voxels given other materials: no ray can tell.
#pragma once

#include "../words/memory.h"

#include <vector>

namespace voxrt::octree {

/// `memory` with its voxels that are solid in `hidden` made of `material`. Linear in the pairs of blocks that lie
/// in one place. Throws std::invalid_argument where the depths differ or words are no octree.
Words fill_hidden(const Memory& memory, const Memory& hidden, std::uint8_t material);

/// `memory` with each voxel that is solid in `hidden` made of whatever material lets most blocks be shared; it stays
/// solid. Depends on the voxels alone. Throws as above.
///
/// Hidden voxels are don't-cares. Two blocks that agree wherever both are specified become one: the problem of Shiple,
/// Hojati, Sangiovanni-Vincentelli and Brayton, "Heuristic Minimization of BDDs Using Don't Cares" (1994), on octrees.
/// The merging is greedy, from the leaves up (dont_care.h), and can undo sharing; so the result is the smallest of that
/// one, of the same with often shown blocks left alone, of one material for all hidden voxels, and of `memory` itself.
Words share_hidden(const Memory& memory, const Memory& hidden);

} // namespace voxrt::octree
