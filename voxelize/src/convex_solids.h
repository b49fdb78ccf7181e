// Boxes and balls without triangles: each column of voxels overlaps such a solid in one interval, found in closed form.
//
// Boxes and round balls are decided in exact integers. An ellipsoid (a ball under uneven scale) is decided in float64.
#pragma once

#include "tile_voxels.h"

#include <cmath>
#include <cstdlib>
#include <optional>

namespace voxrt::voxelize {

/// The voxels of a column that a solid overlaps (lo … hi), and those wholly within it (inner_lo … inner_hi).
struct ColumnSpan {
    int lo = 0, hi = -1, inner_lo = 0, inner_hi = -1;
};

/// A box along the axes of the grid, 1/4096 voxel. Where it has no thickness it covers the voxels above it.
struct AxisBox {
    int64_t min[3], max[3];

    int first(int axis) const { return voxel_floor(min[axis]); }
    int last(int axis) const { return std::max(voxel_below(max[axis]), first(axis)); }

    ColumnSpan column(int x, int y) const {
        if (x < first(0) || x > last(0) || y < first(1) || y > last(1))
            return {};
        ColumnSpan span{first(2), last(2), 0, -1};
        if (x > first(0) && x < last(0) && y > first(1) && y < last(1)) {
            span.inner_lo = span.lo + 1; // a face in a plane between voxels has its shell inside
            span.inner_hi = span.hi - 1;
        }
        return span;
    }
};

/// A round ball, 1/4096 voxel; |centre| <= kCoordinateLimit, 0 < radius <= kCoordinateLimit.
struct Ball {
    int64_t centre[3], radius;

    int first(int axis) const { return voxel_floor(centre[axis] - radius); }
    int last(int axis) const { return voxel_below(centre[axis] + radius); }

    /// Overlap: the voxel's nearest point is nearer than the radius. Within: its farthest corner is not farther.
    ColumnSpan column(int x, int y) const {
        int64_t near_square = 0, far_square = 0;
        bool far_within = true;
        const int cell[2] = {x, y};
        for (int axis = 0; axis < 2; ++axis) {
            const int64_t below = cell[axis] * kUnit - centre[axis], above = below + kUnit;
            const int64_t near = std::max({int64_t{0}, below, -above});
            const int64_t far = std::max(std::abs(below), std::abs(above));
            if (near >= radius)
                return {};
            near_square += near * near;
            far_within = far_within && far <= radius;
            far_square += far_within ? far * far : 0;
        }
        const int64_t square = radius * radius;
        if (near_square >= square)
            return {};
        const int64_t extent = root(square - near_square - 1); // largest distance along z with its square below
        ColumnSpan span;
        span.lo = voxel_below(centre[2] - extent);
        span.hi = voxel_floor(centre[2] + extent);
        if (far_within && far_square <= square) {
            const int64_t depth = root(square - far_square);
            span.inner_lo = voxel_below(centre[2] - depth) + 1;
            span.inner_hi = voxel_floor(centre[2] + depth) - 1;
        }
        return span;
    }

private:
    /// floor(sqrt(v)), 0 <= v < 2^61.
    static int64_t root(int64_t v) {
        auto r = static_cast<int64_t>(std::sqrt(static_cast<double>(v)));
        while (r * r > v)
            --r;
        while ((r + 1) * (r + 1) <= v)
            ++r;
        return r;
    }
};

/// The image of the unit ball under an affine map, in voxels. Its shape matrix is S = M M^T. The extent along n is
/// sqrt(n^T S n), and a slice x = const is again an ellipsoid, with the Schur complement of S.
class Ellipsoid {
public:
    /// `frame`: rows of the 3x4 map, 1/4096 voxel. A flattened ball is given a thickness of 1/4096 voxel.
    explicit Ellipsoid(const double* frame) {
        for (int i = 0; i < 3; ++i) {
            centre_[i] = frame[4 * i + 3] / kUnit;
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k)
                    shape_[i][j] += frame[4 * i + k] / kUnit * (frame[4 * j + k] / kUnit);
        }
        for (int i = 0; i < 3; ++i)
            shape_[i][i] += 1.0 / (double(kUnit) * double(kUnit));
    }

    int first(int axis) const { return int(std::floor(centre_[axis] - std::sqrt(shape_[axis][axis]))); }
    int last(int axis) const { return int(std::ceil(centre_[axis] + std::sqrt(shape_[axis][axis]))) - 1; }

