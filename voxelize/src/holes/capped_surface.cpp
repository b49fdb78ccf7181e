#include "capped_surface.h"

#include "../work/disjoint_sets.h"
#include "../work/interrupt.h"
#include "boundary_loops.h"
#include "enclosure_probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace voxrt::voxelize {
namespace {

constexpr double kLargeOpening = 0.15;     // the share of a component's area above which a loop opens it
constexpr double kClosedTogether = 0.87;   // open components close one another where so many directions do not lead out
constexpr double kOpeningsTogether = 0.05; // Fill::automatic: the same share for all its loops together
constexpr double kTightTogether = 0.97;    // Fill::automatic: in place of kClosedTogether
constexpr double kEnclosure = 0.75;        // they enclose space where so many directions do not lead out

constexpr double kLeastOpening = 1e-300; // a component that does not close has at least this

/// Area, as a vector along the normal.
Point area(const Point& a, const Point& b, const Point& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    return {(uy * vz - uz * vy) / 2, (uz * vx - ux * vz) / 2, (ux * vy - uy * vx) / 2};
}
double length(const Point& a) { return std::hypot(a.x, a.y, a.z); }

/// For each vertex the first one at the same place.
std::vector<uint32_t> weld(const std::vector<Point>& points) {
    std::vector<uint32_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0u);
    WorkCounter& work = WorkCounter::current();
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        work.count(1);
        const Point &p = points[a], &q = points[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && points[order[i]] == points[order[i - 1]];
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// The boundary edges, sorted by first vertex.
std::vector<BoundaryEdge> boundary_of(const MeshView& mesh, const std::vector<uint32_t>& welded) {
    struct Edge {
        uint32_t low, high;
        int direction;
    };
    std::vector<Edge> edges;
    edges.reserve(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangle_count(); ++t)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = welded[mesh.triangles[3 * t + i]], b = welded[mesh.triangles[3 * t + (i + 1) % 3]];
            if (a != b)
                edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
        }
    WorkCounter& work = WorkCounter::current();
    std::sort(edges.begin(), edges.end(), [&work](const Edge& a, const Edge& b) {
        work.count(1);
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::vector<BoundaryEdge> boundary;
    for (size_t i = 0; i < edges.size();) {
        int sum = 0;
        size_t j = i;
        for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
            sum += edges[j].direction;
        if (sum > 0)
            boundary.push_back({edges[i].low, edges[i].high, sum, (j - i) % 2 == 0});
        else if (sum < 0)
            boundary.push_back({edges[i].high, edges[i].low, -sum, (j - i) % 2 == 0});
        i = j;
    }
    std::sort(boundary.begin(), boundary.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    return boundary;
}

/// A mesh with its boundary loops, by connected component.
class Components {
public:
    Components(const MeshView& mesh, const std::vector<Point>& points, Fill fill)
        : automatic_(fill == Fill::automatic), mesh_(mesh), points_(points), welded_(weld(points)),
          sets_(points.size()), loops_(cut_into_loops(boundary_of(mesh, welded_), points.size())),
          area_(points.size(), 0), opening_(points.size(), 0), openings_(points.size(), 0) {
        for (size_t t = 0; t < mesh.triangle_count(); ++t) {
            const auto [a, b, c] = corners(t);
            count_work(5);
            sets_.merge(a, b);
            sets_.merge(a, c);
        }
        for (size_t t = 0; t < mesh.triangle_count(); ++t) {
            const auto [a, b, c] = corners(t);
            area_[sets_.find(a)] += length(area(points[a], points[b], points[c]));
        }
        for (const auto& [loop, inconsistent] : loops_) {
            Point sum{0, 0, 0};
            for (size_t i = 2; i < loop.size(); ++i) {
                const Point n = area(points[loop[0]], points[loop[i - 1]], points[loop[i]]);
                sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
            }
            const double size = 2 * inconsistent > loop.size() ? 0 : length(sum);
            double& opening = opening_[sets_.find(loop[0])];
            opening = std::max({opening, size, kLeastOpening});
            openings_[sets_.find(loop[0])] += size;
        }
    }

    std::array<uint32_t, 3> corners(size_t t) const {
        const int32_t* corner = mesh_.triangles.data() + 3 * t;
        return {welded_[corner[0]], welded_[corner[1]], welded_[corner[2]]};
    }
    const std::vector<BoundaryLoop>& loops() const { return loops_; }

    /// All loops of the component of a vertex, closed, by its area.
    double openings(uint32_t vertex) {
        const uint32_t component = sets_.find(vertex);
        return openings_[component] / std::max(area_[component], 1e-300);
    }

    /// Whether the component of a vertex has a large opening, or openings that are large together.
    bool is_open(uint32_t vertex) {
        const uint32_t component = sets_.find(vertex);
        return opening_[component] > kLargeOpening * area_[component] ||
               (automatic_ && openings_[component] > kOpeningsTogether * area_[component]);
    }

    /// How well all components that do not close enclose together, in the box of those with large openings.
    EnclosureProbe::Enclosure measure_enclosure() {
        Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            for (uint32_t v : corners(t))
                if (is_open(v)) {
                    const Point& p = points_[v];
                    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
                }
        EnclosureProbe probes(low, high);
        auto add = [&](const std::array<uint32_t, 3>& t) { probes.add(points_[t[0]], points_[t[1]], points_[t[2]]); };
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            if (opening_[sets_.find(corners(t)[0])] > 0)
                add(corners(t));
        std::vector<std::array<uint32_t, 3>> caps;
        for (const auto& loop : loops_)
            close_loop(loop.vertices, caps);
        std::vector<CapWinding::Cap> positions;
        for (const auto& cap : caps) {
            add(cap);
            positions.push_back({points_[cap[0]], points_[cap[1]], points_[cap[2]]});
        }
        return probes.measure(CapWinding(std::move(positions)));
    }

private:
    bool automatic_;
    const MeshView& mesh_;
    const std::vector<Point>& points_;
    std::vector<uint32_t> welded_;
    DisjointSets sets_;
    std::vector<BoundaryLoop> loops_;
    // By component: area of the surface, of its largest loop closed, of all its loops closed.
    std::vector<double> area_, opening_, openings_;
};

} // namespace

HoleCaps find_hole_caps(const MeshView& mesh, const std::vector<Point>& points, Fill fill) {
    Components components(mesh, points, fill);
    HoleCaps found;
    bool any_open = false;
    for (const auto& loop : components.loops())
        any_open = any_open || components.is_open(loop.vertices[0]);
    if (any_open) {
        const EnclosureProbe::Enclosure enclosure = components.measure_enclosure();
        if (enclosure.mean < (fill == Fill::automatic ? kTightTogether : kClosedTogether)) {
            found.has_open_enclosure = enclosure.highest > kEnclosure;
            found.shell_only.resize(mesh.triangle_count());
            for (size_t t = 0; t < mesh.triangle_count(); ++t)
                found.shell_only[t] = components.is_open(components.corners(t)[0]);
        }
    }
    for (const auto& loop : components.loops())
        if (found.shell_only.empty() || !components.is_open(loop.vertices[0])) {
            close_loop(loop.vertices, found.triangles);
            if (!components.is_open(loop.vertices[0])) // else it is closed by others
                found.opening = std::max(found.opening, components.openings(loop.vertices[0]));
        }
    return found;
}

} // namespace voxrt::voxelize
