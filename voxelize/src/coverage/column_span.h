// What a convex solid overlaps in one column of voxels.
#pragma once

namespace voxrt::voxelize {

/// The voxels of a column that a solid overlaps (lo … hi), and those wholly within it (inner_lo … inner_hi).
struct ColumnSpan {
    int lo = 0, hi = -1, inner_lo = 0, inner_hi = -1;
};

} // namespace voxrt::voxelize
