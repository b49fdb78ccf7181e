// Where vertices, edges and triangles touch: exactly, but for is_near().
#pragma once

#include "../faces/exact_predicates.h"

#include <array>
#include <cmath>
#include <utility>

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

/// Whether edge pq passes through triangle abc, its edges included, from one side of its plane to the other.
inline bool passes(const Vertex& p, const Vertex& q, const Vertex& a, const Vertex& b, const Vertex& c) {
    if (sign_of(volume6_of(a, b, c, p)) * sign_of(volume6_of(a, b, c, q)) >= 0)
        return false;
    const int u = sign_of(volume6_of(p, q, a, b)), v = sign_of(volume6_of(p, q, b, c)),
              w = sign_of(volume6_of(p, q, c, a));
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
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
