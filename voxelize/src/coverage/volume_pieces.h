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
// Cells that lie wholly below the triangle have a closed form, in heights from their lowest corner.
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

    /// What lies where coordinate `axis` is from `value` to `value` + 1.
    Polygon slab(int axis, double value) const {
        Polygon kept;
        const Number planes[2] = {Number(value), Number(value + 1)};
        auto side = [&](const Corner<Number>& c) {
            return c.at[size_t(axis)] < planes[0] ? -1 : planes[1] < c.at[size_t(axis)] ? 1 : 0;
        };
        int before = side(corners_[0]);
        for (int i = 0; i < count_; ++i) {
            const Corner<Number>&a = corners_[size_t(i)], &b = corners_[size_t(i + 1 == count_ ? 0 : i + 1)];
            const int after = side(b);
            if (before == 0)
                kept.add(a);
            else if (before != after)
                kept.add(meet(a, b, axis, planes[before > 0]));
            if (after != 0 && before != after)
                kept.add(meet(a, b, axis, planes[after > 0]));
            before = after;
        }
        return kept;
    }

    int lowest(int axis) const {
        const auto value = double(extreme(axis, false));
        const int whole = int(value);
        return whole - (value < whole);
    }
    int highest(int axis) const {
        const auto value = double(extreme(axis, true));
        const int whole = int(value);
        return whole - !(value > whole);
    }

    /// The polygon with another origin. Coordinates near it need no more than float64.
    Polygon<double> from(double x, double y, double z) const {
        Polygon<double> moved;
        for (int i = 0; i < count_; ++i) {
            const auto& at = corners_[size_t(i)].at;
            moved.add({{double(at[0] - Number(x)), double(at[1] - Number(y)), double(at[2] - Number(z))}});
        }
        return moved;
    }

    /// The area seen along z, positive where corners run counter-clockwise, and the volume between the polygon and the
    /// plane z = top. In float64.
    void measure(double top, double& area, double& volume) const {
        double area2 = 0, volume6 = 0;
        const auto& a = corners_[0].at;
        for (int i = 2; i < count_; ++i) {
            const auto &b = corners_[size_t(i - 1)].at, &c = corners_[size_t(i)].at;
            const double part = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            area2 += part;
            volume6 += part * ((top - a[2]) + (top - b[2]) + (top - c[2]));
        }
        area = area2 / 2;
        volume = volume6 / 6;
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

/// How much of a cell lies above a plane: the area of the part that is lower than a height, and its integral.
///
/// Heights are from the cell's lowest corner. The plane rises by `less` along one side, and by `more` along the other.
class CellBelowPlane {
public:
    CellBelowPlane(double slope_x, double slope_y)
        : less_(std::min(slope_x, slope_y)), more_(std::max(slope_x, slope_y)), rise_(slope_x + slope_y) {}

    double area(double height) const {
        if (height <= 0)
            return 0;
        if (height >= rise_)
            return 1;
        if (height < less_)
            return height * height / (2 * less_ * more_);
        if (height <= more_)
            return (height - less_ / 2) / more_;
        const double left = rise_ - height;
        return 1 - left * left / (2 * less_ * more_);
    }

    /// The integral of the area. Each of its four parts is free of cancellation.
    double volume(double from, double to) const {
        double sum = 0, at = std::max(from, 0.0);
        auto next = [&](double end) { return std::min(end, to); };
        if (at < less_ && at < to) {
            const double end = next(less_);
            sum += (end - at) * (end * end + end * at + at * at) / (6 * less_ * more_);
            at = end;
        }
        if (at < more_ && at < to) {
            const double end = next(more_);
            sum += (end - at) * (end + at - less_) / (2 * more_);
            at = end;
        }
        if (at < rise_ && at < to) {
            const double end = next(rise_), a = rise_ - at, b = rise_ - end;
            sum += (end - at) - (end - at) * (a * a + a * b + b * b) / (6 * less_ * more_);
            at = end;
        }
        return at < to ? sum + (to - at) : sum;
    }

    double middle() const { return rise_ / 2; }

private:
    double less_, more_, rise_;
};

/// The plane of a triangle over cells; z > 0 in the normal.
template <typename Wide> class PlaneHeight {
public:
    PlaneHeight(const LocalTriangle<Wide>& t, Wide nx, Wide ny, Wide nz)
        : nx_(nx), ny_(ny), unit_(nz * kUnit), offset_(nx * t.x[0] + ny * t.y[0] + nz * t.z[0]),
          spread_(((nx < 0 ? -nx : nx) + (ny < 0 ? -ny : ny)) * (kUnit / 2)), cell_(slope(nx, nz), slope(ny, nz)) {}

    const CellBelowPlane& cell() const { return cell_; }

    /// The voxels that the plane passes in a cell, and how far above the lowest one's bottom it begins.
    struct Heights {
        int low, high;
        double begin;
    };
    Heights over(int x, int y) const {
        const Wide centre = offset_ - nx_ * ((2 * x + 1) * static_cast<Wide>(kUnit / 2)) -
                            ny_ * ((2 * y + 1) * static_cast<Wide>(kUnit / 2));
        const Wide least = centre - spread_, low = floor_div<Wide>(least, unit_);
        return {static_cast<int>(low), static_cast<int>(floor_div<Wide>(centre + spread_ - 1, unit_)),
                static_cast<double>(least - low * unit_) / static_cast<double>(unit_)};
    }

private:
    static double slope(Wide n, Wide nz) { return std::abs(static_cast<double>(n) / static_cast<double>(nz)); }

    Wide nx_, ny_, unit_, offset_, spread_;
    CellBelowPlane cell_;
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
    auto add_column = [&](int x, int y, const Polygon<Number>& column) {
        // A flat piece between two voxels counts for the lower one, where it adds no volume.
        const int high = column.highest(2), low = std::min(column.lowest(2), high);
        const Polygon<double> local = column.from(x, y, low);
        if (high == low + 1) { // most columns: the upper piece is what the lower one leaves
            const Polygon<double> lower = local.slab(2, 0);
            double area, volume, lower_area = 0, lower_volume = 0;
            local.measure(2, area, volume);
            if (lower.count() >= 3) {
                lower.measure(1, lower_area, lower_volume);
                report(x, y, low, -lower_area, -lower_volume);
            }
            report(x, y, high, lower_area - area, lower_area + lower_volume - volume);
            return;
        }
        for (int z = low; z <= high; ++z) {
            const Polygon<double> piece = low == high ? local : local.slab(2, z - low);
            if (piece.count() < 3)
                continue;
            double area, volume;
            piece.measure(z + 1 - low, area, volume);
            report(x, y, z, -area, -volume);
        }
    };
    const double facing = -static_cast<double>(sign);
    auto add_whole_cell = [&](int x, int y) {
        const auto [low, high, begin] = plane.over(x, y);
        if (low >= high) {
            report(x, y, high, facing, facing * (high + 1 - low - (begin + plane.cell().middle())));
            return;
        }
        double below = 0; // the area that is lower
        for (int z = low; z <= high; ++z) {
            const double top = z + 1 - low - begin, area = z == high ? 1 : plane.cell().area(top);
            report(x, y, z, facing * (area - below), facing * (plane.cell().volume(top - 1, top) - below));
            below = area;
        }
    };
    const int y_end = std::min(whole.highest(1), w.y1 - t.by);
    for (int y = std::max(0, w.y0 - t.by); y <= y_end; ++y) {
        if (!receiver.wants(y + t.by))
            continue;
        const Polygon<Number> row = whole.slab(1, y);
        if (row.count() < 3)
            continue;
        const WholeCells<Number> cells(row, y);
        const int x_end = std::min(row.highest(0), w.x1 - t.bx);
        for (int x = std::max(row.lowest(0), w.x0 - t.bx); x <= x_end; ++x) {
            if (!receiver.wants(x + t.bx, y + t.by))
                continue;
            if (x >= cells.first && x <= cells.last) {
                add_whole_cell(x, y);
                continue;
            }
            const Polygon<Number> column = row.slab(0, x);
            if (column.count() >= 3)
                add_column(x, y, column);
        }
    }
}

} // namespace coverage

/// Reports to a receiver what triangle abc adds to the volume in the columns of a window.
///
/// receiver.wants(y), receiver.wants(x, y): whether it wants pieces of a row, and of a column.
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
