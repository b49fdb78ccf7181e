// Where vertices, edges and triangles touch: exactly, but for is_near().
#pragma once

#include "../faces/exact_predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace voxrt::voxelize {

/// Lattice units, more than rounding moves the middle of a triangle.
inline constexpr int kNear = 2;

/// Seen from above, on which side of uv q lies. A q on the line is moved by an infinitesimal along x, then y
/// (simulation of simplicity: Edelsbrunner and Muecke, 1990).
inline int side_of(const Vertex& u, const Vertex& v, const Vertex& q) {
    const int128 vx = int128(v.x) - u.x, vy = int128(v.y) - u.y;
    const int128 area = vx * (int128(q.y) - u.y) - vy * (int128(q.x) - u.x);
    return area != 0 ? sign_of(area) : vy != 0 ? -sign_of(vy) : sign_of(vx);
}

using Triangle = std::array<Vertex, 3>;

/// On which sides of a triangle's plane there is something; its normal points upwards.
struct Sides {
    bool above = false, below = false;

    void add(int side) {
        above = above || side > 0;
        below = below || side < 0;
    }
    void add(const Sides& other) {
        above = above || other.above;
        below = below || other.below;
    }
};

/// A line from beside a triangle's plane to that plane or beyond.
using Line = std::pair<Vertex, Vertex>;

/// Whether for each edge of t some line meets t's plane on the inner side of that edge.
inline bool reach_each_edge(const Triangle& t, const std::vector<Line>& lines) {
    for (int i = 0; i < 3; ++i)
        if (std::none_of(lines.begin(), lines.end(), [&](const Line& line) {
                const auto& [p, q] = line;
                const int side = sign_of(volume6_of(t[0], t[1], t[2], p));
                return sign_of(volume6_of(p, q, t[i], t[(i + 1) % 3])) * side < 0;
            }))
            return false;
    return true;
}

/// Whether two triangles in one plane have a part in common that has an area.
inline bool overlap_in_plane(const Triangle& t, const Triangle& other) {
    for (int32_t Vertex::* const axis : {&Vertex::x, &Vertex::y, &Vertex::z}) {
        Vertex apex = t[0];
        apex.*axis += 1;
        if (volume6_of(t[0], t[1], t[2], apex) != 0)
            return reach_each_edge(t, {{apex, other[0]}, {apex, other[1]}, {apex, other[2]}}) &&
                   reach_each_edge(other, {{apex, t[0]}, {apex, t[1]}, {apex, t[2]}});
    }
    return false; // t has no area
}

/// On which sides of triangle t the other one lies, if it meets t's interior: without t's edges. Both where it lies
/// along t.
///
/// Two convex sets in a plane are apart where a line along a side of one of them parts them. Here these are t and the
/// other triangle's part in t's plane: a point or a line, which lies in the other's plane, too.
inline Sides sides_of_contact(const Triangle& t, const Triangle& other) {
    Sides sides, across; // of t's plane, and of the other's
    std::array<int, 3> side;
    for (int i = 0; i < 3; ++i) {
        side[i] = -sign_of(volume6_of(t[0], t[1], t[2], other[i]));
        sides.add(side[i]);
        across.add(sign_of(volume6_of(other[0], other[1], other[2], t[i])));
    }
    if (!(sides.above || sides.below)) {
        const bool along = overlap_in_plane(t, other);
        return {along, along};
    }
    if (!(across.above && across.below))
        return {};
    std::vector<Line> lines; // along edges that end in t's plane, or pass through it
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
            if (side[j] != 0 && side[j] * side[k] <= 0)
                lines.push_back({other[j], other[k]});
    return reach_each_edge(t, lines) ? sides : Sides{};
}

/// Whether q, in the plane of triangle abc and in its box, lies on it.
inline bool is_on(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& q) {
    for (const auto& [i, j] : {std::pair{&Vertex::x, &Vertex::y}, {&Vertex::y, &Vertex::z}, {&Vertex::z, &Vertex::x}}) {
        auto side = [&, i = i, j = j](const Vertex& u, const Vertex& v) {
            return sign_of((int128(v.*i) - u.*i) * (int128(q.*j) - u.*j) -
                           (int128(v.*j) - u.*j) * (int128(q.*i) - u.*i));
        };
        const int u = side(a, b), v = side(b, c), w = side(c, a);
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
            return false;
    }
    return true;
}

/// Whether q is at most kNear from triangle abc.
inline bool is_near(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& q) {
    using Arrow = std::array<double, 3>;
    const auto arrow = [](const Vertex& u, const Vertex& v) {
        return Arrow{double(v.x) - u.x, double(v.y) - u.y, double(v.z) - u.z};
    };
    const auto cross = [](const Arrow& u, const Arrow& v) {
        return Arrow{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    const auto dot = [](const Arrow& u, const Arrow& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
    const Arrow normal = cross(arrow(a, b), arrow(a, c));
    const double room = kNear * std::sqrt(dot(normal, normal));
    if (std::abs(dot(normal, arrow(a, q))) > room)
        return false;
    for (const auto& [u, v] : {std::pair{&a, &b}, {&b, &c}, {&c, &a}}) {
        const Arrow edge = arrow(*u, *v);
        if (dot(normal, cross(edge, arrow(*u, q))) < -room * std::sqrt(dot(edge, edge)))
            return false;
    }
    return true;
}

} // namespace voxrt::voxelize
