// The image of a ball under an affine map, by exact integers.
//
// With the map's matrix M and S = M M^T, a point at d from the centre is within where Q(d) = d^T S^-1 d <= 1. A voxel
// is overlapped where the least Q over the closed voxel is below 1: then the interiors meet; where it is 1 they touch.
// Q is convex, so its least value over a box is the least over the plane, line or point of one of the box's 27 faces
// that has it within that face. All of these are quotients of integers:
//
//   the voxel itself       0                                                   at 0
//   a side, d_i fixed      d_i^2 / S_ii                                        at d_j = S_ij d_i / S_ii
//   an edge along k        (S_jj d_i^2 - 2 S_ij d_i d_j + S_ii d_j^2) / A_kk   at d_k = -(A_ki d_i + A_kj d_j) / A_kk
//   a corner               d^T A d / D
//
// with the adjugate A and the determinant D of S (Jacobi's identity gives the third row). float64 finds the ends of a
// column's interval first. Integers decide where an end is nearer to a plane between voxels than float64 can tell, and
// everything about needles and discs that float64 cannot hold.
#pragma once

#include "../grid/wide_integer.h"
#include "column_span.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>

namespace voxrt::voxelize {

/// An ellipsoid; |centre| and the entries of the matrix are at most kCoordinateLimit.
class Ellipsoid {
public:
    /// `frame`: rows of the 3x4 map from the unit ball, 1/4096 voxel, rounded to integers here. A flattened ball is
    /// given a thickness of 1/4096 voxel.
    explicit Ellipsoid(const double* frame);

    int first(int axis) const { return int(std::floor(centre(axis) - extent(axis) - kSlack)); }
    int last(int axis) const { return int(std::floor(centre(axis) + extent(axis) + kSlack)); }

    /// The span among the voxels 0 … `top`: a needle may be far longer than the grid.
    ColumnSpan column(int x, int y, int top) const {
        ColumnSpan span = bracket(x, y);
        span.lo = std::max(span.lo, 0);
        span.hi = std::min(span.hi, top);
        bool sure_lo = false, sure_hi = false;
        if (span.lo <= span.hi && is_round_) {
            const std::optional<double> top = extreme(x, y, 1), bottom = extreme(x, y, -1);
            if (!top || !bottom)
                return {};
            const bool apart = *top - *bottom > 2 * tolerance_;
            sure_lo = apart && std::floor(*bottom - tolerance_) == std::floor(*bottom + tolerance_);
            sure_hi = apart && std::floor(*top - tolerance_) == std::floor(*top + tolerance_);
            span.lo = std::max(span.lo, int(std::floor(*bottom - tolerance_)));
            span.hi = std::min(span.hi, int(std::floor(*top + tolerance_)));
        }
        while (!sure_lo && span.lo <= span.hi && !overlaps(x, y, span.lo))
            ++span.lo;
        while (!sure_hi && span.lo <= span.hi && !overlaps(x, y, span.hi))
            --span.hi;
        if (span.lo <= span.hi)
            find_inner(x, y, top, span);
        return span;
    }

    /// The voxels of a column whose centres are within, among those that it overlaps.
    ColumnSpan centres(int x, int y, int top) const {
        ColumnSpan span = column(x, y, top);
        while (span.lo <= span.hi && !holds_centre(x, y, span.lo))
            ++span.lo;
        while (span.lo <= span.hi && !holds_centre(x, y, span.hi))
            --span.hi;
        return span;
    }

private:
    static constexpr double kSlack = 1e-6; // voxels: more than float64 loses on a coordinate

    double centre(int axis) const { return double(centre_[axis]) / kUnit; }
    double extent(int axis) const { return std::sqrt(shape_[axis][axis]); }

    /// Voxels of a column within the box around the ellipsoid that lies along its principal axes: never too few.
    ColumnSpan bracket(int x, int y) const {
        double low = centre(2) - extent(2) - kSlack, high = centre(2) + extent(2) + kSlack;
        for (int k = 0; k < 3; ++k) {
            const double* n = principal_[k];
            const double at = n[0] * (x + 0.5 - centre(0)) + n[1] * (y + 0.5 - centre(1));
            const double reach = reach_[k] + (std::abs(n[0]) + std::abs(n[1])) / 2 + kSlack;
            if (std::abs(n[2]) < kSlack) {
                if (std::abs(at) > reach + 2 * kSlack * extent(2))
                    return {};
                continue;
            }
            const double middle = centre(2) - at / n[2], half = reach / std::abs(n[2]);
            low = std::max(low, middle - half - kSlack);
            high = std::min(high, middle + half + kSlack);
        }
        ColumnSpan span;
        if (low <= high) {
            span.lo = int(std::floor(low));
            span.hi = int(std::floor(high));
        }
        return span;
    }

