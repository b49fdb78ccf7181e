// Which voxels of a brick belong to parts that are too thin for a rule (thin_parts.h).
#pragma once

#include "brick_window.h"
#include "rule.h"
#include "rule_brick.h"

namespace voxrt::voxelize {

/// Of 3 x 3 x 3 voxels or bricks, x + 3 y + 9 z.
inline constexpr uint32_t kMiddle = 1u << 13;

/// The touched voxels of a brick that are neither solid in bulk nor beside a voxel that is, by what is filled in it, in
/// the brick below it and in the one above.
inline Slices thin_in_column(const RuleBrick& brick, const Slices& below, const Slices& above) {
    constexpr uint64_t lowest = 0x0101'0101'0101'0101, highest = lowest << 7;
    const uint64_t filled[kBrickSide + 4] = {below[6],        below[7],        brick.filled[0], brick.filled[1],
                                             brick.filled[2], brick.filled[3], brick.filled[4], brick.filled[5],
                                             brick.filled[6], brick.filled[7], above[0],        above[1]};
    uint64_t cubes[kBrickSide + 3]; // by lowest corner, two slices further
    for (size_t z = 0; z < kBrickSide + 3; ++z) {
        const uint64_t both = filled[z] & filled[z + 1], pairs = both & both >> 1 & ~highest;
        cubes[z] = pairs & pairs >> 8;
    }
    Slices found;
    for (size_t z = 0; z < kBrickSide; ++z) {
        const uint64_t near = cubes[z] | cubes[z + 1] | cubes[z + 2] | cubes[z + 3];
        const uint64_t row = near | (near >> 1 & ~highest) | (near << 1 & ~lowest) | (near << 2 & ~(lowest * 3));
        found[z] = brick.touched[z] & ~(row | row >> 8 | row << 8 | row << 16);
    }
    return found;
}

/// Those of the 3 x 3 x 3 bricks around that have voxels at most two away from some of the middle one.
inline uint32_t bricks_near(const Slices& voxels) {
    constexpr uint64_t first_two = 0x0303'0303'0303'0303;
    const uint64_t any = any_of(voxels);
    const bool reaches[6] = {(any & first_two) != 0, (any & first_two << 6) != 0,  (any & 0xFFFF) != 0,
                             any >> 48 != 0,         (voxels[0] | voxels[1]) != 0, (voxels[6] | voxels[7]) != 0};
    uint32_t found = kMiddle;
    for (int axis = 0, step = 1; axis < 3; ++axis, step *= 3)
        found |= (reaches[2 * axis] ? found >> step : 0) | (reaches[2 * axis + 1] ? found << step : 0);
    return found;
}

/// The voxels of a brick that belong to thin parts. `alone`: those that thin_in_column() leaves;
/// `filled_around(wanted)`: the filled voxels of the 3 x 3 x 3 bricks around; those without a bit in `wanted` may be
/// anything.
template <class FilledAround> Slices thin_voxels(const Slices& alone, FilledAround filled_around) {
    if (is_empty(alone))
        return alone;
    BrickWindow<2> bulk;
    bulk.gather(filled_around(bricks_near(alone)));
    return without(alone, bulk.near_cubes());
}

} // namespace voxrt::voxelize
