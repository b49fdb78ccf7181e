// Which voxels a triangle's plane passes, eight columns at a time. A part of vector_coverage_body.h.
//
// The plane is walked with whole quotients and remainders, as PlaneWalk does it (triangle_coverage.h). Remainders of a
// narrow triangle are below 2^51, and held in doubles; those of others are integers.
#pragma once

#include "../vectors/lanes.h"
#include "triangle_coverage.h"

namespace voxrt::voxelize {
namespace {

constexpr double kBeyond = 0x1p30; // voxels: beyond all, in either direction
constexpr double kVoxel = kUnit;

// A triangle: x and y from the window's lowest column, z from the triangle's lowest voxel, `bottom`.
struct Corners {
    double x[3], y[3], z[3];
    int bottom;
};

inline Lanes nearest_whole(const Lanes& v) {
    const Lanes large = all(0x1.8p52);
    return v + large - large;
}

// Intervals of eight slabs, or of eight planes between slabs.
struct EightExtents {
    Lanes lo = all(kBeyond), hi = all(-kBeyond);
    // Nothing changes where an end is not a number.
    void extend(const Lanes& low, const Lanes& high) {
        lo = smaller(low, lo);
        hi = larger(high, hi);
    }
};

// Remainders: Lanes for narrow triangles, LongLanes for others.
inline void set_all(Lanes& lanes, int64_t v) { lanes = all(static_cast<double>(v)); }
inline Lanes one_unless_less(const Lanes& a, const Lanes& b) { return if_less(a, b, all(0), all(1)); }
inline Lanes less_if_reached(const Lanes& rest, const Lanes& limit) {
    return rest - if_less(rest, limit, all(0), limit);
}
inline Lanes chosen(Mask lanes, const Lanes& v) { return choose(lanes, v, all(0)); }
inline Lanes numbers(const Lanes& lanes) { return lanes; }

template <class Operation> inline LongLanes each_long(const Operation& operation) {
    LongLanes out;
    for (int i = 0; i < kParts; ++i)
        out.part[i] = operation(i);
    return out;
}
inline Lanes numbers(const LongLanes& lanes) {
    return each([&](int i) { return __builtin_convertvector(lanes.part[i], Part); });
}
inline LongLanes operator+(const LongLanes& a, const LongLanes& b) {
    return each_long([&](int i) { return a.part[i] + b.part[i]; });
}
inline LongLanes operator-(const LongLanes& a, const LongLanes& b) {
    return each_long([&](int i) { return a.part[i] - b.part[i]; });
}
inline void set_all(LongLanes& lanes, int64_t v) {
    lanes = each_long([&](int) { return v - LongPart{}; });
}
inline Lanes one_unless_less(const LongLanes& a, const LongLanes& b) {
    return each([&](int i) {
        return reinterpret_cast<Part>((a.part[i] >= b.part[i]) & reinterpret_cast<LongPart>(1 - Part{}));
    });
}
inline LongLanes less_if_reached(const LongLanes& rest, const LongLanes& limit) {
    return each_long([&](int i) { return rest.part[i] - ((rest.part[i] >= limit.part[i]) & limit.part[i]); });
}
inline LongLanes chosen(Mask lanes, const LongLanes& v) {
    return each_long([&](int i) {
        LongPart found = v.part[i];
        for (int lane = 0; lane < kPartLanes; ++lane)
            found[lane] = lanes >> (i * kPartLanes + lane) & 1 ? found[lane] : 0;
        return found;
    });
}

// A quotient of whole numbers: its whole part, and the rest of the numerator.
template <class Rest> struct Quotients {
    Lanes whole;
    Rest rest;

    Quotients() = default;
    Quotients(const Lanes& whole, const Rest& rest) : whole(whole), rest(rest) {}
    template <class Wide> Quotients(Wide numerator, Wide denominator) {
        const Wide quotient = floor_div<Wide>(numerator, denominator);
        whole = all(static_cast<double>(static_cast<int64_t>(quotient)));
        set_all(rest, static_cast<int64_t>(numerator - quotient * denominator));
    }
    void add(const Quotients& other, const Rest& denominator) {
        rest = rest + other.rest;
        whole = whole + other.whole + one_unless_less(rest, denominator);
        rest = less_if_reached(rest, denominator);
    }
};

// The voxels that a triangle's plane passes, eight columns at a time, row by row.
template <class Wide, class Rest> class PlaneRows {
public:
    // Begins at column x of row y.
    PlaneRows(const Corners& t, int x, int y) {
        int64_t edge[2][3];
        for (int i = 0; i < 2; ++i) {
            edge[i][0] = static_cast<int64_t>(t.x[i + 1] - t.x[0]);
            edge[i][1] = static_cast<int64_t>(t.y[i + 1] - t.y[0]);
            edge[i][2] = static_cast<int64_t>(t.z[i + 1] - t.z[0]);
        }
        auto product = [&](int u, int v) { return edge[0][u] * edge[1][v] - edge[0][v] * edge[1][u]; };
        int64_t nx = product(1, 2), ny = product(2, 0), nz = product(0, 1);
        enters_ = nz < 0;
        if (nz == 0) { // it passes all voxels of the columns that the rows and columns leave
            set_all(unit_, 1);
            set_all(carry_, 1);
            height_ = all(4 * kBeyond);
            row_ = Quotients<Rest>(Wide{0}, Wide{1});
            corner_ = centre_ = next_row_ = next_group_ = row_;
            per_unit_ = 1;
            row_.whole = all(-2 * kBeyond);
            return;
        }
        if (enters_) {
            nx = -nx;
            ny = -ny;
            nz = -nz;
        }
        const Wide unit = nz * kUnit;
        set_all(unit_, static_cast<int64_t>(unit));
        const Wide spread = static_cast<Wide>((nx < 0 ? -nx : nx) + (ny < 0 ? -ny : ny)) * kUnit;
        const Quotients<Rest> height(spread - 1, unit);
        height_ = height.whole;
        carry_ = unit_ - height.rest;
        per_unit_ = 1 / static_cast<double>(unit);
        slope_x_ = -static_cast<double>(nx) / static_cast<double>(nz);
        slope_y_ = -static_cast<double>(ny) / static_cast<double>(nz);
        corner_ = Quotients<Rest>(static_cast<Wide>((nx > 0 ? nx : 0) + (ny > 0 ? ny : 0)) * kUnit, unit);
        centre_ = Quotients<Rest>((spread - unit) / 2, unit);
        auto corner = [&](int64_t n, double at) { return static_cast<Wide>(n) * static_cast<int64_t>(at); };
        row_ = Quotients<Rest>(corner(nx, t.x[0]) + corner(ny, t.y[0]) + corner(nz, t.z[0]) -
                                   corner(nx, (x + (nx > 0)) * kVoxel) - corner(ny, (y + (ny > 0)) * kVoxel),
                               unit);
        row_.whole = row_.whole + all(t.bottom);
        next_row_ = Quotients<Rest>(corner(-ny, kVoxel), unit);
        Quotients<Rest> columns(corner(-nx, kVoxel), unit); // 1, 2, 4 and at last 8
        for (const Mask lanes : {0xAA, 0xCC, 0xF0}) {
            row_.add({chosen(lanes, columns.whole), chosen(lanes, columns.rest)}, unit_);
            columns.add(columns, unit_);
        }
        next_group_ = columns;
    }

    // Whether rays upwards enter the solid.
    bool enters() const { return enters_; }

    void begin_row() { group_ = row_; }
    void end_row() { row_.add(next_row_, unit_); }
    void end_group() { group_.add(next_group_, unit_); }

    // Narrows the voxels of a group's columns.
    void narrow(EightExtents& z) const {
        z.lo = larger(group_.whole, z.lo);
        z.hi = smaller(group_.whole + height_ + one_unless_less(group_.rest, carry_), z.hi);
    }

    double slope_x() const { return slope_x_; }
    double slope_y() const { return slope_y_; }

    // The highest voxels of a group's columns whose centre is not above the plane. `on`: where it lies on the plane;
    // `height`: that of the plane there, half a voxel less.
    Lanes centres(Mask& on, Lanes& heights) const {
        Quotients<Rest> height = group_;
        height.add(centre_, unit_);
        heights = height.whole + numbers(height.rest) * all(per_unit_);
        Rest one;
        set_all(one, 1);
        on = less(one_unless_less(height.rest, one), all(1));
        return height.whole;
    }

    // How far the plane is above some voxels at the lowest corners of a group's columns.
    Lanes above_corners(const Lanes& voxels) const {
        Quotients<Rest> height = group_;
        height.add(corner_, unit_);
        return ((height.whole - voxels) * numbers(unit_) + numbers(height.rest)) * all(per_unit_);
    }

private:
    bool enters_;
    double per_unit_;
    double slope_x_ = 0, slope_y_ = 0; // z per x and y
    Rest unit_, carry_;                // carry_: which rest makes one more than height_
    Lanes height_;                     // (spread - 1) / unit
    Quotients<Rest> corner_;           // from where the plane is lowest in a column to the column's lowest corner
    Quotients<Rest> centre_;           // and to its centre, less half a voxel
    Quotients<Rest> row_, next_row_, group_, next_group_;
};

} // namespace
} // namespace voxrt::voxelize
