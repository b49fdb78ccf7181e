#include "hole_winding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxrt {
namespace {

constexpr uint32_t kLeafCaps = 4;
constexpr double kFar = 4; // radii at which a node is a dipole; Barill et al. chose 2
constexpr double kShortWire =
    8; // radii at which pieces of rim are one short wire; nearer, its error would decide nothing
constexpr double kPerTurn = 1 / (4 * std::numbers::pi);

Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point middle(const Point& a, const Point& b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2}; }
Point centre(const HoleWinding::Cap& cap) {
    const auto& [a, b, c] = cap.corners;
    return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
}

/// Tangents of half solid angles, multiplied as complex numbers: a sum of angles with one arc tangent at the end.
class AngleSum {
public:
    /// Adds the angle of (under, over), or takes it away, `times` times.
    void add(double over, double under, int times) {
        const double size = std::abs(over) + std::abs(under);
        if (size == 0)
            return;
        over /= size;
        under /= size;
        if (times < 0)
            over = -over;
        for (int i = std::abs(times); i > 0; --i) {
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
    }
    double radians() const { return std::atan2(y_, x_) + 2 * std::numbers::pi * turns_; }

private:
    double x_ = 1, y_ = 0;
    int turns_ = 0;
};

/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983: the tangent of half of it is over / under.
void add_solid_angle(AngleSum& sum, const HoleWinding::Cap& cap, const Point& q) {
    const Point a = minus(cap.corners[0], q), b = minus(cap.corners[1], q), c = minus(cap.corners[2], q);
    const double la = length(a), lb = length(b), lc = length(c);
    sum.add(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb, cap.times);
}

} // namespace

HoleRim::HoleRim(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
    if (!pieces_.empty())
        build(0, uint32_t(pieces_.size()));
}

int32_t HoleRim::build(uint32_t first, uint32_t last) {
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    Node node;
    node.piece = first;
    for (uint32_t i = first; i < last; ++i) {
        const auto& [from, to, times] = pieces_[i];
        const Point at = middle(from, to), way = minus(to, from);
        low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
        node.length += std::abs(times) * length(way);
        node.along = {node.along.x + times * way.x, node.along.y + times * way.y, node.along.z + times * way.z};
    }
    node.middle = middle(low, high);
    for (uint32_t i = first; i < last; ++i)
        for (const Point& end : {pieces_[i].from, pieces_[i].to})
            node.radius = std::max(node.radius, length(minus(end, node.middle)));
    const auto index = int32_t(nodes_.size());
    nodes_.push_back(node);
    if (last - first > 1) {
        const double sides[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
        const auto axis = std::max_element(sides, sides + 3) - sides;
        const uint32_t half = first + (last - first) / 2;
        std::nth_element(pieces_.begin() + first, pieces_.begin() + half, pieces_.begin() + last,
                         [axis](const Piece& a, const Piece& b) {
                             const Point p = middle(a.from, a.to), q = middle(b.from, b.to);
                             return axis == 0 ? p.x < q.x : axis == 1 ? p.y < q.y : p.z < q.z;
                         });
        const int32_t left = build(first, half), right = build(half, last);
        nodes_[index].left = left;
        nodes_[index].right = right;
    }
    return index;
}

HoleRim::Slope HoleRim::slope(const Point& q, double reach) const {
    Slope slope;
    auto add = [&slope](const Point& field, double scale) {
        slope.gradient = {slope.gradient.x + scale * field.x, slope.gradient.y + scale * field.y,
                          slope.gradient.z + scale * field.z};
    };
    int32_t stack[64];
    int depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        const Point d = minus(node.middle, q);
        const double distance = length(d), nearest = distance - node.radius - reach;
        // The field of a short wire, along x d / d^3, changes by at most 2 length / d^3 a way.
        if (nearest > kShortWire * node.radius) {
            add(cross(d, node.along), kPerTurn / (distance * distance * distance));
            slope.error += kPerTurn * node.length * reach * (2 * node.radius + reach) / (nearest * nearest * nearest);
        } else if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
        } else {
            const Piece& piece = pieces_[node.piece];
            const Point a = minus(piece.from, q), b = minus(piece.to, q), way = minus(b, a);
            const double square = dot(way, way);
            if (square == 0)
                continue;
            const double t = std::clamp(-dot(a, way) / square, 0.0, 1.0);
            const double gap = length({a.x + t * way.x, a.y + t * way.y, a.z + t * way.z}) - reach;
            if (gap <= 0)
                return {{0, 0, 0}, std::numeric_limits<double>::infinity()};
            const double la = length(a), lb = length(b);
            add(cross(a, b), kPerTurn * piece.times * (la + lb) / (la * lb * (la * lb + dot(a, b))));
            // The change above, summed along the piece or, where that is less, along the whole line.
            slope.error +=
                kPerTurn * std::abs(piece.times) * reach * reach * std::min(std::sqrt(square) / gap, 2.0) / (gap * gap);
        }
    }
    return slope;
}

HoleWinding::HoleWinding(std::vector<Cap> caps) : caps_(std::move(caps)) {
    std::vector<HoleRim::Piece> pieces;
    for (const Cap& cap : caps_)
        pieces.push_back({cap.corners[0], cap.corners[1], cap.times});
    rim_ = HoleRim(std::move(pieces));
    if (!caps_.empty())
        build(0, uint32_t(caps_.size()));
}

int32_t HoleWinding::build(uint32_t first, uint32_t last) {
    Node node;
    node.first = first;
    node.last = last;
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300}, weighted{0, 0, 0};
    for (uint32_t i = first; i < last; ++i) {
        const Cap& cap = caps_[i];
        const Point n = cross(minus(cap.corners[1], cap.corners[0]), minus(cap.corners[2], cap.corners[0]));
        const double area = std::abs(cap.times) * length(n) / 2;
        const Point at = centre(cap);
        node.nx += cap.times * n.x / 2;
        node.ny += cap.times * n.y / 2;
        node.nz += cap.times * n.z / 2;
        node.area += area;
        weighted = {weighted.x + area * at.x, weighted.y + area * at.y, weighted.z + area * at.z};
        low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
    }
    node.centre = node.area > 0 ? Point{weighted.x / node.area, weighted.y / node.area, weighted.z / node.area}
                                : middle(low, high);
    for (uint32_t i = first; i < last; ++i)
        for (const Point& corner : caps_[i].corners)
            node.radius = std::max(node.radius, length(minus(corner, node.centre)));
    const auto index = int32_t(nodes_.size());
    nodes_.push_back(node);
    if (last - first > kLeafCaps) {
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

double HoleWinding::exactly_at(const Point& q) const {
    AngleSum sum;
    for (const Cap& cap : caps_)
        add_solid_angle(sum, cap, q);
    return 2 * sum.radians() * kPerTurn;
}

double HoleWinding::at(const Point& q) const {
    double total = 0;
    AngleSum near;
    int32_t stack[64];
    int depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        const Point d = minus(node.centre, q);
        const double square = dot(d, d);
        if (square > kFar * kFar * node.radius * node.radius) {
            total += (node.nx * d.x + node.ny * d.y + node.nz * d.z) / (square * std::sqrt(square));
        } else if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
        } else {
            for (uint32_t i = node.first; i < node.last; ++i)
                add_solid_angle(near, caps_[i], q);
        }
    }
    return (total + 2 * near.radians()) * kPerTurn;
}

} // namespace voxrt
