// Where the line through the centres of a column crosses a triangle, and which centres lie on it: exact integers.
//
// The line is moved by an infinitely small step along x, and by a smaller one along y, so that it meets no edge: a
// column belongs to the triangle on its right, a row to the one above. Whether a centre lies on the triangle is decided
// without that step. So a centre that is on no triangle is inside where the crossings below it say so.
//
// Cost: one division per column that crosses.
#pragma once

#include "triangle_coverage.h"

namespace voxrt::voxelize {

namespace coverage {

constexpr int64_t kHalf = kUnit / 2;

/// The triangle in one projection, cut by lines p = const: coordinates relative to a centre, so that centres lie at
/// multiples of kUnit.
template <typename Wide> class CentreRows {
public:
    CentreRows(const Wide* p, const Wide* q) : p_(p), q_(q) {}

    /// Rows first … last whose line meets the closed triangle.
    int first() const { return static_cast<int>(-floor_div<Wide>(-std::min({p_[0], p_[1], p_[2]}), kUnit)); }
    int last() const { return static_cast<int>(floor_div<Wide>(std::max({p_[0], p_[1], p_[2]}), kUnit)); }

    /// The centres of a row within the closed triangle (lo … hi), and those that belong to it (from … to).
    struct Row {
        int lo = INT_MAX, hi = INT_MIN, from = INT_MAX, to = INT_MIN;
    };
    Row at(int row) const {
        const Wide line = row * static_cast<Wide>(kUnit);
        Row found;
        for (int i = 0; i < 3; ++i) {
            int a = i, b = i == 2 ? 0 : i + 1;
            if (p_[a] == line)
                include(found, q_[a], 1);
            if (p_[a] > p_[b])
                std::swap(a, b);
            if (!(p_[a] <= line && line < p_[b]))
                continue;
            const Wide run = p_[b] - p_[a];
            const int beyond = include(found, q_[a] * run + (q_[b] - q_[a]) * (line - p_[a]), run);
            found.from = std::min(found.from, beyond);
            found.to = std::max(found.to, beyond - 1);
        }
        return found;
    }

private:
    /// Widens lo … hi to a point; returns the first centre that is not before it.
    static int include(Row& row, Wide numerator, Wide denominator) {
        const Wide unit = denominator * kUnit;
        const int floor = static_cast<int>(floor_div<Wide>(numerator, unit));
        const int ceil = floor * unit == numerator ? floor : floor + 1;
        row.lo = std::min(row.lo, ceil);
        row.hi = std::max(row.hi, floor);
        return ceil;
    }

    const Wide *p_, *q_;
};

template <typename Wide, class Receiver>
void find_centres(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, bool crosses, bool holds,
                  Receiver& receiver) {
    const LocalTriangle<Wide> t(a, b, c);
    Wide x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = t.x[i] - kHalf;
        y[i] = t.y[i] - kHalf;
        z[i] = t.z[i] - kHalf;
    }
    const Wide nx = t.normal_x(), ny = t.normal_y(), nz = t.normal_z();
    const int z_first = -t.bz, z_last = w.top - t.bz;
    if (nz != 0) {
        const Wide sign = nz < 0 ? -1 : 1, unit = sign * nz * kUnit;
        const CentreRows<Wide> rows(y, x);
        for (int v = std::max(rows.first(), w.y0 - t.by), end = std::min(rows.last(), w.y1 - t.by); v <= end; ++v) {
            const auto row = rows.at(v);
            const int last = std::min(row.hi, w.x1 - t.bx);
            for (int u = std::max(row.lo, w.x0 - t.bx); u <= last; ++u) {
                const Wide height = sign * (nx * (x[0] - u * static_cast<Wide>(kUnit)) +
                                            ny * (y[0] - v * static_cast<Wide>(kUnit)) + nz * z[0]);
                const Wide below = floor_div<Wide>(height, unit);
                if (holds && below * unit == height && below >= z_first && below <= z_last)
                    receiver.hold(u + t.bx, v + t.by, static_cast<int>(below) + t.bz, static_cast<int>(below) + t.bz);
                if (crosses && u >= row.from && u <= row.to && below < z_last)
                    receiver.cross(u + t.bx, v + t.by, static_cast<int>(std::max<Wide>(below + 1, z_first)) + t.bz,
                                   nz < 0);
            }
        }
        return;
    }
    // The triangle stands upright: seen along x or y.
    const bool along_x = nx != 0;
    const Wide normal = along_x ? nx : ny, other = along_x ? ny : nx;
    if (normal == 0 || !holds)
        return; // a segment or a point: on the surface are its neighbours
    const Wide *across = along_x ? y : x, *along = along_x ? x : y;
    const int across_base = along_x ? t.by : t.bx, along_base = along_x ? t.bx : t.by;
    const int across_first = along_x ? w.y0 : w.x0, across_last = along_x ? w.y1 : w.x1;
    const int along_first = along_x ? w.x0 : w.y0, along_last = along_x ? w.x1 : w.y1;
    const Wide sign = normal < 0 ? -1 : 1, unit = sign * normal * kUnit;
    const CentreRows<Wide> rows(across, z);
    for (int v = std::max(rows.first(), across_first - across_base),
             end = std::min(rows.last(), across_last - across_base);
         v <= end; ++v) {
        const Wide place = sign * (normal * along[0] + other * (across[0] - v * static_cast<Wide>(kUnit)));
        const Wide u = floor_div<Wide>(place, unit);
        if (u * unit != place || u + along_base < along_first || u + along_base > along_last)
            continue;
        const auto row = rows.at(v);
        const int lo = std::max(row.lo, z_first), hi = std::min(row.hi, z_last);
        const int column = static_cast<int>(u) + along_base, at = v + across_base;
        if (lo <= hi)
            receiver.hold(along_x ? column : at, along_x ? at : column, lo + t.bz, hi + t.bz);
    }
}

} // namespace coverage

/// Reports to a receiver how triangle abc lies to the centres of voxels inside a window.
///
/// receiver.hold(x, y, lo, hi): the centres of voxels lo … hi of column (x, y) lie on the closed triangle.
/// receiver.cross(x, y, z, enters): the line through the centres of column (x, y) crosses the surface below the centre
/// of voxel z, the lowest such; `enters` when it goes upwards against the normal.
/// `crosses`, `holds`: which of them are wanted.
template <class Receiver>
void find_centres(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, bool crosses, bool holds,
                  Receiver& receiver) {
    const int64_t extent = std::max({int64_t{std::max({a.x, b.x, c.x})} - std::min({a.x, b.x, c.x}),
                                     int64_t{std::max({a.y, b.y, c.y})} - std::min({a.y, b.y, c.y}),
                                     int64_t{std::max({a.z, b.z, c.z})} - std::min({a.z, b.z, c.z})});
    if (extent < kNarrowExtent)
        coverage::find_centres<int64_t>(a, b, c, w, crosses, holds, receiver);
    else
        coverage::find_centres<int128>(a, b, c, w, crosses, holds, receiver);
}

} // namespace voxrt::voxelize
