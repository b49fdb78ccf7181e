// From the voxels that are touched to those that a rule fills, with materials of what one sees.
//
// A filled voxel keeps its material, but for two cases:
//
// - No surface passes it, and a voxel beside it is not filled: it takes the material of that one, whose surface shows.
// - A thin part that gets no voxel of its own lies on it: a voxel with surface of an object is not filled, no filled
//   one among its 26 neighbours has surface of the object, and none beside it is filled without surface. It gives its
//   material to the voxels beside it.
//
// Of several voxels beside it, the first along -x, +x, -y, +y, -z, +z gives its material.
#pragma once

#include "../grid/sparse_voxels.h"
#include "../work/workers.h"
#include "rule.h"
#include "rule_brick.h"

#include <vector>

namespace voxrt::voxelize {

/// What the tiles of a rule found.
struct RuleFindings {
    std::vector<RuleBrick> bricks;
    std::vector<OwnedSurface> owned;
};

/// Bricks x0 <= x < x1, y0 <= y < y1.
struct BrickArea {
    uint32_t x0, x1, y0, y1;
};

/// Takes from `voxels` what is not filled, and adds to `lost`, by object, how many voxels these were.
///
/// `voxels`: those that are touched, within `area`. `around`: the same with those near the area, up to kThinReach;
/// `findings` are of them.
void apply_rule(SparseVoxels& voxels, const SparseVoxels& around, RuleFindings findings, const BrickArea& area,
                Thin thin, std::vector<int64_t>& lost, const Workers& workers);

} // namespace voxrt::voxelize
