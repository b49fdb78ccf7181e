#include "cap_winding.h"

#include "../work/interrupt.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace voxrt::voxelize {
namespace {

constexpr double kFarthestEnd = 0.5; // largest distance of a dipole's ends from its centre, of its distance
constexpr double kInverse4Pi = 1 / (4 * std::numbers::pi);

Point plus(const Point& a, double s, const Point& b) { return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point centre(const CapWinding::Cap& cap) {
    const auto& [a, b, c] = cap;
    return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
}
/// Twice its area, along its normal.
Point normal(const CapWinding::Cap& cap) { return cross(minus(cap[1], cap[0]), minus(cap[2], cap[0])); }

/// Error bound of a dipole at distance 1, whose area is 4 pi and whose ends lie at most t < 1 off its centre.
double dipole_error(double t) { return t * t * (3 - 2 * t) / ((1 - t) * (1 - t)); }

/// Tangents of half solid angles, multiplied as complex numbers: a sum of angles with one arc tangent at the end.
class AngleSum {
public:
    /// Adds an angle whose half has the tangent over / under.
    void add(double over, double under) {
        const double size = std::abs(over) + std::abs(under);
        if (size == 0)
            return;
        over /= size;
        under /= size;
        const double x = x_ * under - y_ * over, y = x_ * over + y_ * under;
        // Beyond pi the sign of y is opposite to that of both angles.
        if (y_ >= 0 && over >= 0 && y < 0)
            ++wraps_;
        else if (y_ < 0 && over < 0 && y >= 0)
            --wraps_;
        const double scale = 1 / (std::abs(x) + std::abs(y));
        x_ = x * scale;
        y_ = y * scale;
    }
    double over_4_pi() const { return 2 * kInverse4Pi * (std::atan2(y_, x_) + 2 * std::numbers::pi * wraps_); }

private:
    double x_ = 1, y_ = 0;
    int wraps_ = 0;
};

/// On which side of a cap's plane q lies: the sign of the solid angle. Exact for coordinates in voxels. On the plane q
/// counts as just below it, or left of it where it is upright, as in the crossings of columns.
///
/// Caps in the frame of a shared mesh may have coordinates of any size: they are scaled so that the products of three
/// fit 128 bits.
int side(const CapWinding::Cap& cap, const Point& q) {
    double largest = 0;
    for (const Point& corner : cap)
        largest = std::max({largest, std::abs(corner.x - q.x), std::abs(corner.y - q.y), std::abs(corner.z - q.z)});
    if (!(std::isfinite(largest) && std::isfinite(q.x + q.y + q.z)))
        return 0;
    const double scale = std::min(2.0 * kUnit, 0x1p40 / std::max(largest, 0x1p-100));
    auto whole = [scale](double v) { return int128(std::llround(v * scale)); };
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

/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983: the tangent of half the angle is over /
/// under.
void add_solid_angle(AngleSum& sum, const CapWinding::Cap& cap, const Point& q) {
    constexpr double kRoundoff = 1e-12; // of the products: below it the sign is decided in integers
    const Point a = minus(cap[0], q), b = minus(cap[1], q), c = minus(cap[2], q);
    const double la = length(a), lb = length(b), lc = length(c), size = la * lb * lc;
    double over = dot(a, cross(b, c));
    const double under = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    if (under <= kRoundoff * size && std::abs(over) <= kRoundoff * size) {
        const int sign = side(cap, q);
        if (sign == 0)
            return;
        over = sign * std::max(std::abs(over), 1e-30 * size);
    }
    sum.add(over, under);
}

} // namespace

CapWinding::Offset::Offset(const Point& d, double square)
    : inverse_square(kInverse4Pi / square), inverse(1 / std::sqrt(square)),
      direction{d.x * inverse, d.y * inverse, d.z * inverse} {}

CapWinding::CapWinding(std::vector<Cap> caps) : caps_(std::move(caps)) {
    if (caps_.empty())
        return;
    build(0, uint32_t(caps_.size()));
    find_vertices();
    pair_edges();
}

void CapWinding::find_vertices() {
    std::vector<uint32_t> order(3 * caps_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto at = [this](uint32_t corner) -> const Point& { return caps_[corner / 3][corner % 3]; };
    WorkCounter& work = WorkCounter::current();
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        work.count(1);
        const Point &p = at(a), &q = at(b);
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    corners_.resize(order.size());
    for (const uint32_t corner : order) {
        if (vertices_.empty() || !(vertices_.back() == at(corner)))
            vertices_.push_back(at(corner));
        corners_[corner] = uint32_t(vertices_.size() - 1);
    }
}

void CapWinding::pair_edges() {
    struct Edge {
        uint32_t low, high;
        uint32_t number; // 3 * cap + corner
        bool forward;
    };
    std::vector<Edge> edges;
    edges.reserve(corners_.size());
    for (uint32_t number = 0; number < corners_.size(); ++number) {
        const uint32_t a = corners_[number], b = corners_[number % 3 == 2 ? number - 2 : number + 1];
        edges.push_back({std::min(a, b), std::max(a, b), number, a < b});
    }
    WorkCounter& work = WorkCounter::current();
    std::sort(edges.begin(), edges.end(), [&work](const Edge& a, const Edge& b) {
        work.count(1);
        return std::tie(a.low, a.high, a.number) < std::tie(b.low, b.high, b.number);
    });
    across_.assign(edges.size(), kNoCap);
    std::vector<uint32_t> open; // edges of one direction that have no partner yet
    bool forward = false;
    for (size_t i = 0; i < edges.size(); ++i) {
        const Edge& edge = edges[i];
        if (i > 0 && (edge.low != edges[i - 1].low || edge.high != edges[i - 1].high))
            open.clear();
        if (open.empty() || forward == edge.forward) {
            forward = edge.forward;
            open.push_back(edge.number);
            continue;
        }
        across_[open.back()] = edge.number / 3;
        across_[edge.number] = open.back() / 3;
        open.pop_back();
    }
}

int32_t CapWinding::build(uint32_t first, uint32_t last) {
    count_work(10 * (last - first));
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

double CapWinding::dipole_angle(const Node& node, const Offset& from) {
    const Point& u = from.direction;
    const double* m = node.moment;
    const double quadrupole = m[0] * u.x * u.x + m[1] * u.y * u.y + m[2] * u.z * u.z +
                              2 * (m[3] * u.x * u.y + m[4] * u.y * u.z + m[5] * u.z * u.x);
    return from.inverse_square * (dot(node.dipole, u) + from.inverse * (m[0] + m[1] + m[2] - 3 * quadrupole));
}

void CapWinding::add_dipole(const Node& node, const Offset& from, LinearExpansion& sum) {
    const double slope = from.inverse_square * from.inverse;
    sum.angle += dipole_angle(node, from);
    sum.gradient =
        plus(plus(sum.gradient, -slope, node.dipole), 3 * slope * dot(node.dipole, from.direction), from.direction);
}

bool CapWinding::split(const Seen& outer, const Point& centre, double radius, double far_error, double smallest,
                       size_t most, Seen& seen) const {
    seen.centre = centre;
    seen.far = outer.far;
    seen.far.angle += dot(outer.far.gradient, minus(centre, outer.centre));
    seen.near.clear();
    int32_t stack[64];
    uint32_t visited = 0;
    for (const uint32_t root : outer.near) {
        int depth = 0;
        stack[depth++] = int32_t(root);
        while (depth > 0) {
            ++visited;
            const int32_t number = stack[--depth];
            const Node& node = nodes_[number];
            const Point d = minus(node.centre, centre);
            const double square = dot(d, d), spread = node.radius + radius, weight = kInverse4Pi * node.area / square;
            // The bound's first term refuses most nodes.
            const double ends = spread * spread / square;
            if (ends < kFarthestEnd * kFarthestEnd && 3 * ends * weight <= far_error) {
                const double error = weight * dipole_error(std::sqrt(ends));
                if (error <= far_error) {
                    add_dipole(node, Offset(d, square), seen.far);
                    seen.far.error_bound += error;
                    continue;
                }
            }
            if (node.left >= 0 && !(node.radius < smallest)) {
                stack[depth++] = node.left;
                stack[depth++] = node.right;
            } else {
                if (seen.near.size() == most)
                    return false;
                seen.near.push_back(uint32_t(number));
            }
        }
    }
    count_work(2 * visited);
    return true;
}

double CapWinding::at(const Point& q, double tolerance) const {
    double total = 0;
    AngleSum near;
    int32_t stack[64];
    int depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    const double share = nodes_.empty() ? 0 : tolerance / (kInverse4Pi * nodes_[0].area);
    uint32_t visited = 0;
    while (depth > 0) {
        ++visited;
        const Node& node = nodes_[stack[--depth]];
        const Point d = minus(node.centre, q);
        const double square = dot(d, d), t = node.radius / std::sqrt(square);
        if (t < kFarthestEnd && dipole_error(t) <= share * square) {
            total += dipole_angle(node, Offset(d, square));
        } else if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
        } else {
            add_solid_angle(near, caps_[node.first], q);
        }
    }
    count_work(2 * visited);
    return total + near.over_4_pi();
}

} // namespace voxrt::voxelize
