// From the voxels that are touched to those that a rule fills, with materials of what one sees.
//
// A filled voxel keeps its material, unless one sees another one there:
//
// - A thin part that gets no voxel of its own lies on it: a voxel with surface of an object is not filled, no filled
//   one among its 26 neighbours has surface of the object, and none beside it is filled without surface. It gives its
//   material to the voxels beside it; of several, the first along -x, +x, -y, +y, -z, +z.
// - Surface of several materials lies in it and in the voxels beside it that are not filled: the largest area shows
//   (surface_areas.h). Where these voxels have one material, no area is asked for.
#pragma once

#include "../grid/sparse_voxels.h"
#include "../work/workers.h"
#include "brick_area.h"
#include "rule.h"
#include "rule_brick.h"
#include "surface_areas.h"

#include <vector>

namespace voxrt::voxelize {

/// What the tiles of a rule found.
struct RuleFindings {
    std::vector<std::vector<RuleBrick>> bricks; // by tile
    std::vector<OwnedSurface> owned;            // where there are several objects
    std::vector<MixedSurface> mixed;
};

/// Takes from `voxels` what is not filled, and adds to `lost`, by object, how many voxels these were.
///
/// `voxels`: those that are touched, within `area`. `around`: the same with those near the area, up to kThinReach;
/// `findings` are of them.
void apply_rule(SparseVoxels& voxels, const SparseVoxels& around, RuleFindings findings, const BrickArea& area,
                Thin thin, const FindAreas& find_areas, std::vector<int64_t>& lost, const Workers& workers);

} // namespace voxrt::voxelize
