// What a triangle adds to the volume of a solid (volume_pieces.h), eight columns of voxels at a time. A part of
// vector_coverage_body.h.
//
// A triangle's area in a column, seen along z, is a sum over its edges: what lies below each in the column's square,
// with the sign of the edge's direction (Green's theorem). An edge is held to the square by its ends alone, so all
// columns take the same steps. What is lower than a height is cut off by shortening the edges, and by a line along that
// height. The volume between it and the height comes from the area's first moments.
//
// Error, in u = 2^-53: a point where an edge meets a plane is within 6 u times the triangle's extent in voxels. The
// height at which volumes begin is a quotient of whole numbers, within 2 u. fits_pieces() keeps the slope times the
// extent below a limit: 2^7 for pieces within 2^-42.
//
// Cost: 45 operations on eight doubles per edge; three edges per column, and four per voxel above the column's first.
#pragma once

#include "../vectors/lanes.h"
#include "tile_surface.h"

namespace voxrt::voxelize {
namespace {

// Where a line passes, as seen from the corners of eight columns. `slope`: y per x; `inverse`: x per y; each is 0 where
// it is infinite.
struct Line {
    Lanes x, y; // a point of it
    double slope, inverse;
};

// The area of some parts of columns, and its moments about their corners.
struct Moments {
    Lanes area = all(0), x = all(0), y = all(0);

    // Adds what lies below a line between two places along x; takes it away where `to` is the lower one.
    void add_below(const Line& line, const Lanes& from, const Lanes& to) {
        const Lanes a = in_column(from), b = in_column(to);
        const Lanes at_a = line.y + all(line.slope) * (a - line.x), at_b = line.y + all(line.slope) * (b - line.x);
        // From `low` to `low` + `rise` along `run`, the line is between the sides of the square; then it is beyond.
        const Lanes low = in_column(at_a), high = in_column(at_b), rise = high - low, whole = b - a;
        const Lanes run = rise * all(line.inverse), rest = (at_b - high) * all(line.inverse);
        const Lanes beside = low * whole;
        area = area + (beside + rise * (run * all(0.5) + rest));
        x = x + (beside * (a + b) * all(0.5) +
                 rise * (run * ((b - rest) * all(0.5) - run * all(1 / 6.0)) + rest * (b - rest * all(0.5))));
        y = y + (low * beside + rise * ((low + high) * rest + run * (low + rise * all(1 / 3.0)))) * all(0.5);
    }

private:
    static Lanes in_column(const Lanes& v) { return larger(smaller(v, all(1)), all(0)); }
};

// A triangle over the columns of a tile, which planes between voxels cut. Coordinates are in voxels from the tile's
// lowest column.
class CutTriangle {
public:
    CutTriangle(const double (&x)[3], const double (&y)[3], const double (&z)[3]) {
        int order[3] = {0, 1, 2}; // of corners, by height
        const auto sort = [&](int i, int j) {
            if (z[order[j]] < z[order[i]]) {
                const int swapped = order[i];
                order[i] = order[j];
                order[j] = swapped;
            }
        };
        sort(0, 1);
        sort(1, 2);
        sort(0, 1);
        middle_ = z[order[1]] / kUnit;
        turns_back_ = (order[0] + 1) % 3 == order[1];
        int64_t units[2][3];
        for (int i = 0; i < 2; ++i) {
            units[i][0] = static_cast<int64_t>(x[i + 1] - x[0]);
            units[i][1] = static_cast<int64_t>(y[i + 1] - y[0]);
            units[i][2] = static_cast<int64_t>(z[i + 1] - z[0]);
        }
        const auto product = [&](int i, int j) { return units[0][i] * units[1][j] - units[0][j] * units[1][i]; };
        const int64_t nx = product(1, 2), ny = product(2, 0), nz = product(0, 1);
        slope_x_ = ratio(-nx, nz);
        slope_y_ = ratio(-ny, nz);
        level_slope_ = ratio(-nx, ny);
        level_inverse_ = ratio(-ny, nx);
        for (int place = 0; place < 3; ++place) { // of edges: the long one, the lower one, the upper one
            const int bottom = order[place == 2 ? 1 : 0], top = order[place == 1 ? 1 : 2];
            Edge& edge = edges_[place];
            edge = {x[bottom] / kUnit,
                    y[bottom] / kUnit,
                    z[bottom] / kUnit,
                    x[top] / kUnit,
                    z[top] / kUnit,
                    ratio(y[top] - y[bottom], x[top] - x[bottom]),
                    ratio(x[top] - x[bottom], y[top] - y[bottom]),
                    ratio(x[top] - x[bottom], z[top] - z[bottom]),
                    ratio(y[top] - y[bottom], z[top] - z[bottom]),
                    (bottom + 1) % 3 == top};
        }
    }

