// Which voxels a triangle covers, and which columns it crosses: exact, for triangles of any size and any receiver.
// Where speed matters, vector_coverage.h makes the same tests for eight columns at a time.
//
// A voxel is covered when the closed triangle meets the voxel's open interior. Thirteen axes can separate a box from a
// triangle (3 box normals, the triangle's normal, 9 products of edges; Akenine-Moeller, "Fast 3D Triangle-Box Overlap
// Testing", 2001). For the voxels of one column along z each test is linear in z, so the covered voxels are one
// interval (Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", 2010). The edge products come
// in three projections. In each, the tests are the triangle's extent inside slabs one voxel wide (slab_extent.h): per
// row y the extent in x and in z, per column x the extent in z. Edges are walked plane by plane with exact integer
// remainders, and the plane of the triangle likewise along each row.
//
// A triangle in a plane between voxels meets no interior. It belongs to the voxels behind it, against its normal.
//
// For solids the columns' sample rays also cross the triangle. A ray runs through its column 1/8192 voxel beside the
// centre, where no vertex can lie; on an edge the column belongs to the triangle on its right. So rays through a closed
// surface enter as often as they leave. A crossing may be marked at any voxel of the covered interval, since a covered
// voxel is solid in any case: the lowest is marked, and no division is spent on the height.
//
// Cost: about 100 cycles per triangle, 40 per row or column of its bounding box, 10 per covered column.
#pragma once

#include "slab_extent.h"