    ColumnSpan column(int x, int y) const {
        const std::optional<double> top = extreme(x, y, 1), bottom = extreme(x, y, -1);
        if (!top || !bottom)
            return {};
        ColumnSpan span;
        span.lo = int(std::floor(*bottom));
        span.hi = int(std::ceil(*top)) - 1;
        double low = -1e300, high = 1e300;
        for (int corner = 0; corner < 4; ++corner) {
            const int u = x + (corner & 1), v = y + (corner >> 1);
            const std::optional<double> a = chord(u, v, 1), b = chord(u, v, -1);
            if (!a || !b)
                return span;
            high = std::min(high, *a);
            low = std::max(low, *b);
        }
        span.inner_lo = int(std::ceil(low));
        span.inner_hi = int(std::floor(high)) - 1;
        return span;
    }

private:
    /// Highest (sign 1) or lowest (-1) point of the vertical line through (x, y).
    std::optional<double> chord(double x, double y, int sign) const {
        const double dx = x - centre_[0], dy = y - centre_[1];
        const double determinant = shape_[0][0] * shape_[1][1] - shape_[0][1] * shape_[0][1];
        const double u = (shape_[1][1] * dx - shape_[0][1] * dy) / determinant;
        const double v = (shape_[0][0] * dy - shape_[0][1] * dx) / determinant;
        const double left = 1 - (dx * u + dy * v);
        if (left < 0)
            return std::nullopt;
        const double mean = shape_[0][2] * u + shape_[1][2] * v;
        const double p = (shape_[1][1] * shape_[0][2] - shape_[0][1] * shape_[1][2]) / determinant;
        const double q = (shape_[0][0] * shape_[1][2] - shape_[0][1] * shape_[0][2]) / determinant;
        const double spread = shape_[2][2] - (shape_[0][2] * p + shape_[1][2] * q);
        return centre_[2] + mean + sign * std::sqrt(std::max(spread, 0.0) * left);
    }

    /// Highest or lowest point over the cell x … x+1, y … y+1: that of the ellipsoid, or on an edge of the cell.
    std::optional<double> extreme(int x, int y, int sign) const {
        const double extent = sign / std::sqrt(shape_[2][2]);
        const double px = centre_[0] + shape_[0][2] * extent, py = centre_[1] + shape_[1][2] * extent;
        if (px >= x && px <= x + 1 && py >= y && py <= y + 1)
            return centre_[2] + shape_[2][2] * extent;
        std::optional<double> best;
        auto offer = [&](std::optional<double> z) {
            if (z && (!best || sign * *z > sign * *best))
                best = z;
        };
        for (int side = 0; side < 2; ++side) {
            if (auto v = edge_extreme(0, 1, x + side, sign))
                offer(chord(x + side, std::clamp(*v, double(y), double(y + 1)), sign));
            if (auto u = edge_extreme(1, 0, y + side, sign))
                offer(chord(std::clamp(*u, double(x), double(x + 1)), y + side, sign));
        }
        return best;
    }

    /// In the slice where coordinate `fixed` has a value: where along `free` the slice is highest or lowest.
    std::optional<double> edge_extreme(int fixed, int free, double value, int sign) const {
        const double d = value - centre_[fixed], left = 1 - d * d / shape_[fixed][fixed];
        if (left < 0)
            return std::nullopt;
        const double ratio_free = shape_[fixed][free] / shape_[fixed][fixed];
        const double ratio_up = shape_[fixed][2] / shape_[fixed][fixed];
        const double across = shape_[free][2] - ratio_free * shape_[fixed][2];
        const double up = shape_[2][2] - ratio_up * shape_[fixed][2];
        const double shift = up > 0 ? across / std::sqrt(up) : 0;
        return centre_[free] + ratio_free * d + sign * shift * std::sqrt(left);
    }

    double centre_[3], shape_[3][3] = {};
};

/// Claims a convex solid's voxels in one tile; returns how many were free.
///
/// Cost: the columns under the solid; bricks within it are claimed whole.
template <class Solid>
int64_t claim_convex(TileVoxels& tile, const Window& w, const Solid& solid, bool fill, uint8_t material) {
    int64_t claimed = 0;
    for (int column = 0; column < kTileColumns; ++column) {
        const int cx = w.x0 + column % kTileBricks * kBrickSide, cy = w.y0 + column / kTileBricks * kBrickSide;
        if (solid.first(0) > cx + 7 || solid.last(0) < cx || solid.first(1) > cy + 7 || solid.last(1) < cy)
            continue;
        ColumnSpan spans[64];
        int lowest = INT_MAX, highest = INT_MIN, full_lo = 0, full_hi = w.top;
        for (int bit = 0; bit < 64; ++bit) {
            const int x = cx + column_x(bit), y = cy + column_y(bit);
            ColumnSpan& span = spans[bit];
            if (x <= w.x1 && y <= w.y1)
                span = solid.column(x, y);
            span.lo = std::max(span.lo, 0);
            span.hi = std::min(span.hi, w.top);
            if (span.lo <= span.hi) {
                lowest = std::min(lowest, span.lo);
                highest = std::max(highest, span.hi);
            }
            full_lo = std::max(full_lo, span.inner_lo);
            full_hi = std::min(full_hi, span.inner_hi);
        }
        if (lowest > highest)
            continue;
        const int full_from = (full_lo + kBrickSide - 1) >> kBrickBits, full_to = (full_hi + 1) >> kBrickBits;
        for (int k = lowest >> kBrickBits; k <= highest >> kBrickBits; ++k) {
            if (k >= full_from && k < full_to) {
                if (fill)
                    claimed += tile.claim_full(column, full_from, full_to, material);
                k = full_to - 1;
                continue;
            }
            Slices mask{};
            for (int bit = 0; bit < 64; ++bit)
                for (int z = 0; z < kBrickSide; ++z) {
                    const int at = k * kBrickSide + z;
                    const ColumnSpan& s = spans[bit];
                    const bool within = at >= s.inner_lo && at <= s.inner_hi;
                    if (at >= s.lo && at <= s.hi && (fill || !within))
                        mask[z] |= uint64_t{1} << bit;
                }
            if (!is_empty(mask))
                claimed += tile.claim(column, k, mask, material, nullptr);
        }
    }
    return claimed;
}

} // namespace voxrt::voxelize
