#include "open_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace voxrt {
namespace {

constexpr double kSheetShare = 0.6; // caps larger than this part of the surface: a sheet (a bowl's are one half)
constexpr double kEnclosed = 0.75;  // sheets enclose what sees them with at least this winding number
constexpr int kProbes = 8;          // a side, where sheets are asked
constexpr uint32_t kUnnumbered = 0xFFFF'FFFF;

class Groups {
public:
    explicit Groups(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t of(uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<uint32_t> parent_;
};

double area(const Point& a, const Point& b, const Point& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    return std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
}

/// For each vertex the first one at the same place.
std::vector<uint32_t> weld(const std::vector<Point>& points) {
    std::vector<uint32_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const Point &p = points[a], &q = points[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && points[order[i]] == points[order[i - 1]];
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

std::vector<Boundary::Edge> boundary_of(const MeshView& mesh, const std::vector<uint32_t>& welded) {
    struct Edge {
        uint32_t low, high;
        int way;
    };
    std::vector<Edge> edges;
    edges.reserve(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangle_count(); ++t)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = welded[mesh.triangles[3 * t + i]], b = welded[mesh.triangles[3 * t + (i + 1) % 3]];
            if (a != b)
                edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    std::vector<Boundary::Edge> boundary;
    for (size_t i = 0; i < edges.size();) {
        int sum = 0;
        size_t j = i;
        for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
            sum += edges[j].way;
        if (sum > 0)
            boundary.push_back({edges[i].low, edges[i].high, sum, 0});
        else if (sum < 0)
            boundary.push_back({edges[i].high, edges[i].low, -sum, 0});
        i = j;
    }
    return boundary;
}

/// The highest winding number, either way, on a lattice over the box of some caps: what is inside of sheets alone.
double highest_winding(const std::vector<HoleWinding::Cap>& caps) {
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const auto& cap : caps)
        for (const Point& p : cap.corners) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    const HoleWinding winding(caps);
    double highest = 0;
    for (int i = 0; i < kProbes * kProbes * kProbes; ++i) {
        const double u = (i % kProbes + 0.5) / kProbes, v = (i / kProbes % kProbes + 0.5) / kProbes;
        const double w = (i / kProbes / kProbes + 0.5) / kProbes;
        highest = std::max(highest, std::abs(winding.at({low.x + u * (high.x - low.x), low.y + v * (high.y - low.y),
                                                         low.z + w * (high.z - low.z)})));
    }
    return highest;
}

} // namespace

Boundary find_boundary(const MeshView& mesh, const std::vector<Point>& points) {
    const std::vector<uint32_t> welded = weld(points);
    std::vector<Boundary::Edge> edges = boundary_of(mesh, welded);

    Groups pieces(points.size()), holes(points.size());
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        pieces.join(welded[mesh.triangles[3 * t]], welded[mesh.triangles[3 * t + 1]]);
        pieces.join(welded[mesh.triangles[3 * t]], welded[mesh.triangles[3 * t + 2]]);
    }
    for (const Boundary::Edge& edge : edges)
        holes.join(edge.from, edge.to);
    std::vector<uint32_t> numbers(points.size(), kUnnumbered);
    Boundary boundary;
    std::vector<Point> means;
    std::vector<double> ends;
    for (Boundary::Edge& edge : edges) {
        uint32_t& number = numbers[holes.of(edge.from)];
        if (number == kUnnumbered) {
            number = boundary.holes++;
            means.push_back({0, 0, 0});
            ends.push_back(0);
        }
        edge.hole = number;
        for (const Point& p : {points[edge.from], points[edge.to]})
            means[number] = {means[number].x + p.x, means[number].y + p.y, means[number].z + p.z};
        ends[number] += 2;
    }
    auto cap_of = [&](const Boundary::Edge& edge) {
        const Point& sum = means[edge.hole];
        const double n = ends[edge.hole];
        return HoleWinding::Cap{{points[edge.to], points[edge.from], {sum.x / n, sum.y / n, sum.z / n}}, edge.times};
    };

    std::vector<double> own(points.size(), 0), capped(points.size(), 0);
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        own[pieces.of(welded[corner[0]])] += area(points[corner[0]], points[corner[1]], points[corner[2]]);
    }
    for (const Boundary::Edge& edge : edges) {
        const HoleWinding::Cap cap = cap_of(edge);
        capped[pieces.of(edge.from)] += edge.times * area(cap.corners[0], cap.corners[1], cap.corners[2]);
    }

    // A sheet's caps show what the sheet itself would, negated.
    auto is_sheet = [&](uint32_t vertex) { return capped[pieces.of(vertex)] > kSheetShare * own[pieces.of(vertex)]; };
    std::vector<HoleWinding::Cap> of_sheets;
    for (const Boundary::Edge& edge : edges)
        if (is_sheet(edge.from))
            of_sheets.push_back(cap_of(edge));
    if (!of_sheets.empty() && highest_winding(of_sheets) < kEnclosed) {
        boundary.sheet.resize(mesh.triangle_count());
        for (size_t t = 0; t < mesh.triangle_count(); ++t)
            boundary.sheet[t] = is_sheet(welded[mesh.triangles[3 * t]]);
        std::erase_if(edges, [&](const Boundary::Edge& edge) { return is_sheet(edge.from); });
    }
    boundary.edges = std::move(edges);
    return boundary;
}

} // namespace voxrt
