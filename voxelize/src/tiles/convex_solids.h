// Boxes and balls without triangles: each column of voxels overlaps such a solid in one interval, decided in exact
// integers. ellipsoid.h has the third such solid.
#pragma once

#include "../coverage/column_span.h"
#include "rule_tile.h"
#include "tile_voxels.h"

#include <cmath>
#include <cstdlib>

namespace voxrt::voxelize {

/// A box along the axes of the grid, 1/4096 voxel. Where it has no thickness it covers the voxels above it.
struct AxisBox {
    int64_t min[3], max[3];

    int first(int axis) const { return voxel_floor(min[axis]); }
    int last(int axis) const { return std::max(voxel_below(max[axis]), first(axis)); }

    ColumnSpan column(int x, int y, int /*top*/) const {
        if (x < first(0) || x > last(0) || y < first(1) || y > last(1))
            return {};
        ColumnSpan span{first(2), last(2), 0, -1};
        if (x > first(0) && x < last(0) && y > first(1) && y < last(1)) {
            span.inner_lo = span.lo + 1; // a face in a plane between voxels has its shell inside
            span.inner_hi = span.hi - 1;
        }
        return span;
    }

    /// How much of a voxel it fills: exact, in units of the lattice, and in voxels.
    int64_t volume_in_units(int x, int y, int z) const {
        const int at[3] = {x, y, z};
        int64_t product = 1;
        for (int axis = 0; axis < 3; ++axis)
            product *= std::max<int64_t>(
                std::min(max[axis], (at[axis] + 1) * kUnit) - std::max(min[axis], at[axis] * kUnit), 0);
        return product;
    }
    double volume(int x, int y, int z) const { return double(volume_in_units(x, y, z)) / (kUnit * kUnit * kUnit); }

    /// The voxels of a column whose centres are within.
    ColumnSpan centres(int x, int y, int /*top*/) const {
        auto holds = [this](int cell, int axis) {
            const int64_t at = cell * kUnit + kUnit / 2;
            return min[axis] <= at && at <= max[axis];
        };
        if (!holds(x, 0) || !holds(y, 1))
            return {};
        return {voxel_below(min[2] + kUnit / 2), voxel_floor(max[2] - kUnit / 2)};
    }
};

/// A round ball, 1/4096 voxel; |centre| <= kCoordinateLimit, 0 < radius <= kCoordinateLimit.
struct Ball {
    int64_t centre[3], radius;

    int first(int axis) const { return voxel_floor(centre[axis] - radius); }
    int last(int axis) const { return voxel_below(centre[axis] + radius); }

    /// Overlap: the voxel's nearest point is nearer than the radius. Within: its farthest corner is not farther.
    ColumnSpan column(int x, int y, int /*top*/) const {
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

    /// The voxels of a column whose centres are within.
    ColumnSpan centres(int x, int y, int /*top*/) const {
        const int64_t dx = std::abs(x * kUnit + kUnit / 2 - centre[0]),
                      dy = std::abs(y * kUnit + kUnit / 2 - centre[1]);
        if (dx > radius || dy > radius || dx * dx + dy * dy > radius * radius)
            return {};
        const int64_t extent = root(radius * radius - dx * dx - dy * dy);
        return {voxel_below(centre[2] - extent + kUnit / 2), voxel_floor(centre[2] + extent - kUnit / 2)};
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

/// Claims a convex solid's voxels in one tile; returns how many were free. `rule`: null for `touch`.
///
/// Cost: the columns under the solid; bricks within it are claimed whole.
template <class Solid>
int64_t claim_convex(TileVoxels& tile, RuleTile* rule, const Window& w, const Solid& solid, bool fill,
                     uint8_t material) {
    int64_t claimed = 0;
    for (int column = 0; column < kTileColumns; ++column) {
        const int cx = w.x0 + column % kTileBricks * kBrickSide, cy = w.y0 + column / kTileBricks * kBrickSide;
        if (solid.first(0) > cx + 7 || solid.last(0) < cx || solid.first(1) > cy + 7 || solid.last(1) < cy)
            continue;
        ColumnSpan spans[64], centres[64];
        int lowest = INT_MAX, highest = INT_MIN, full_lo = 0, full_hi = w.top;
        for (int bit = 0; bit < 64; ++bit) {
            const int x = cx + column_x(bit), y = cy + column_y(bit);
            ColumnSpan& span = spans[bit];
            if (x <= w.x1 && y <= w.y1) {
                span = solid.column(x, y, w.top);
                if (rule != nullptr)
                    centres[bit] = solid.centres(x, y, w.top);
            }
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
                if (fill) {
                    claimed += tile.claim_full(column, full_from, full_to, material);
                    if (rule != nullptr)
                        rule->add_full(column, full_from, full_to);
                }
                k = full_to - 1;
                continue;
            }
            Slices mask{}, surface{}, filled{}, was_free;
            for (int bit = 0; bit < 64; ++bit)
                for (int z = 0; z < kBrickSide; ++z) {
                    const int at = k * kBrickSide + z;
                    const ColumnSpan& s = spans[bit];
                    const bool within = at >= s.inner_lo && at <= s.inner_hi;
                    if (at >= s.lo && at <= s.hi && (fill || !within))
                        mask[z] |= uint64_t{1} << bit;
                    if (at >= s.lo && at <= s.hi && !within)
                        surface[z] |= uint64_t{1} << bit;
                    if (rule != nullptr && at >= centres[bit].lo && at <= centres[bit].hi)
                        filled[z] |= uint64_t{1} << bit;
                }
            if (is_empty(mask))
                continue;
            claimed += tile.claim(column, k, mask, material, nullptr, rule != nullptr ? &was_free : nullptr);
            if (rule == nullptr)
                continue;
            if constexpr (requires { solid.volume(0, 0, 0); })
                if (fill && rule->asks_for_volumes()) {
                    std::array<double, kBrickVoxels>& volumes = rule->room_for_volumes(column, k);
                    for (int z = 0; z < kBrickSide; ++z) {
                        filled[z] = mask[z] & ~surface[z];
                        for (uint64_t left = surface[z]; left != 0; left &= left - 1) {
                            const int bit = std::countr_zero(left);
                            volumes[size_t(z * 64 + bit)] =
                                solid.volume(cx + column_x(bit), cy + column_y(bit), k * kBrickSide + z);
                        }
                    }
                    rule->add_volumes(column, k, surface);
                }
            for (int z = 0; z < kBrickSide; ++z) {
                filled[z] = fill && !rule->fills_all() ? filled[z] & mask[z] : mask[z];
                was_free[z] &= surface[z];
            }
            rule->add(column, k, filled, surface, was_free);
        }
    }
    return claimed;
}

} // namespace voxrt::voxelize