namespace voxrt::voxelize {

/// Voxels x0 … x1, y0 … y1, 0 … top along z (inclusive); at most kTileSide columns per side.
struct Window {
    int x0, x1, y0, y1, top;
};

namespace coverage {

/// Columns first … last whose sample rays the triangle crosses in a row of voxels.
template <typename Wide> void crossed_columns(const Wide* x, const Wide* y, int row, int& first, int& last) {
    const Wide line = row * static_cast<Wide>(2 * kUnit) + (kUnit + 1); // in 1/8192 voxel
    int ends[2], count = 0;
    for (int i = 0; i < 3 && count < 2; ++i) {
        int a = i, b = i == 2 ? 0 : i + 1;
        if (y[a] > y[b])
            std::swap(a, b);
        if (!(2 * y[a] < line && line < 2 * y[b]))
            continue;
        const Wide run = y[b] - y[a];
        const Wide at = 2 * x[a] * run + (x[b] - x[a]) * (line - 2 * y[a]);
        ends[count++] = static_cast<int>(floor_div<Wide>(at - (kUnit + 1) * run, 2 * kUnit * run)) + 1;
    }
    if (count < 2) {
        first = 0;
        last = -1;
        return;
    }
    first = std::min(ends[0], ends[1]);
    last = std::max(ends[0], ends[1]) - 1;
}

/// A triangle relative to the voxel corner (bx, by, bz) below it, so that all coordinates are >= 0 and small.
template <typename Wide> struct LocalTriangle {
    Wide x[3], y[3], z[3];
    int bx, by, bz;
    int x0, x1, y0, y1, z0, z1; // covered range of its bounding box, local; empty where flat on a plane

    LocalTriangle(const Vertex& a, const Vertex& b, const Vertex& c) {
        bx = voxel_floor(std::min({a.x, b.x, c.x}));
        by = voxel_floor(std::min({a.y, b.y, c.y}));
        bz = voxel_floor(std::min({a.z, b.z, c.z}));
        const Vertex* v[3] = {&a, &b, &c};
        for (int i = 0; i < 3; ++i) {
            x[i] = v[i]->x - static_cast<Wide>(bx) * kUnit;
            y[i] = v[i]->y - static_cast<Wide>(by) * kUnit;
            z[i] = v[i]->z - static_cast<Wide>(bz) * kUnit;
        }
        x0 = y0 = z0 = 0;
        x1 = voxel_below(static_cast<int64_t>(std::max({x[0], x[1], x[2]})));
        y1 = voxel_below(static_cast<int64_t>(std::max({y[0], y[1], y[2]})));
        z1 = voxel_below(static_cast<int64_t>(std::max({z[0], z[1], z[2]})));
    }
    Wide normal_x() const { return (y[1] - y[0]) * (z[2] - z[0]) - (z[1] - z[0]) * (y[2] - y[0]); }
    Wide normal_y() const { return (z[1] - z[0]) * (x[2] - x[0]) - (x[1] - x[0]) * (z[2] - z[0]); }
    Wide normal_z() const { return (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]); }
};

/// The triangle's extent along q in the slabs first … last along p.
template <typename Wide> void extents_of(SlabExtent& extent, int first, int last, const Wide* p, const Wide* q) {
    extent.clear(last - first + 1);
    for (int i = 0; i < 3; ++i) {
        extend_vertex<Wide>(extent, first, last, p[i], q[i]);
        int a = i, b = i == 2 ? 0 : i + 1;
        if (p[a] == p[b])
            continue;
        if (p[a] > p[b])
            std::swap(a, b);
        EdgeWalk<Wide>(p[a], p[b]).extend(extent, first, last, q[a], q[b] - q[a]);
    }
}

/// The voxels of a column that a plane passes, walked along a row: exact, by remainders.
///
/// The plane of normal n (n.z > 0) lies above a voxel's bottom corner and below its top corner where
/// floor(below / unit) <= z <= floor((below + spread - 1) / unit); `below` falls by n.x * kUnit per column.
template <typename Wide> class PlaneWalk {
public:
    PlaneWalk(Wide nx, Wide unit, Wide spread) : unit_(unit) {
        step_ = floor_div<Wide>(-nx * kUnit, unit);
        step_part_ = -nx * kUnit - step_ * unit;
        height_ = floor_div<Wide>(spread - 1, unit);
        carry_ = unit - (spread - 1 - height_ * unit);
    }
    void start(Wide below) {
        low_ = floor_div<Wide>(below, unit_);
        part_ = below - low_ * unit_;
    }
    /// Narrows lo … hi to what the plane passes. Far from the triangle the plane leaves the range of int.
    void clip(int& lo, int& hi) const {
        const Wide high = low_ + height_ + (part_ >= carry_);
        if (low_ > lo)
            lo = low_ > hi ? hi + 1 : static_cast<int>(low_);
        if (high < hi)
            hi = high < lo ? lo - 1 : static_cast<int>(high);
    }
    void next() {
        part_ += step_part_;
        const bool carry = part_ >= unit_;
        low_ += step_ + carry;
        part_ -= carry ? unit_ : 0;
    }

private:
    Wide unit_, step_, step_part_;
    Wide height_, carry_;     // (spread - 1) / unit: whole, and which part of `below` makes one more
    Wide low_ = 0, part_ = 0; // below / unit: whole, and the rest
};

/// The same by float64 reciprocal, for triangles up to kTinyExtent wide: below < 2^49, so that the error of float64 is
/// less than half the distance of a quotient from the next integer. Quotients below 0 come out below 1, which is enough
/// since lo >= 0.
class TinyPlaneWalk {
public:
    TinyPlaneWalk(int64_t nx, int64_t unit, int64_t spread)
        : reciprocal_(1.0 / double(unit)), step_(double(nx * kUnit)), spread_(double(spread - 1)) {}
    void start(int64_t below) { below_ = double(below) + 0.5; }
    void clip(int& lo, int& hi) const {
        const auto low = static_cast<int64_t>(below_ * reciprocal_);
        const auto high = static_cast<int64_t>((below_ + spread_) * reciprocal_ + 1.0) - 1;
        lo = static_cast<int>(std::max<int64_t>(lo, std::min<int64_t>(low, INT_MAX)));
        hi = static_cast<int>(std::min<int64_t>(hi, std::max<int64_t>(high, -1)));
    }
    void next() { below_ -= step_; }

private:
    double reciprocal_, step_, spread_, below_ = 0;
};

/// The layer behind a triangle that lies in plane `plane`, clamped into 0 … top; -1 where the plane is outside.
inline int layer_behind(int plane, bool facing_up, int top) {
    if (plane < 0 || plane > top + 1)
        return -1;
    return std::clamp(facing_up ? plane - 1 : plane, 0, top);
}

template <typename Wide, bool Cross, class Receiver>
void cover_flat(const LocalTriangle<Wide>& t, const Window& w, bool inverted, Receiver& receiver) {
    SlabExtent rows_x, rows_z, columns_z;
    const Wide nx = t.normal_x(), ny = t.normal_y(), nz = t.normal_z();
    const int flat_axes = (t.x1 < 0) + (t.y1 < 0) + (t.z1 < 0);
    if (flat_axes > 1)
        return; // a segment or a point on an edge: no interior, and no side behind it
    const int y0 = std::max(w.y0 - t.by, 0), y1 = std::min(w.y1 - t.by, t.y1);
    const int x0 = std::max(w.x0 - t.bx, 0), x1 = std::min(w.x1 - t.bx, t.x1);
    if (t.x1 < 0) {
        const int layer = layer_behind(t.bx, (nx > 0) != inverted, receiver.side() - 1);
        if (nx == 0 || layer < w.x0 || layer > w.x1 || y0 > y1)
            return;
        extents_of<Wide>(rows_z, y0, y1, t.y, t.z);
        for (int y = y0; y <= y1; ++y) {
            const int lo = std::max(rows_z.lo[y - y0] + t.bz, 0), hi = std::min(rows_z.hi[y - y0] + t.bz, w.top);
            if (lo <= hi)
                receiver.cover(layer, y + t.by, lo, hi);
        }
    } else if (t.y1 < 0) {
        const int layer = layer_behind(t.by, (ny > 0) != inverted, receiver.side() - 1);
        if (ny == 0 || layer < w.y0 || layer > w.y1 || x0 > x1)
            return;
        extents_of<Wide>(columns_z, x0, x1, t.x, t.z);
        for (int x = x0; x <= x1; ++x) {
            const int lo = std::max(columns_z.lo[x - x0] + t.bz, 0), hi = std::min(columns_z.hi[x - x0] + t.bz, w.top);
            if (lo <= hi)
                receiver.cover(x + t.bx, layer, lo, hi);
        }
    } else {
        if (nz == 0 || y0 > y1 || x0 > x1)
            return;
        const int layer = layer_behind(t.bz, (nz > 0) != inverted, w.top);
        extents_of<Wide>(rows_x, y0, y1, t.y, t.x);
        for (int y = y0; y <= y1; ++y) {
            if (layer >= 0)
                for (int x = std::max(rows_x.lo[y - y0], x0); x <= std::min(rows_x.hi[y - y0], x1); ++x)
                    receiver.cover(x + t.bx, y + t.by, layer, layer);
            if constexpr (Cross) {
                int first, last;
                crossed_columns<Wide>(t.x, t.y, y, first, last);
                for (int x = std::max(first, x0); x <= std::min(last, x1) && t.bz <= w.top; ++x)
                    receiver.cross(x + t.bx, y + t.by, std::max(t.bz, 0), nz < 0);
            }
        }
    }
}

template <typename Wide, class Plane, bool Cross, class Receiver>
void cover_local(const LocalTriangle<Wide>& t, const Window& w, Receiver& receiver) {
    const int x0 = std::max(w.x0 - t.bx, 0), x1 = std::min(w.x1 - t.bx, t.x1);
    const int y0 = std::max(w.y0 - t.by, 0), y1 = std::min(w.y1 - t.by, t.y1);
    if (x0 > x1 || y0 > y1)
        return;
    const Wide signed_nz = t.normal_z();
    const bool enters = signed_nz < 0;

    if ((t.x1 > 0) + (t.y1 > 0) + (t.z1 > 0) <= 1) {
        // One voxel wide in two axes: every voxel of the bounding box is covered.
        const int lo = t.bz, hi = t.z1 + t.bz;
        for (int y = y0; y <= y1; ++y) {
            int first = 0, last = -1;
            if (Cross && signed_nz != 0)
                crossed_columns<Wide>(t.x, t.y, y, first, last);
            for (int x = x0; x <= x1; ++x) {
                if (Cross && x >= first && x <= last && lo <= w.top)
                    receiver.cross(x + t.bx, y + t.by, std::max(lo, 0), enters);
                if (hi >= 0 && lo <= w.top)
                    receiver.cover(x + t.bx, y + t.by, std::max(lo, 0), std::min(hi, w.top));
            }
        }
        return;
    }

    SlabExtent rows_x, rows_z, columns_z, ends;
    rows_x.clear(y1 - y0 + 1);
    rows_z.clear(y1 - y0 + 1);
    if (Cross)
        ends.clear(y1 - y0 + 1);
    for (int i = 0; i < 3; ++i) {
        extend_vertex<Wide>(rows_x, y0, y1, t.y[i], t.x[i]);
        extend_vertex<Wide>(rows_z, y0, y1, t.y[i], t.z[i]);
        int a = i, b = i == 2 ? 0 : i + 1;
        if (t.y[a] == t.y[b])
            continue;
        if (t.y[a] > t.y[b])
            std::swap(a, b);
        const EdgeWalk<Wide> edge(t.y[a], t.y[b]);
        edge.extend(rows_x, y0, y1, t.x[a], t.x[b] - t.x[a]);
        edge.extend(rows_z, y0, y1, t.z[a], t.z[b] - t.z[a]);
        if (Cross)
            edge.cross(ends, y0, y1, t.x[a], t.x[b] - t.x[a]);
    }
    extents_of<Wide>(columns_z, x0, x1, t.x, t.z);

    // The plane, its normal upwards: lowest z with the box's top corner above it, highest with the bottom below.
    const bool steep = signed_nz == 0; // then the projection along z is a segment, and the rows' extents decide
    const Wide sign = enters ? -1 : 1;
    const Wide nx = sign * t.normal_x(), ny = sign * t.normal_y(), nz = sign * signed_nz;
    const Wide offset = nx * t.x[0] + ny * t.y[0] + nz * t.z[0];
    Plane plane(nx, steep ? Wide{1} : nz * kUnit, ((nx < 0 ? -nx : nx) + (ny < 0 ? -ny : ny)) * kUnit);

    for (int y = y0; y <= y1; ++y) {
        const int from = std::max(rows_x.lo[y - y0], x0), to = std::min(rows_x.hi[y - y0], x1);
        if (from > to)
            continue;
        const int first = Cross ? ends.lo[y - y0] : 0, end = Cross ? ends.hi[y - y0] : 0; // none where steep
        if (!steep)
            plane.start(offset - (nx * (from + (nx > 0)) + ny * (y + (ny > 0))) * kUnit);
        const int row_lo = rows_z.lo[y - y0], row_hi = rows_z.hi[y - y0];
        for (int x = from; x <= to; ++x) {
            int lo = std::max(row_lo, columns_z.lo[x - x0]), hi = std::min(row_hi, columns_z.hi[x - x0]);
            if (!steep) {
                plane.clip(lo, hi);
                plane.next();
            }
            if (lo > hi || lo + t.bz > w.top)
                continue;
            lo = std::max(lo + t.bz, 0);
            if (Cross && x >= first && x < end)
                receiver.cross(x + t.bx, y + t.by, lo, enters);
            if (hi + t.bz >= 0)
                receiver.cover(x + t.bx, y + t.by, lo, std::min(hi + t.bz, w.top));
        }
    }
}

template <typename Wide, class Plane, bool Cross, class Receiver>
void cover(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, bool inverted, Receiver& receiver) {
    const LocalTriangle<Wide> t(a, b, c);
    if (t.x1 < 0 || t.y1 < 0 || t.z1 < 0)
        cover_flat<Wide, Cross>(t, w, inverted, receiver);
    else
        cover_local<Wide, Plane, Cross>(t, w, receiver);
}

} // namespace coverage

