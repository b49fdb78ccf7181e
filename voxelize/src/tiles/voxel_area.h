// The surface of a triangle in a voxel, as it shows along the three axes.
#pragma once

#include "../coverage/exact_volume.h"
#include "../coverage/triangle_coverage.h"

#include <cmath>

namespace voxrt::voxelize {

/// The part of a triangle in a voxel.
struct TriangleShare {
    int64_t area = 0;
    std::array<double, 3> before{}; // 1/256 voxel before the middle of its corners, but in the voxel
};

/// Its area is the sum of the areas that the triangle's part in voxel (x, y, z) shows along x, y and z, in 2^-24
/// voxels. A triangle in a plane between voxels is in those that it covers (triangle_coverage.h). `inverted`: its
/// normal points inwards; `top`: the grid's last voxel per axis.
inline TriangleShare share_of(const SolidTriangle& t, const std::array<int, 3>& voxel, bool inverted, int top) {
    for (size_t i = 0; i < 3; ++i) {
        const auto at = [i](const Vertex& v) { return i == 0 ? v.x : i == 1 ? v.y : v.z; };
        const int64_t low = std::min({at(t[0]), at(t[1]), at(t[2])}), high = std::max({at(t[0]), at(t[1]), at(t[2])});
        if (low > (voxel[i] + 1) * kUnit || high < voxel[i] * kUnit)
            return {};
    }
    using Polygon = std::array<std::array<double, 3>, 10>;
    Polygon buffers[2];
    Polygon* current = &buffers[0];
    Polygon* next = &buffers[1];
    std::array<double, 3> moved{};
    int count = 3;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t at[3] = {t[i].x, t[i].y, t[i].z};
        for (size_t axis = 0; axis < 3; ++axis)
            (*current)[i][axis] = double(at[axis] - voxel[axis] * kUnit) / kUnit;
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        const double low = std::min({(*current)[0][axis], (*current)[1][axis], (*current)[2][axis]});
        const double high = std::max({(*current)[0][axis], (*current)[1][axis], (*current)[2][axis]});
        if (low != high || low != std::floor(low))
            continue;
        const size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        const auto across = [&](size_t i, size_t of) { return (*current)[i][of] - (*current)[0][of]; };
        const bool upwards = across(1, j) * across(2, k) > across(1, k) * across(2, j);
        if (coverage::layer_behind(voxel[axis] + int(low), upwards != inverted, top) != voxel[axis])
            return {};
        moved[axis] = low - 0.5;
        for (size_t i = 0; i < 3; ++i)
            (*current)[i][axis] = 0.5;
    }
    for (size_t axis = 0; axis < 3; ++axis)
        for (const double plane : {0.0, 1.0}) {
            const auto inwards = [&](const std::array<double, 3>& p) { return plane == 0 ? p[axis] : 1 - p[axis]; };
            if (std::all_of(current->begin(), current->begin() + count, [&](auto& p) { return inwards(p) >= 0; }))
                continue;
            int kept = 0;
            for (int i = 0; i < count; ++i) {
                const auto &p = (*current)[size_t(i)], &q = (*current)[size_t(i + 1 == count ? 0 : i + 1)];
                const double a = inwards(p), b = inwards(q);
                if (a >= 0)
                    (*next)[size_t(kept++)] = p;
                if ((a < 0) != (b < 0) && a != 0 && b != 0) {
                    auto& met = (*next)[size_t(kept++)];
                    for (size_t i = 0; i < 3; ++i)
                        met[i] = p[i] + (q[i] - p[i]) * (a / (a - b));
                    met[axis] = plane;
                }
            }
            if (kept < 3)
                return {};
            count = kept;
            std::swap(current, next);
        }
    const Polygon& polygon = *current;
    std::array<double, 3> sums{}, middle{};
    for (int i = 2; i < count; ++i)
        for (size_t axis = 0; axis < 3; ++axis) {
            const size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
            const auto &a = polygon[0], &b = polygon[size_t(i - 1)], &c = polygon[size_t(i)];
            sums[axis] += ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])) / 2;
        }
    TriangleShare share;
    share.area = int64_t(std::nearbyint((std::abs(sums[0]) + std::abs(sums[1]) + std::abs(sums[2])) * 0x1p24));
    if (share.area == 0)
        return {};
    const double length = std::sqrt(sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2]);
    for (size_t axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < count; ++i)
            middle[axis] += polygon[size_t(i)][axis] / count;
        const double before = middle[axis] + moved[axis] + sums[axis] / length * (inverted ? -1 : 1) / 256;
        share.before[axis] = voxel[axis] + std::clamp(before, 0x1p-9, 1 - 0x1p-9);
    }
    return share;
}

/// Whether the ray downwards from a point meets a triangle: 1 or -1 as that faces up or down, else 0.
inline int crossing_below(const SolidTriangle& t, const std::array<double, 3>& point) {
    const double x = point[0] * kUnit, y = point[1] * kUnit;
    bool is_inside = false;
    for (size_t i = 0; i < 3; ++i) {
        const Vertex *a = &t[i], *b = &t[(i + 1) % 3];
        if ((a->y > y) == (b->y > y))
            continue;
        if (a->y > b->y)
            std::swap(a, b);
        is_inside ^= x < a->x + (double(b->x) - a->x) * ((y - a->y) / (double(b->y) - a->y));
    }
    if (!is_inside)
        return 0;
    const Vertex &a = t[0], &b = t[1], &c = t[2];
    const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
    const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double height = nx * (x - a.x) + ny * (y - a.y) + nz * (point[2] * kUnit - a.z);
    return nz > 0 ? height > 0 : nz < 0 ? -(height < 0) : 0;
}

} // namespace voxrt::voxelize