    // What eight columns see of it.
    struct View {
        Line lines[3];
        Lanes ends[3];
    };
    View seen_from(const Lanes& left, const Lanes& front) const {
        View view;
        for (int i = 0; i < 3; ++i) {
            const Edge& edge = edges_[i];
            view.lines[i] = {all(edge.x) - left, all(edge.y) - front, edge.slope, edge.inverse};
            view.ends[i] = all(edge.top_x) - left;
        }
        return view;
    }

    // Measures it in the columns.
    Moments whole(const View& view) const {
        Moments found;
        for (int i = 0; i < 3; ++i)
            add_edge(found, edges_[i], view.lines[i], view.ends[i]);
        return found;
    }

    // Measures what of it is lower than `height`.
    Moments below(const View& view, const Lanes& height) const {
        Moments found;
        Lanes ends[3], climbs[3];
        for (int i = 0; i < 3; ++i) {
            climbs[i] = larger(height - all(edges_[i].z), all(0));
            ends[i] = if_less(height, all(edges_[i].top_z), view.lines[i].x + climbs[i] * all(edges_[i].x_per_z),
                              view.ends[i]);
            add_edge(found, edges_[i], view.lines[i], ends[i]);
        }
        const Lanes end_y = view.lines[0].y + climbs[0] * all(edges_[0].y_per_z);
        const Lanes other = if_less(height, all(middle_), ends[1], ends[2]);
        const Line level{ends[0], end_y, level_slope_, level_inverse_};
        found.add_below(level, turns_back_ ? other : ends[0], turns_back_ ? ends[0] : other);
        return found;
    }

    // The volume between a part of it and a level that is so far above its plane at the columns' corners.
    Lanes volume_below(const Moments& part, const Lanes& above) const {
        return above * part.area - all(slope_x_) * part.x - all(slope_y_) * part.y;
    }

    // The height of its plane at a column's corner, and at those of eight.
    double height(int x, int y) const {
        return edges_[0].z + slope_x_ * (x - edges_[0].x) + slope_y_ * (y - edges_[0].y);
    }
    Lanes heights(const View& view) const {
        const Line& line = view.lines[0];
        return all(edges_[0].z) - all(slope_x_) * line.x - all(slope_y_) * line.y;
    }
    // How much the plane rises in a column, and how much its corner is above where the plane is lowest.
    double rise() const { return __builtin_fabs(slope_x_) + __builtin_fabs(slope_y_); }
    double fall() const { return (slope_x_ < 0 ? -slope_x_ : 0) + (slope_y_ < 0 ? -slope_y_ : 0); }
    double lowest() const { return edges_[0].z; }
    double highest() const { return edges_[0].top_z; }

private:
    // An edge of the triangle, upwards.
    struct Edge {
        double x, y, z, top_x, top_z;
        double slope, inverse; // y per x, x per y
        double x_per_z, y_per_z;
        bool walked_upwards; // as the triangle's corners run
    };

    template <class Number> static double ratio(Number a, Number b) {
        return b == 0 ? 0 : static_cast<double>(a) / static_cast<double>(b);
    }