/// Reports to a receiver what triangle abc covers inside a window.
///
/// receiver.cover(x, y, lo, hi): voxels lo … hi of column (x, y) are covered.
/// receiver.cross(x, y, z, enters): the ray of column (x, y) crosses the surface below the first voxel above z that the
/// triangle does not cover; `enters` when the ray goes against the normal. Only where Cross.
/// receiver.side(): voxels per side of the grid.
/// `inverted`: the surface's normals point into the solid.
template <bool Cross, class Receiver>
void cover_triangle(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, bool inverted,
                    Receiver& receiver) {
    const int64_t extent = std::max({int64_t{std::max({a.x, b.x, c.x})} - std::min({a.x, b.x, c.x}),
                                     int64_t{std::max({a.y, b.y, c.y})} - std::min({a.y, b.y, c.y}),
                                     int64_t{std::max({a.z, b.z, c.z})} - std::min({a.z, b.z, c.z})});
    if (extent < kTinyExtent)
        coverage::cover<int64_t, coverage::TinyPlaneWalk, Cross>(a, b, c, w, inverted, receiver);
    else if (extent < kNarrowExtent)
        coverage::cover<int64_t, coverage::PlaneWalk<int64_t>, Cross>(a, b, c, w, inverted, receiver);
    else
        coverage::cover<int128, coverage::PlaneWalk<int128>, Cross>(a, b, c, w, inverted, receiver);
}

