#include "hole_winding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxrt {
namespace {

constexpr size_t kMostCaps = 1 << 18;
constexpr uint32_t kLeafCaps = 4;
constexpr double kFar = 2; // radii at which a node is a dipole, as Barill et al. chose

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

/// Cuts caps at their longest edges' middles until the edges are short.
std::vector<HoleWinding::Cap> cut(std::vector<HoleWinding::Cap> caps, double longest_edge) {
    for (size_t i = 0; i < caps.size() && caps.size() < kMostCaps;) {
        auto& [a, b, c] = caps[i].corners;
        const double lengths[3] = {length(minus(b, a)), length(minus(c, b)), length(minus(a, c))};
        const int longest = int(std::max_element(lengths, lengths + 3) - lengths);
        if (!(lengths[longest] > longest_edge)) {
            ++i;
            continue;
        }
        HoleWinding::Cap half = caps[i];
        const int next = (longest + 1) % 3;
        const Point m = middle(half.corners[longest], half.corners[next]);
        half.corners[longest] = m;
        caps[i].corners[next] = m;
        caps.push_back(half);
    }
    return caps;
}

} // namespace

HoleRim::HoleRim(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
    if (!pieces_.empty())
        build(0, uint32_t(pieces_.size()));
}

int32_t HoleRim::build(uint32_t first, uint32_t last) {
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    Node node;
    for (uint32_t i = first; i < last; ++i) {
        const Point& at = pieces_[i].middle;
        low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
        node.length += pieces_[i].length;
    }
    node.middle = middle(low, high);
    for (uint32_t i = first; i < last; ++i)
        node.radius = std::max(node.radius, length(minus(pieces_[i].middle, node.middle)) + pieces_[i].radius);
    const auto index = int32_t(nodes_.size());
    nodes_.push_back(node);
    if (last - first > 1) {
        const double sides[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
        const auto axis = std::max_element(sides, sides + 3) - sides;
        const uint32_t half = first + (last - first) / 2;
        std::nth_element(pieces_.begin() + first, pieces_.begin() + half, pieces_.begin() + last,
                         [axis](const Piece& a, const Piece& b) {
                             const Point &p = a.middle, &q = b.middle;
                             return axis == 0 ? p.x < q.x : axis == 1 ? p.y < q.y : p.z < q.z;
                         });
        const int32_t left = build(first, half), right = build(half, last);
        nodes_[index].left = left;
        nodes_[index].right = right;
    }
    return index;
}

double HoleRim::steepness(const Point& q, double reach) const {
    double total = 0;
    int32_t stack[64];
    int depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        const double nearest = length(minus(node.middle, q)) - node.radius - reach;
        if (node.left < 0 && nearest <= 0)
            return std::numeric_limits<double>::infinity();
        if (node.left < 0 || nearest > node.radius) {
            total += node.length / (nearest * nearest);
        } else {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
        }
    }
    return total;
}

HoleWinding::HoleWinding(std::vector<Cap> caps, double longest_edge) {
    std::vector<HoleRim::Piece> pieces;
    for (const Cap& cap : caps) {
        const Point along = minus(cap.corners[1], cap.corners[0]);
        const double whole = length(along);
        const double parts = std::clamp(std::ceil(whole / longest_edge), 1.0, 4096.0);
        for (double i = 0.5; i < parts; ++i)
            pieces.push_back({{cap.corners[0].x + along.x * i / parts, cap.corners[0].y + along.y * i / parts,
                               cap.corners[0].z + along.z * i / parts},
                              std::abs(cap.times) * whole / parts,
                              whole / parts / 2});
    }
    rim_ = HoleRim(std::move(pieces));
    caps_ = cut(std::move(caps), longest_edge);
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
    return (total + 2 * near.radians()) / (4 * std::numbers::pi);
}

/// Whether a cap may come within `reach` of q.
bool HoleWinding::near_cap(const Point& q, double reach) const {
    int32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (length(minus(node.centre, q)) > node.radius + reach)
            continue;
        if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
            continue;
        }
        for (uint32_t i = node.first; i < node.last; ++i) {
            const auto& [a, b, c] = caps_[i].corners;
            const Point n = cross(minus(b, a), minus(c, a)), at = centre(caps_[i]);
            const double radius = std::max({length(minus(a, at)), length(minus(b, at)), length(minus(c, at))});
            if (length(minus(at, q)) <= radius + reach && std::abs(dot(n, minus(q, a))) <= reach * length(n))
                return true;
        }
    }
    return false;
}

int HoleWinding::settled(const Point& q, double reach) const {
    if (nodes_.empty())
        return 0;
    const double change = rim_.steepness(q, reach) * reach / (4 * std::numbers::pi) + 0.05; // and the dipoles' error
    if (!(change < 0.5) || near_cap(q, reach))
        return kUnsettled;
    const double value = at(q);
    const double nearest = std::floor(value + 0.5);
    return std::abs(value - nearest) + change < 0.5 ? int(nearest) : kUnsettled;
}

} // namespace voxrt
