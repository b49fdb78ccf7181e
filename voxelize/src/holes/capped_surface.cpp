#include "capped_surface.h"

#include "../work/disjoint_sets.h"
#include "../work/interrupt.h"
#include "boundary_loops.h"
#include "enclosure_probe.h"

#include <algorithm>
#include <cmath>

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

/// Whether a face belongs to the surface whose holes are sought.
bool is_sought(const Bodies& bodies, const Orientation* orientation, size_t face) {
    return !bodies.closes(uint32_t(face)) && (orientation == nullptr || !orientation->is_settled(face));
}

/// The boundary edges, sorted by first vertex.
std::vector<BoundaryEdge> boundary_of(const MeshEdges& edges, const Bodies& bodies, const Orientation* orientation) {
    std::vector<BoundaryEdge> boundary;
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        int sum = 0, count = 0;
        for (const EdgeUse& use : uses)
            if (is_sought(bodies, orientation, use.face)) {
                sum += use.is_upwards == (orientation != nullptr && orientation->is_reversed(use.face)) ? -1 : 1;
                ++count;
            }
        if (sum > 0)
            boundary.push_back({low, uses[0].high, sum, count % 2 == 0});
        else if (sum < 0)
            boundary.push_back({uses[0].high, low, -sum, count % 2 == 0});
    });
    std::sort(boundary.begin(), boundary.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    return boundary;
}

/// Closes the seams of bodies that close over cut edges: between an edge and the vertices on it is a crack as narrow as
/// rounding.
void close_seams(const MeshEdges& edges, const std::vector<EdgeCut>& cuts, const Bodies& bodies,
                 const Orientation* orientation, HoleCaps& found) {
    auto cut = cuts.begin();
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        if (cut == cuts.end() || cut->low != low || cut->high != uses[0].high)
            return;
        int sum = 0;
        for (const EdgeUse& use : uses)
            if (bodies.closes(use.face))
                sum += counted_upwards(orientation, use);
        std::vector<uint32_t> loop{cut->low};
        loop.insert(loop.end(), cut->at.begin(), cut->at.end());
        loop.push_back(cut->high);
        if (sum > 0)
            std::reverse(loop.begin(), loop.end());
        for (int i = 0; i < std::abs(sum); ++i)
            close_loop(loop, found.triangles);
        ++cut;
    });
    found.seams = found.triangles.size();
}

/// A mesh with its boundary loops, by connected component.
class Components {
public:
    Components(const MeshEdges& edges, const Bodies& bodies, const Orientation* orientation,
               const std::vector<Point>& points, Fill fill)
        : automatic_(fill == Fill::automatic), edges_(edges), bodies_(bodies), orientation_(orientation),
          points_(points), sets_(points.size()),
          loops_(cut_into_loops(boundary_of(edges, bodies, orientation), points.size())), area_(points.size(), 0),
          opening_(points.size(), 0), openings_(points.size(), 0) {
        each_face([&](const Corners& face) {
            count_work(5);
            sets_.merge(face[0], face[1]);
            sets_.merge(face[0], face[2]);
        });
        each_face([&](const Corners& face) {
            area_[sets_.find(face[0])] += length(area(points[face[0]], points[face[1]], points[face[2]]));
        });
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
        each_face([&](const Corners& face) {
            for (const uint32_t v : face)
                if (is_open(v)) {
                    const Point& p = points_[v];
                    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
                }
        });
        EnclosureProbe probes(low, high);
        auto add = [&](const Corners& t) { probes.add(points_[t[0]], points_[t[1]], points_[t[2]]); };
        each_face([&](const Corners& face) {
            if (opening_[sets_.find(face[0])] > 0)
                add(face);
        });
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
    /// Calls visit(corners) for each face of the surface whose holes are sought.
    template <class Visit> void each_face(Visit&& visit) const {
        for (size_t t = 0; t < edges_.face_count(); ++t)
            if (is_sought(bodies_, orientation_, t))
                visit(edges_.corners(t));
    }

    bool automatic_;
    const MeshEdges& edges_;
    const Bodies& bodies_;
    const Orientation* orientation_;
    const std::vector<Point>& points_;
    DisjointSets sets_;
    std::vector<BoundaryLoop> loops_;
    // By component: area of the surface, of its largest loop closed, of all its loops closed.
    std::vector<double> area_, opening_, openings_;
};

} // namespace

HoleCaps find_hole_caps(const MeshEdges& edges, const std::vector<EdgeCut>& cuts, const Bodies& bodies,
                        const Orientation* orientation, const std::vector<Point>& points, Fill fill) {
    Components components(edges, bodies, orientation, points, fill);
    HoleCaps found;
    close_seams(edges, cuts, bodies, orientation, found);
    bool any_open = false;
    for (const auto& loop : components.loops())
        any_open = any_open || components.is_open(loop.vertices[0]);
    if (any_open) {
        const EnclosureProbe::Enclosure enclosure = components.measure_enclosure();
        if (enclosure.mean < (fill == Fill::automatic ? kTightTogether : kClosedTogether)) {
            found.has_open_enclosure = enclosure.highest > kEnclosure;
            found.shell_only.resize(edges.face_count());
            for (size_t t = 0; t < edges.face_count(); ++t)
                found.shell_only[t] = is_sought(bodies, orientation, t) && components.is_open(edges.corners(t)[0]);
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