/// Reports the columns whose rays cross triangle abc, a cap: it closes a hole and covers nothing.
///
/// receiver.cross(x, y, z, enters): z is the first voxel whose sample point, 1/8192 voxel beside its centre, lies
/// above.
template <class Receiver>
void cross_triangle(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, Receiver& receiver) {
    const coverage::LocalTriangle<int128> t(a, b, c);
    const int128 sign = t.normal_z() < 0 ? -1 : 1;
    const int128 nx = sign * t.normal_x(), ny = sign * t.normal_y(), nz = sign * t.normal_z();
    if (nz == 0)
        return;
    const int128 offset = 2 * (nx * t.x[0] + ny * t.y[0] + nz * t.z[0]) - (kUnit + 1) * nz;
    for (int y = std::max(w.y0 - t.by, 0); y <= std::min(w.y1 - t.by, t.y1); ++y) {
        int first, last;
        coverage::crossed_columns<int128>(t.x, t.y, y, first, last);
        for (int x = std::max(first, w.x0 - t.bx); x <= std::min(last, w.x1 - t.bx); ++x) {
            const int128 above = offset - nx * (2 * kUnit * x + kUnit + 1) - ny * (2 * kUnit * y + kUnit + 1);
            const int z = static_cast<int>(floor_div<int128>(above, 2 * kUnit * nz)) + 1 + t.bz;
            if (z <= w.top)
                receiver.cross(x + t.bx, y + t.by, std::max(z, 0), sign < 0);
        }
    }
}

} // namespace voxrt::voxelize
