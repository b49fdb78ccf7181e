// What a triangle adds to the volume of a solid, voxel by voxel.
//
// The volume below the voxel's top and above the triangle counts, positive where the ray upwards enters the solid. A
// piece of the triangle in a voxel adds to that voxel's volume. Its area, seen along z, adds to all voxels above. So
// one sweep upwards gives the volume of the solid in each voxel, as outlines give the coverage of pixels (Levien and
// others, font rasterizers that accumulate signed areas).
//
// The triangle is cut by the planes between voxels (Sutherland and Hodgman 1974). Where an edge meets a plane does not
// depend on the triangle that has the edge, so errors of neighbours cancel. Coordinates of triangles up to
// kNarrowExtent wide are below 2^8 voxels, so a piece's volume has an error below 2^-43; larger ones take TwoDoubles.
#pragma once

#include "../grid/two_doubles.h"
#include "triangle_coverage.h"

#include <array>

namespace voxrt::voxelize {

namespace coverage {

template <typename Number> struct Corner {
    std::array<Number, 3> at; // x, y, z in voxels
};

/// A convex polygon of at most 9 corners.
template <typename Number> class Polygon {
public:
    void add(const Corner<Number>& corner) { corners_[size_t(count_++)] = corner; }
    int count() const { return count_; }
    const Corner<Number>& operator[](int i) const { return corners_[size_t(i)]; }

    /// What lies on one side of the plane where coordinate `axis` is `value`: above it, or below.
    Polygon cut(int axis, double value, bool above) const {
        Polygon kept;
        const Number plane(value);
        auto is_kept = [&](const Corner<Number>& c) {
            return above ? !(c.at[size_t(axis)] < plane) : !(plane < c.at[size_t(axis)]);
        };
        for (int i = 0; i < count_; ++i) {
            const Corner<Number>&a = corners_[size_t(i)], &b = corners_[size_t(i + 1 == count_ ? 0 : i + 1)];
            if (is_kept(a))
                kept.add(a);
            if (is_kept(a) != is_kept(b))
                kept.add(meet(a, b, axis, plane));
        }
        return kept;
    }

    int lowest(int axis) const { return int(std::floor(double(extreme(axis, false)))); }
    int highest(int axis) const { return int(std::ceil(double(extreme(axis, true)))) - 1; }

    /// The area seen along z, positive where corners run counter-clockwise, and the volume between the polygon and the
    /// plane z = top.
    void measure(double x, double y, double top, double& area, double& volume) const {
        area = volume = 0;
        auto local = [&](const Corner<Number>& c, double out[3]) {
            out[0] = double(c.at[0] - Number(x));
            out[1] = double(c.at[1] - Number(y));
            out[2] = double(Number(top) - c.at[2]);
        };
        double a[3], b[3], c[3];
        local(corners_[0], a);
        for (int i = 2; i < count_; ++i) {
            local(corners_[size_t(i - 1)], b);
            local(corners_[size_t(i)], c);
            const double part = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
            area += part;
            volume += part * (a[2] + b[2] + c[2]) / 3;
        }
    }

private:
    static Corner<Number> meet(const Corner<Number>& p, const Corner<Number>& q, int axis, const Number& plane) {
        const auto before = [](const Corner<Number>& a, const Corner<Number>& b) {
            for (size_t i = 0; i < 3; ++i)
                if (a.at[i] < b.at[i] || b.at[i] < a.at[i])
                    return a.at[i] < b.at[i];
            return false;
        };
        const Corner<Number>&a = before(p, q) ? p : q, &b = before(p, q) ? q : p;
        const Number part = (plane - a.at[size_t(axis)]) / (b.at[size_t(axis)] - a.at[size_t(axis)]);
        Corner<Number> found;
        for (size_t i = 0; i < 3; ++i)
            found.at[i] = a.at[i] + part * (b.at[i] - a.at[i]);
        found.at[size_t(axis)] = plane;
        return found;
    }

    Number extreme(int axis, bool most) const {
        Number found = corners_[0].at[size_t(axis)];
        for (int i = 1; i < count_; ++i) {
            const Number& v = corners_[size_t(i)].at[size_t(axis)];
            if (most ? found < v : v < found)
                found = v;
        }
        return found;
    }

    std::array<Corner<Number>, 10> corners_;
    int count_ = 0;
};

/// The height of a triangle's plane, exact but for the last bit of float64; z > 0 in the normal.
template <typename Wide> class PlaneHeight {
public:
    PlaneHeight(const LocalTriangle<Wide>& t, Wide nx, Wide ny, Wide nz)
        : nx_(nx), ny_(ny), nz_(nz), offset_(nx * t.x[0] + ny * t.y[0] + nz * t.z[0]),
          spread_(((nx < 0 ? -nx : nx) + (ny < 0 ? -ny : ny)) * (kUnit / 2)) {}

    /// Above (x, y), in half voxels; the height is in voxels.
    double at(int x, int y) const {
        const Wide numerator = numerator_at(x, y), whole = floor_div<Wide>(numerator, nz_);
        const double part = static_cast<double>(numerator - whole * nz_) / static_cast<double>(nz_);
        return (static_cast<double>(whole) + part) / kUnit;
    }

    /// The lowest and the highest voxel that the plane passes in the cell at (x, y), voxels.
    int lowest(int x, int y) const { return voxel(numerator_at(2 * x + 1, 2 * y + 1) - spread_); }
    int highest(int x, int y) const { return voxel(numerator_at(2 * x + 1, 2 * y + 1) + spread_ - 1); }

private:
    Wide numerator_at(int x, int y) const {
        return offset_ - nx_ * (x * static_cast<Wide>(kUnit / 2)) - ny_ * (y * static_cast<Wide>(kUnit / 2));
    }
    int voxel(Wide numerator) const { return static_cast<int>(floor_div<Wide>(numerator, nz_ * kUnit)); }

    Wide nx_, ny_, nz_, offset_, spread_;
};

/// The cells of a row that lie wholly below a triangle: first … last.
template <typename Number> struct WholeCells {
    int first = 0, last = -1;

    /// `row`: what of the triangle lies between y and y + 1.
    WholeCells(const Polygon<Number>& row, int y) {
        double from = -INFINITY, to = INFINITY;
        for (int side = 0; side < 2; ++side) {
            double least = INFINITY, most = -INFINITY;
            for (int i = 0; i < row.count(); ++i)
                if (double(row[i].at[1]) == y + side) {
                    least = std::min(least, double(row[i].at[0]));
                    most = std::max(most, double(row[i].at[0]));
                }
            from = std::max(from, least);
            to = std::min(to, most);
        }
        if (from + 1 <= to) {
            first = int(std::ceil(from));
            last = int(std::floor(to)) - 1;
        }
    }
};

template <typename Wide, typename Number, class Receiver>
void add_pieces(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, Receiver& receiver) {
    const LocalTriangle<Wide> t(a, b, c);
    const Wide nz = t.normal_z();
    if (nz == 0)
        return;
    const Wide sign = nz < 0 ? -1 : 1;
    const PlaneHeight<Wide> plane(t, sign * t.normal_x(), sign * t.normal_y(), sign * nz);
    Polygon<Number> whole;
    for (int i = 0; i < 3; ++i) {
        auto voxels = [](Wide v) { return Number(static_cast<double>(static_cast<int64_t>(v)) / kUnit); };
        whole.add({{voxels(t.x[i]), voxels(t.y[i]), voxels(t.z[i])}});
    }
    auto report = [&](int x, int y, int z, double area, double volume) {
        const int layer = z + t.bz;
        if (layer < 0) // the whole of the lowest voxel lies above
            receiver.add_piece(x + t.bx, y + t.by, 0, area, area);
        else if (layer <= w.top)
            receiver.add_piece(x + t.bx, y + t.by, layer, area, volume);
    };
    auto add = [&](int x, int y, int z, const Polygon<Number>& piece) {
        if (piece.count() < 3)
            return;
        double area, volume;
        piece.measure(x, y, z + 1, area, volume);
        report(x, y, z, -area, -volume);
    };
    // A flat piece between two voxels counts for the lower one, where it adds no volume.
    auto add_between = [&](int x, int y, int low, int high, const Polygon<Number>& column) {
        if (low >= high)
            add(x, y, high, column);
        else
            for (int z = low; z <= high; ++z)
                add(x, y, z, column.cut(2, z, true).cut(2, z + 1, false));
    };
    auto add_whole_cell = [&](int x, int y) {
        const int low = plane.lowest(x, y), high = plane.highest(x, y);
        if (low >= high) {
            report(x, y, high, -double(sign), -double(sign) * (high + 1 - plane.at(2 * x + 1, 2 * y + 1)));
            return;
        }
        Polygon<Number> cell;
        for (int i = 0; i < 4; ++i) { // in the order of the triangle's corners
            const int u = x + (sign > 0 ? (i == 1 || i == 2) : i > 1);
            const int v = y + (sign > 0 ? i > 1 : (i == 1 || i == 2));
            cell.add({{Number(u), Number(v), Number(plane.at(2 * u, 2 * v))}});
        }
        add_between(x, y, low, high, cell);
    };
    const int y_end = std::min(whole.highest(1), w.y1 - t.by);
    for (int y = std::max(0, w.y0 - t.by); y <= y_end; ++y) {
        const Polygon<Number> row = whole.cut(1, y, true).cut(1, y + 1, false);
        if (row.count() < 3)
            continue;
        const WholeCells<Number> cells(row, y);
        const int x_end = std::min(row.highest(0), w.x1 - t.bx);
        for (int x = std::max(row.lowest(0), w.x0 - t.bx); x <= x_end; ++x) {
            if (x >= cells.first && x <= cells.last) {
                add_whole_cell(x, y);
                continue;
            }
            const Polygon<Number> column = row.cut(0, x, true).cut(0, x + 1, false);
            if (column.count() >= 3)
                add_between(x, y, column.lowest(2), column.highest(2), column);
        }
    }
}

} // namespace coverage

/// Reports to a receiver what triangle abc adds to the volume in the columns of a window.
///
/// receiver.add_piece(x, y, z, area, volume): `volume` to voxel z of column (x, y), `area` to each voxel above, in
/// voxels.
template <class Receiver>
void add_pieces(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, Receiver& receiver) {
    const int64_t extent = std::max({int64_t{std::max({a.x, b.x, c.x})} - std::min({a.x, b.x, c.x}),
                                     int64_t{std::max({a.y, b.y, c.y})} - std::min({a.y, b.y, c.y}),
                                     int64_t{std::max({a.z, b.z, c.z})} - std::min({a.z, b.z, c.z})});
    if (extent < kNarrowExtent)
        coverage::add_pieces<int64_t, double>(a, b, c, w, receiver);
    else
        coverage::add_pieces<int128, TwoDoubles>(a, b, c, w, receiver);
}

} // namespace voxrt::voxelize