    static void add_edge(Moments& moments, const Edge& edge, const Line& line, const Lanes& end) {
        if (edge.walked_upwards)
            moments.add_below(line, line.x, end);
        else
            moments.add_below(line, end, line.x);
    }

    Edge edges_[3];
    double middle_;                      // the height of the corner between the others
    double slope_x_, slope_y_;           // z per x and y
    double level_slope_, level_inverse_; // y per x and x per y where z does not change
    bool turns_back_;                    // the corners run from the lowest to the middle one
};

// A triangle's pieces in all voxels of columns.
class Pieces {
public:
    Pieces(const CutTriangle& triangle, TileSurface& surface) : triangle_(triangle), surface_(surface) {}

    // The triangle is in voxels lo ... hi of some columns of a group. `above`: how far its plane is above the lowest of
    // these at the columns' corners.
    void add_columns(uint64_t columns, int group, int y, const int32_t* lo, const int32_t* hi, const double* above) {
        for (; columns != 0; columns &= columns - 1) {
            const int i = __builtin_ctzll(columns);
            add_column(group * kLanes + i, y, lo[i], hi[i], above[i]);
        }
    }
    // A column that it covers.
    void add_column(int x, int y) {
        const double height = triangle_.height(x, y), bottom = height - triangle_.fall();
        const double top = bottom + triangle_.rise(), highest = triangle_.highest();
        const int lo = voxel_at(bottom > triangle_.lowest() ? bottom : triangle_.lowest());
        const int hi = -voxel_at(-(top < highest ? top : highest)) - 1;
        add_column(x, y, lo, hi > lo ? hi : lo, height - lo);
    }
    void add_column(int x, int y, int lo, int hi, double above) {
        columns_.x[count_] = x;
        columns_.y[count_] = y;
        columns_.z[count_] = lo;
        columns_.voxels[count_] = hi - lo + 1;
        above_[count_] = above;
        if (++count_ == kLanes)
            finish();
    }

    // Adds the columns that are left to the surface.
    void finish() {
        if (count_ == 0)
            return;
        int most = 0;
        for (int i = 0; i < kLanes; ++i) {
            const int from = i < count_ ? i : 0;
            columns_.x[i] = columns_.x[from];
            columns_.y[i] = columns_.y[from];
            columns_.z[i] = columns_.z[from];
            columns_.voxels[i] = columns_.voxels[from];
            above_[i] = above_[from];
            most = columns_.voxels[i] > most ? columns_.voxels[i] : most;
        }
        const Lanes lowest = load_ints(columns_.z), voxels = load_ints(columns_.voxels), above = load(above_);
        const CutTriangle::View view = triangle_.seen_from(load_ints(columns_.x), load_ints(columns_.y));
        const Moments whole = triangle_.whole(view);
        const Lanes whole_volume = triangle_.volume_below(whole, voxels - above);
        Lanes area_before = all(0), volume_before = all(0);
        for (int n = 1; n <= most; ++n) {
            Lanes area = whole.area, volume = whole_volume;
            if (n < most) {
                const Moments lower = triangle_.below(view, lowest + all(n));
                area = if_less(all(n), voxels, lower.area, area);
                volume = if_less(all(n), voxels, triangle_.volume_below(lower, all(n) - above), volume);
            }
            const int level = (n - 1) % ColumnPieces::kLevels;
            store(columns_.areas[level], area - area_before);
            store(columns_.volumes[level], volume - volume_before - area_before);
            if (level == ColumnPieces::kLevels - 1 || n == most)
                surface_.add_pieces(columns_, count_, n - 1 - level, n);
            area_before = area;
            volume_before = volume;
        }
        count_ = 0;
    }

private:
    // The voxel whose bottom is at or below a height.
    static int voxel_at(double height) {
        const int whole = static_cast<int>(height);
        return whole - (height < whole);
    }

    const CutTriangle& triangle_;
    TileSurface& surface_;
    int count_ = 0;
    ColumnPieces columns_;
    alignas(64) double above_[kLanes];
};

} // namespace
} // namespace voxrt::voxelize
