#include "open_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voxrt {
namespace {

constexpr double kSheetShare = 0.6; // caps larger than this part of the surface: a sheet (a bowl's are one half)
constexpr double kEnclosed = 0.75;  // sheets enclose what sees them with at least this winding number
constexpr int kProbes = 16;         // a side, where sheets are asked

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

struct BoundaryEdge {
    uint32_t from, to;
    int times; // how much oftener it is walked this way than back
};

Point in_voxels(const Vertex& v) { return {double(v.x) / kUnit, double(v.y) / kUnit, double(v.z) / kUnit}; }

double area(const Vertex& a, const Vertex& b, const Vertex& c) {
    const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
    const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
    return std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
}

/// For each vertex the first one at the same place.
std::vector<uint32_t> weld(const std::vector<Vertex>& vertices) {
    std::vector<uint32_t> order(vertices.size()), first(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const Vertex &p = vertices[a], &q = vertices[b];
        return std::array<int64_t, 4>{p.x, p.y, p.z, a} < std::array<int64_t, 4>{q.x, q.y, q.z, b};
    });
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

std::vector<BoundaryEdge> boundary_of(const MeshView& mesh, const std::vector<uint32_t>& welded) {
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
    std::vector<BoundaryEdge> boundary;
    for (size_t i = 0; i < edges.size();) {
        int sum = 0;
        size_t j = i;
        for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
            sum += edges[j].way;
        if (sum > 0)
            boundary.push_back({edges[i].low, edges[i].high, sum});
        else if (sum < 0)
            boundary.push_back({edges[i].high, edges[i].low, -sum});
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

OpenSurface open_surface(const MeshView& mesh, const std::vector<Vertex>& vertices) {
    const std::vector<uint32_t> welded = weld(vertices);
    const std::vector<BoundaryEdge> boundary = boundary_of(mesh, welded);

    Groups pieces(vertices.size()), holes(vertices.size());
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        pieces.join(welded[mesh.triangles[3 * t]], welded[mesh.triangles[3 * t + 1]]);
        pieces.join(welded[mesh.triangles[3 * t]], welded[mesh.triangles[3 * t + 2]]);
    }
    struct Mean {
        int64_t x = 0, y = 0, z = 0, count = 0;
    };
    for (const BoundaryEdge& edge : boundary)
        holes.join(edge.from, edge.to);
    std::vector<Mean> means(vertices.size());
    for (const BoundaryEdge& edge : boundary)
        for (uint32_t v : {edge.from, edge.to}) {
            Mean& mean = means[holes.of(v)];
            mean.x += vertices[v].x;
            mean.y += vertices[v].y;
            mean.z += vertices[v].z;
            ++mean.count;
        }
    auto apex = [&](uint32_t v) {
        const Mean& m = means[holes.of(v)];
        return Vertex{int32_t(floor_div(m.x, m.count)), int32_t(floor_div(m.y, m.count)),
                      int32_t(floor_div(m.z, m.count))};
    };

    std::vector<double> own(vertices.size(), 0), capped(vertices.size(), 0);
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        own[pieces.of(welded[corner[0]])] += area(vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]);
    }
    for (const BoundaryEdge& edge : boundary)
        capped[pieces.of(edge.from)] += edge.times * area(vertices[edge.to], vertices[edge.from], apex(edge.from));

    // A cap closes its edge: it walks it backwards. Its solid angle is what the sheet itself would show, negated.
    auto is_sheet = [&](uint32_t vertex) { return capped[pieces.of(vertex)] > kSheetShare * own[pieces.of(vertex)]; };
    auto cap_of = [&](const BoundaryEdge& edge) {
        return HoleWinding::Cap{
            {in_voxels(vertices[edge.to]), in_voxels(vertices[edge.from]), in_voxels(apex(edge.from))}, edge.times};
    };
    std::vector<HoleWinding::Cap> all;
    std::vector<HoleWinding::Cap> of_sheets;
    for (const BoundaryEdge& edge : boundary) {
        all.push_back(cap_of(edge));
        if (is_sheet(edge.from))
            of_sheets.push_back(all.back());
    }
    OpenSurface result;
    const bool drop_sheets = !of_sheets.empty() && highest_winding(of_sheets) < kEnclosed;
    if (drop_sheets) {
        result.sheet.resize(mesh.triangle_count());
        for (size_t t = 0; t < mesh.triangle_count(); ++t)
            result.sheet[t] = is_sheet(welded[mesh.triangles[3 * t]]);
        all.clear();
    }
    for (const BoundaryEdge& edge : boundary) {
        if (drop_sheets && is_sheet(edge.from))
            continue;
        for (int i = 0; i < edge.times; ++i)
            result.caps.push_back({vertices[edge.to], vertices[edge.from], apex(edge.from)});
        if (drop_sheets)
            all.push_back(cap_of(edge));
    }
    result.holes = HoleWinding(std::move(all));
    return result;
}

} // namespace voxrt