    /// Narrows inner_lo … inner_hi to the voxels whose eight corners are within.
    void find_inner(int x, int y, int top, ColumnSpan& span) const {
        // A strictly convex solid holds no end of its interval whole. It may go on beyond the grid.
        int lo = span.lo > 0 ? span.lo + 1 : 0, hi = span.hi < top ? span.hi - 1 : top;
        bool sure_lo = false, sure_hi = false;
        if (is_round_) {
            double low = -1e300, high = 1e300;
            for (int corner = 0; corner < 4; ++corner) {
                const int u = x + (corner & 1), v = y + (corner >> 1);
                const std::optional<double> a = chord(u, v, 1), b = chord(u, v, -1);
                if (!a || !b)
                    return;
                high = std::min(high, *a);
                low = std::max(low, *b);
            }
            const bool apart = high - low > 2 * tolerance_;
            sure_lo = apart && std::ceil(low - tolerance_) == std::ceil(low + tolerance_);
            sure_hi = apart && std::floor(high - tolerance_) == std::floor(high + tolerance_);
            lo = std::max(lo, int(std::ceil(low - tolerance_)));
            hi = std::min(hi, int(std::floor(high + tolerance_)) - 1);
        }
        while (!sure_lo && lo <= hi && !(holds_square(x, y, lo) && holds_square(x, y, lo + 1)))
            ++lo;
        while (!sure_hi && lo <= hi && !(holds_square(x, y, hi) && holds_square(x, y, hi + 1)))
            --hi;
        span.inner_lo = lo;
        span.inner_hi = hi;
    }

    /// Whether the corners of a voxel's lower face are within.
    bool holds_square(int x, int y, int z) const {
        for (int corner = 0; corner < 4; ++corner) {
            const int64_t d[3] = {from_centre(x + (corner & 1), 0), from_centre(y + (corner >> 1), 1),
                                  from_centre(z, 2)};
            if (at(d) > determinant_)
                return false;
        }
        return true;
    }

    bool holds_centre(int x, int y, int z) const {
        const int64_t d[3] = {from_centre(x, 0) + kUnit / 2, from_centre(y, 1) + kUnit / 2,
                              from_centre(z, 2) + kUnit / 2};
        return at(d) <= determinant_;
    }

