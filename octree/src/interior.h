// Hidden voxels put to use: no ray tells what material they have.
#pragma once

#include <vector>

#include "memory.h"

namespace voxrt::octree {

/// `memory` with its voxels that are solid in `hidden` made of `material`. Linear in the pairs of blocks that lie in
/// one place. Throws std::invalid_argument where the depths differ. The GIL must not be held.
std::vector<Word> fill_hidden(const Memory& memory, const Memory& hidden, std::uint8_t material);

/// `memory` with each voxel that is solid in `hidden` made of whatever material lets most blocks be shared; it stays
/// solid. Depends on the voxels alone. Throws as above. The GIL must not be held.
///
/// Blocks with voxels that may be anything are incompletely specified, and two of them that contradict each other
/// nowhere become one: the problem of Shiple, Hojati, Sangiovanni-Vincentelli and Brayton, "Heuristic Minimization of
/// BDDs Using Don't Cares" (1994), on octrees. Greedy, from the leaves up (dont_care.h), which can spoil what was
/// shared well; so the smallest is taken of that, of the same with often shown blocks left alone, of one material for
/// all hidden voxels, and of `memory` itself.
std::vector<Word> share_hidden(const Memory& memory, const Memory& hidden);

} // namespace voxrt::octree
