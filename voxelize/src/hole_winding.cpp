#include "hole_winding.h"

#include "parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxrt {
namespace {

constexpr double kStep = 1.0 / 1024; // what one node or cap may be off by when it is taken as far
constexpr double kSlight = 1.0 / 64; // what one cap may add without a closer look
constexpr double kFarthest = 0.5;    // of its distance, the most that the ends of a dipole may lie off
constexpr double kPerTurn = 1 / (4 * std::numbers::pi);

Point plus(const Point& a, double s, const Point& b) { return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point centre(const HoleWinding::Cap& cap) {
    const auto& [a, b, c] = cap;
    return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
}
/// Twice its area, along its normal.
Point normal(const HoleWinding::Cap& cap) { return cross(minus(cap[1], cap[0]), minus(cap[2], cap[0])); }

/// What a dipole of unit area, at most t < 1 of its distance off, may be off by at distance 1.
double dipole_error(double t) { return kPerTurn * t * t * (3 - 2 * t) / ((1 - t) * (1 - t)); }

/// Tangents of half solid angles, multiplied as complex numbers: a sum of angles with one arc tangent at the end.
class AngleSum {
public:
    /// Adds the angle of (under, over).
    void add(double over, double under) {
        const double size = std::abs(over) + std::abs(under);
        if (size == 0)
            return;
        over /= size;
        under /= size;
        const double x = x_ * under - y_ * over, y = x_ * over + y_ * under;
        // Past half a turn the sign of y changes against that of both angles.
        if (y_ >= 0 && over >= 0 && y < 0)
            ++turns_;
        else if (y_ < 0 && over < 0 && y >= 0)
            --turns_;
        const double scale = 1 / (std::abs(x) + std::abs(y));
        x_ = x * scale;
        y_ = y * scale;
    }
    double over_four_pi() const { return 2 * kPerTurn * (std::atan2(y_, x_) + 2 * std::numbers::pi * turns_); }

private:
    double x_ = 1, y_ = 0;
    int turns_ = 0;
};

/// On which side of a cap's plane q lies: the sign of the solid angle. Exact; on the plane q counts as just below it,
/// or left of it where it is upright, as the crossings of columns have it.
int side(const HoleWinding::Cap& cap, const Point& q) {
    auto whole = [](double v) { return int128(std::llround(v * (2 * kUnit))); };
    int128 v[3][3];
    for (int i = 0; i < 3; ++i) {
        v[i][0] = whole(cap[i].x - q.x);
        v[i][1] = whole(cap[i].y - q.y);
        v[i][2] = whole(cap[i].z - q.z);
    }
    auto area = [&v](int j, int k) {
        return (v[1][j] - v[0][j]) * (v[2][k] - v[0][k]) - (v[1][k] - v[0][k]) * (v[2][j] - v[0][j]);
    };
    const int128 nx = area(1, 2), ny = area(2, 0), nz = area(0, 1);
    const int128 height = v[0][0] * nx + v[0][1] * ny + v[0][2] * nz;
    for (const int128 decisive : {height, nz, nx, ny})
        if (decisive != 0)
            return decisive < 0 ? -1 : 1;
    return 0;
}

/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983: the tangent of half of it is over / under.
void add_solid_angle(AngleSum& sum, const HoleWinding::Cap& cap, const Point& q) {
    constexpr double kDoubtful = 1e-12; // of the volume that float64 sees
    const Point a = minus(cap[0], q), b = minus(cap[1], q), c = minus(cap[2], q);
    const double la = length(a), lb = length(b), lc = length(c), size = la * lb * lc;
    double over = dot(a, cross(b, c));
    const double under = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    if (under <= kDoubtful * size && std::abs(over) <= kDoubtful * size) {
        const int sign = side(cap, q);
        if (sign == 0)
            return;
        over = sign * std::max(std::abs(over), 1e-30 * size);
    }
    sum.add(over, under);
}

/// A cap about the centre of a ball.
struct CapSlope {
    Point gradient{0, 0, 0};
    double error = 0;
    bool crosses = false;
};

/// The solid angle changes as the rim of the cap alone lets it, like the field of a current in a wire (Biot and
/// Savart). The field of a short wire, along x d / d^3, changes by at most 2 length / d^3 a way. False where the error
/// would not be below `limit`.
bool find_slope(const HoleWinding::Cap& cap, const Point& q, double reach, double limit, CapSlope& slope) {
    Point corners[3];
    double lengths[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = minus(cap[i], q);
        lengths[i] = length(corners[i]);
    }
    const Point n = normal(cap);
    bool beside = false;
    for (int i = 0; i < 3; ++i) {
        const int j = i == 2 ? 0 : i + 1;
        const Point &a = corners[i], &b = corners[j], way = minus(b, a);
        const double square = dot(way, way);
        if (square == 0)
            continue;
        const double gap = length(plus(a, std::clamp(-dot(a, way) / square, 0.0, 1.0), way)) - reach;
        if (gap <= 0)
            return false;
        // Summed along the edge or, where that is less, along the whole line.
        slope.error += kPerTurn * reach * reach * std::min(std::sqrt(square) / gap, 2.0) / (gap * gap);
        if (slope.error >= limit)
            return false;
        const double product = lengths[i] * lengths[j];
        slope.gradient =
            plus(slope.gradient, kPerTurn * (lengths[i] + lengths[j]) / (product * (product + dot(a, b))), cross(a, b));
        beside = beside || dot(cross(n, way), a) > 0;
    }
    const double height = dot(corners[0], n);
    slope.crosses = !beside && height * height <= reach * reach * dot(n, n);
    return true;
}

} // namespace

HoleWinding::HoleWinding(std::vector<Cap> caps) : caps_(std::move(caps)) {
    if (!caps_.empty())
        build(0, uint32_t(caps_.size()));
}

int32_t HoleWinding::build(uint32_t first, uint32_t last) {
    pulse(10 * (last - first));
    Node node;
    node.first = first;
    node.last = last;
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300}, weighted{0, 0, 0};
    for (uint32_t i = first; i < last; ++i) {
        const Cap& cap = caps_[i];
        const Point n = normal(cap), at = centre(cap);
        const double area = length(n) / 2;
        node.dipole = plus(node.dipole, 0.5, n);
        node.area += area;
        weighted = plus(weighted, area, at);
        low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
    }
    node.centre = node.area > 0 ? Point{weighted.x / node.area, weighted.y / node.area, weighted.z / node.area} : low;
    for (uint32_t i = first; i < last; ++i) {
        const Cap& cap = caps_[i];
        const Point n = normal(cap), off = minus(centre(cap), node.centre);
        const double products[6] = {n.x * off.x,
                                    n.y * off.y,
                                    n.z * off.z,
                                    (n.x * off.y + n.y * off.x) / 2,
                                    (n.y * off.z + n.z * off.y) / 2,
                                    (n.z * off.x + n.x * off.z) / 2};
        for (int j = 0; j < 6; ++j)
            node.moment[j] += products[j] / 2;
        for (const Point& corner : caps_[i])
            node.radius = std::max(node.radius, length(minus(corner, node.centre)));
    }
    const auto index = int32_t(nodes_.size());
    nodes_.push_back(node);
    if (last - first > 1) {
        const double sides[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
        const auto axis = std::max_element(sides, sides + 3) - sides;
        const uint32_t half = first + (last - first) / 2;
        std::nth_element(caps_.begin() + first, caps_.begin() + half, caps_.begin() + last,
                         [axis](const Cap& a, const Cap& b) {
                             const Point p = centre(a), q = centre(b);
                             return axis == 0 ? p.x < q.x : axis == 1 ? p.y < q.y : p.z < q.z;
                         });
        const int32_t left = build(first, half), right = build(half, last);
        nodes_[index].left = left;
        nodes_[index].right = right;
    }
    return index;
}

HoleView HoleWinding::start() const {
    HoleView view;
    if (!nodes_.empty())
        view.open.push_back(0);
    return view;
}

double HoleWinding::dipole_angle(const Node& node, const Point& d, double square) {
    const double* m = node.moment;
    const double twist = m[0] * d.x * d.x + m[1] * d.y * d.y + m[2] * d.z * d.z +
                         2 * (m[3] * d.x * d.y + m[4] * d.y * d.z + m[5] * d.z * d.x);
    return kPerTurn * (dot(node.dipole, d) + m[0] + m[1] + m[2] - 3 * twist / square) / (square * std::sqrt(square));
}

void HoleWinding::add_dipole(const Node& node, const Point& d, double square, LinearAngle& sum) {
    const double cube = kPerTurn / (square * std::sqrt(square));
    sum.angle += dipole_angle(node, d, square);
    sum.gradient = plus(plus(sum.gradient, -cube, node.dipole), 3 * cube * dot(node.dipole, d) / square, d);
}

void HoleWinding::look(const HoleView& from, const Point& centre, double reach, HoleView& to) const {
    to.centre = centre;
    to.far = from.far;
    to.far.angle += dot(from.far.gradient, minus(centre, from.centre));
    to.near = {};
    to.open.clear();
    to.doubt = 0;
    to.crossed = false;
    AngleSum far, near;
    int32_t stack[64];
    uint32_t looked_at = 0;
    for (const uint32_t root : from.open) {
        int depth = 0;
        stack[depth++] = int32_t(root);
        while (depth > 0) {
            ++looked_at;
            const int32_t index = stack[--depth];
            const Node& node = nodes_[index];
            const Point d = minus(node.centre, centre);
            const double square = dot(d, d), distance = std::sqrt(square), spread = node.radius + reach;
            double error = 1;
            if (spread < kFarthest * distance)
                error = node.area * dipole_error(spread / distance) / square;
            if (error <= kStep) {
                add_dipole(node, d, square, to.far);
                to.far.error += error;
                continue;
            }
            const bool is_cap = node.left < 0;
            if (!is_cap && node.radius > reach) {
                stack[depth++] = node.left;
                stack[depth++] = node.right;
                continue;
            }
            const double gap = distance - spread;
            if (is_cap) {
                const Cap& cap = caps_[node.first];
                if (reach == 0) {
                    add_solid_angle(far, cap, centre);
                    continue;
                }
                const double most = gap > 0 ? std::min({0.5, error, kPerTurn * node.area / (gap * gap)}) : 0.5;
                CapSlope slope;
                if (most > kSlight && find_slope(cap, centre, reach, most, slope)) {
                    const bool stays = slope.crosses || slope.error > kStep;
                    add_solid_angle(stays ? near : far, cap, centre);
                    LinearAngle& sum = stays ? to.near : to.far;
                    sum.gradient = plus(sum.gradient, 1, slope.gradient);
                    sum.error += slope.error;
                    to.crossed = to.crossed || slope.crosses;
                    if (stays)
                        to.open.push_back(uint32_t(index));
                    continue;
                }
            }
            to.open.push_back(uint32_t(index));
            // Caps that may pass through the ball jump by a whole number there.
            const double most =
                gap > 0 ? std::min((node.last - node.first) / 2.0, kPerTurn * node.area / (gap * gap)) : 1;
            if (error < most) {
                add_dipole(node, d, square, to.near);
                to.near.error += error;
            } else {
                to.doubt += most;
            }
        }
    }
    pulse(2 * looked_at);
    to.far.angle += far.over_four_pi();
    to.near.angle += near.over_four_pi();
}

double HoleWinding::at(const Point& q, double tolerance) const {
    double total = 0;
    AngleSum near;
    int32_t stack[64];
    int depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    const double share = nodes_.empty() ? 0 : tolerance / nodes_[0].area;
    uint32_t looked_at = 0;
    while (depth > 0) {
        ++looked_at;
        const Node& node = nodes_[stack[--depth]];
        const Point d = minus(node.centre, q);
        const double square = dot(d, d), distance = std::sqrt(square), t = node.radius / distance;
        if (t < kFarthest && dipole_error(t) <= share * square) {
            total += dipole_angle(node, d, square);
        } else if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
        } else {
            add_solid_angle(near, caps_[node.first], q);
        }
    }
    pulse(2 * looked_at);
    return total + near.over_four_pi();
}

} // namespace voxrt