    /// Whether the interior of a voxel meets that of the ellipsoid.
    bool overlaps(int x, int y, int z) const {
        const int64_t low[3] = {from_centre(x, 0), from_centre(y, 1), from_centre(z, 2)};
        const int64_t high[3] = {low[0] + kUnit, low[1] + kUnit, low[2] + kUnit};
        bool around = true;
        for (int i = 0; i < 3; ++i)
            around = around && low[i] <= 0 && high[i] >= 0;
        if (around)
            return true;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            for (const int64_t d : {low[i], high[i]})
                if (int128(d) * d < square_[i][i] && lies_on_side(d, i, j, low, high) &&
                    lies_on_side(d, i, k, low, high))
                    return true;
            for (const int64_t a : {low[i], high[i]})
                for (const int64_t b : {low[j], high[j]})
                    if (is_edge_below_one(a, b, i, j, k, low[k], high[k]))
                        return true;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const int64_t d[3] = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                                  corner & 4 ? high[2] : low[2]};
            if (at(d) < determinant_)
                return true;
        }
        return false;
    }

    /// Whether the least Q of the plane where coordinate i is d lies between the bounds of coordinate j.
    bool lies_on_side(int64_t d, int i, int j, const int64_t* low, const int64_t* high) const {
        const int128 place = int128(square_[i][j]) * d, per = square_[i][i];
        return low[j] * per <= place && place <= high[j] * per;
    }

    /// Whether Q is below 1 where it is least on the line along k through (a, b), and that lies on the edge.
    bool is_edge_below_one(int64_t a, int64_t b, int i, int j, int k, int64_t low, int64_t high) const {
        const int128 si = square_[i][i], sj = square_[j][j], sij = square_[i][j];
        // Far from the ellipsoid the products below would not fit.
        if (int128(a) * a >= si || int128(b) * b >= sj)
            return false;
        if (sj * (int128(a) * a) - 2 * (sij * a) * b + si * (int128(b) * b) >= adjugate_[k][k])
            return false;
        WideInteger place, first, last;
        place.add(-adjugate_[k][i], a);
        place.add(-adjugate_[k][j], b);
        first.add(adjugate_[k][k], low);
        last.add(adjugate_[k][k], high);
        return first <= place && place <= last;
    }

    /// D Q(d).
    WideInteger at(const int64_t* d) const {
        WideInteger sum;
        for (int i = 0; i < 3; ++i) {
            sum.add(adjugate_[i][i], d[i] * d[i]);
            for (int j = 0; j < i; ++j)
                sum.add(2 * adjugate_[i][j], d[i] * d[j]);
        }
        return sum;
    }

    int64_t from_centre(int cell, int axis) const { return cell * kUnit - centre_[axis]; }

    // From here on float64, in voxels.

    /// What is left for the third coordinate's square; nothing where the line passes by, however float64 rounds.
    std::optional<double> left(double used) const {
        const double rest = 1 - used;
        return rest < -rounding_ ? std::nullopt : std::optional(std::max(rest, 0.0));
    }

    /// Highest (sign 1) or lowest (-1) point of the vertical line through (x, y).
    std::optional<double> chord(double x, double y, int sign) const {
        const double dx = x - centre(0), dy = y - centre(1);
        const double determinant = shape_[0][0] * shape_[1][1] - shape_[0][1] * shape_[0][1];
        const double u = (shape_[1][1] * dx - shape_[0][1] * dy) / determinant;
        const double v = (shape_[0][0] * dy - shape_[0][1] * dx) / determinant;
        const std::optional<double> rest = left(dx * u + dy * v);
        if (!rest)
            return std::nullopt;
        const double mean = shape_[0][2] * u + shape_[1][2] * v;
        const double p = (shape_[1][1] * shape_[0][2] - shape_[0][1] * shape_[1][2]) / determinant;
        const double q = (shape_[0][0] * shape_[1][2] - shape_[0][1] * shape_[0][2]) / determinant;
        const double spread = shape_[2][2] - (shape_[0][2] * p + shape_[1][2] * q);
        return centre(2) + mean + sign * std::sqrt(std::max(spread, 0.0) * *rest);
    }

    /// Highest or lowest point over the cell x … x+1, y … y+1: that of the ellipsoid, or on an edge of the cell.
    std::optional<double> extreme(int x, int y, int sign) const {
        const double up = sign / std::sqrt(shape_[2][2]);
        const double px = centre(0) + shape_[0][2] * up, py = centre(1) + shape_[1][2] * up;
        if (px >= x && px <= x + 1 && py >= y && py <= y + 1)
            return centre(2) + shape_[2][2] * up;
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
        const double d = value - centre(fixed);
        const std::optional<double> rest = left(d * d / shape_[fixed][fixed]);
        if (!rest)
            return std::nullopt;
        const double ratio_free = shape_[fixed][free] / shape_[fixed][fixed];
        const double ratio_up = shape_[fixed][2] / shape_[fixed][fixed];
        const double across = shape_[free][2] - ratio_free * shape_[fixed][2];
        const double up = shape_[2][2] - ratio_up * shape_[fixed][2];
        const double shift = up > 0 ? across / std::sqrt(up) : 0;
        return centre(free) + ratio_free * d + sign * shift * std::sqrt(*rest);
    }

    void find_principal_axes();

    int64_t centre_[3], square_[3][3]; // S, 1/4096 voxel squared
    int128 adjugate_[3][3];
    WideInteger determinant_;
    double shape_[3][3];                // S in voxels
    double principal_[3][3], reach_[3]; // any three directions, and how far the ellipsoid reaches along them
    double rounding_, tolerance_;       // what float64 loses on Q, and on an end of a column's interval, voxels
    bool is_round_;                     // float64 can tell the ends of columns
};

} // namespace voxrt::voxelize
