#include "convex_hull.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace voxrt::voxelize {
namespace {

using Face = std::array<int32_t, 3>;

struct Direction {
    int128 x, y, z;
    bool zero() const { return x == 0 && y == 0 && z == 0; }
};

Direction normal(const Vertex& a, const Vertex& b, const Vertex& c) {
    const int128 ux = int64_t{b.x} - a.x, uy = int64_t{b.y} - a.y, uz = int64_t{b.z} - a.z;
    const int128 vx = int64_t{c.x} - a.x, vy = int64_t{c.y} - a.y, vz = int64_t{c.z} - a.z;
    return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

/// Sign of the side of plane (a, n) that p is on.
int side(const Direction& n, const Vertex& a, const Vertex& p) {
    const int128 volume = n.x * (int64_t{p.x} - a.x) + n.y * (int64_t{p.y} - a.y) + n.z * (int64_t{p.z} - a.z);
    return (volume > 0) - (volume < 0);
}

/// The polygon around points that share the plane with normal n, twice: Andrew's monotone chain (1979).
std::vector<Face> flat_hull(const std::vector<Vertex>& points, const std::vector<int32_t>& order, const Direction& n) {
    auto turns_left = [&](int32_t a, int32_t b, int32_t c) {
        const Direction t = normal(points[a], points[b], points[c]);
        return t.x * (n.x > 0   ? 1
                      : n.x < 0 ? -1
                                : 0) +
                   t.y * (n.y > 0   ? 1
                          : n.y < 0 ? -1
                                    : 0) +
                   t.z * (n.z > 0   ? 1
                          : n.z < 0 ? -1
                                    : 0) >
               0;
    };
    std::vector<int32_t> rim;
    auto chain = [&](auto begin, auto end) {
        const size_t base = rim.size();
        for (auto it = begin; it != end; ++it) {
            while (rim.size() >= base + 2 && !turns_left(rim[rim.size() - 2], rim.back(), *it))
                rim.pop_back();
            rim.push_back(*it);
        }
        rim.pop_back();
    };
    chain(order.begin(), order.end());
    chain(order.rbegin(), order.rend());
    std::vector<Face> faces;
    for (size_t i = 2; i < rim.size(); ++i) {
        faces.push_back({rim[0], rim[i - 1], rim[i]});
        faces.push_back({rim[0], rim[i], rim[i - 1]});
    }
    return faces;
}

} // namespace

std::vector<Face> convex_hull(const std::vector<Vertex>& points) {
    std::vector<int32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    auto less = [&](int32_t a, int32_t b) {
        const Vertex &p = points[a], &q = points[b];
        return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
    };
    std::stable_sort(order.begin(), order.end(), less);
    order.erase(std::unique(order.begin(), order.end(), [&](int32_t a, int32_t b) { return points[a] == points[b]; }),
                order.end());
    if (order.size() < 3)
        return {};

    // The first four points that span space.
    const int32_t a = order[0], b = order[1];
    size_t third = 2;
    while (third < order.size() && normal(points[a], points[b], points[order[third]]).zero())
        ++third;
    if (third == order.size())
        return {};
    const int32_t c = order[third];
    const Direction base = normal(points[a], points[b], points[c]);
    size_t fourth = 2;
    while (fourth < order.size() && side(base, points[a], points[order[fourth]]) == 0)
        ++fourth;
    if (fourth == order.size())
        return flat_hull(points, order, base);
    const int32_t d = order[fourth];

    struct Facet {
        Face face;
        Direction normal;
    };
    std::vector<Facet> faces;
    auto add = [&](int32_t u, int32_t v, int32_t w) {
        faces.push_back({{u, v, w}, normal(points[u], points[v], points[w])});
    };
    const bool above = side(base, points[a], points[d]) > 0;
    const int32_t p = above ? c : b, q = above ? b : c; // (a, p, q) looks away from d
    add(a, p, q);
    add(a, q, d);
    add(q, p, d);
    add(p, a, d);

    std::vector<Facet> unseen;
    for (int32_t point : order) {
        unseen.clear();
        std::set<std::pair<int32_t, int32_t>> seen_edges;
        for (const Facet& facet : faces) {
            if (side(facet.normal, points[facet.face[0]], points[point]) <= 0) {
                unseen.push_back(facet);
                continue;
            }
            for (int i = 0; i < 3; ++i)
                seen_edges.insert({facet.face[i], facet.face[(i + 1) % 3]});
        }
        if (seen_edges.empty())
            continue;
        faces.swap(unseen);
        for (const auto& [u, v] : seen_edges)
            if (!seen_edges.contains({v, u}))
                add(u, v, point);
    }
    std::vector<Face> result;
    result.reserve(faces.size());
    for (const Facet& facet : faces)
        result.push_back(facet.face);
    return result;
}

} // namespace voxrt::voxelize
