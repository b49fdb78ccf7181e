// The extent of a triangle inside consecutive slabs one voxel wide, in one projection.
//
// An edge is walked from plane to plane between the slabs. A quotient is a product with a float64 reciprocal where that
// is exact: one division per edge. Cost: about 10 cycles per plane.
#pragma once

#include "../grid/brick.h"
#include "../grid/fixed_point.h"

#include <algorithm>
#include <climits>

namespace voxrt::voxelize {

namespace coverage {

/// floor(n / divisor) for n >= -divisor. int64: n < 2^49 and divisor < 2^33, so that the error of float64 is less than
/// half the distance of n / divisor from the next integer.
template <typename Wide> class Divisor {
public:
    explicit Divisor(Wide divisor) : divisor_(divisor) {}
    int floor(Wide n) const { return static_cast<int>(floor_div<Wide>(n, divisor_)); }

private:
    Wide divisor_;
};
template <> class Divisor<int64_t> {
public:
    explicit Divisor(int64_t divisor) : reciprocal_(1.0 / static_cast<double>(divisor)) {}
    int floor(int64_t n) const { return static_cast<int>((static_cast<double>(n) + 0.5) * reciprocal_ + 1.0) - 1; }

private:
    double reciprocal_;
};

/// By slab: the first and last voxel that the triangle covers there.
struct SlabExtent {
    int lo[kTileSide], hi[kTileSide];

    /// Makes the first `count` slabs empty.
    void clear(int count) {
        for (int i = 0; i < count; ++i) {
            lo[i] = INT_MAX;
            hi[i] = INT_MIN;
        }
    }
    void extend(int slab, int low, int high) {
        lo[slab] = std::min(lo[slab], low);
        hi[slab] = std::max(hi[slab], high);
    }
};

/// Adds a vertex (p, q) to the slabs first … last along p that contain it (two where it lies between them).
template <typename Wide> void extend_vertex(SlabExtent& extent, int first, int last, Wide p, Wide q) {
    const int low = voxel_floor(static_cast<int64_t>(q)), high = voxel_below(static_cast<int64_t>(q));
    const int a = voxel_below(static_cast<int64_t>(p)), b = voxel_floor(static_cast<int64_t>(p));
    if (a >= first && a <= last)
        extent.extend(a - first, low, high);
    if (b != a && b >= first && b <= last)
        extent.extend(b - first, low, high);
}

/// One edge, walked upwards along p: where it passes planes between slabs, and the sample lines within them.
template <typename Wide> class EdgeWalk {
public:
    EdgeWalk(Wide p0, Wide p1) : p0_(p0), run_(p1 - p0), planes_(run_ * kUnit), samples_(2 * run_ * kUnit) {}

    /// Adds the points where coordinate q (q0 … q0 + rise) passes the planes between the slabs first … last. q >= 0.
    void extend(SlabExtent& extent, int first, int last, Wide q0, Wide rise) const {
        const int from = std::max(voxel_floor(static_cast<int64_t>(p0_)) + 1, first);
        const int to = std::min(voxel_below(static_cast<int64_t>(p0_ + run_)), last + 1);
        Wide at = q0 * run_ + rise * (from * static_cast<Wide>(kUnit) - p0_);
        for (int plane = from; plane <= to; ++plane, at += rise * kUnit) {
            const int low = planes_.floor(at), high = planes_.floor(at - 1);
            if (plane > first)
                extent.extend(plane - 1 - first, low, high);
            if (plane <= last)
                extent.extend(plane - first, low, high);
        }
    }

    /// Adds, for the rows first … last whose sample line the edge passes, the first column whose sample lies beyond.
    void cross(SlabExtent& ends, int first, int last, Wide q0, Wide rise) const {
        const int from = std::max(line_above(2 * p0_), first), to = std::min(line_above(2 * (p0_ + run_)) - 1, last);
        const Wide start = 2 * q0 * run_ - (kUnit + 1) * run_ - 2 * rise * p0_ + rise * (kUnit + 1);
        for (int row = from; row <= to; ++row) {
            const int end = samples_.floor(start + rise * (2 * kUnit * static_cast<Wide>(row))) + 1;
            ends.extend(row - first, end, end);
        }
    }

private:
    /// The first row whose sample line lies above a coordinate in 1/8192 voxel (never on it: lines are odd).
    static int line_above(Wide doubled) {
        return static_cast<int>((static_cast<int64_t>(doubled) + kUnit - 1) >> (kFractionBits + 1));
    }

    Wide p0_, run_;
    Divisor<Wide> planes_, samples_;
};

} // namespace coverage

} // namespace voxrt::voxelize
