// Thin parts where a scene is a single part of one material, whose voxels are those that its rule fills.
#pragma once

#include "../grid/sparse_voxels.h"
#include "../work/workers.h"
#include "brick_area.h"
#include "rule_brick.h"

#include <vector>

namespace voxrt::voxelize {

/// Adds voxels of thin parts to `voxels`, which are in `area`, and returns how many. `around`: the same with those near
/// the area, up to kThinReach; `tiles`: the bricks of these.
int64_t add_thin_parts(SparseVoxels& voxels, const SparseVoxels& around, std::vector<std::vector<RuleBrick>> tiles,
                       const BrickArea& area, uint8_t material, const Workers& workers);

} // namespace voxrt::voxelize
