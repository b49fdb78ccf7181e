#include "mesh_analysis.h"

#include "../faces/closed_surface.h"
#include "../faces/manifold.h"
#include "../work/interrupt.h"
#include "edge_cuts.h"

#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace voxrt::voxelize {
namespace {

/// Points in a lattice of their own, so fine that those of a float32 file stay apart.
std::vector<Vertex> in_lattice(const std::vector<Point>& points, const Point& low, const Point& high) {
    const double scale = double(kCoordinateLimit) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
    std::vector<Vertex> vertices;
    vertices.reserve(points.size());
    auto whole = [scale](double v, double from) {
        const double at = std::nearbyint((v - from) * scale);
        return at > 0 ? int32_t(std::min(at, double(kCoordinateLimit))) : 0; // what is no number is refused later
    };
    for (const Point& p : points)
        vertices.push_back({whole(p.x, low.x), whole(p.y, low.y), whole(p.z, low.z)});
    return vertices;
}

Bounds instance_bounds(const SharedMesh& shared, const PartView& part) {
    Bounds bounds;
    for (int i = 0; i < 3; ++i) {
        const double* row = part.frame + 4 * i;
        double low = row[3], high = row[3];
        const double from[3] = {shared.low.x, shared.low.y, shared.low.z};
        const double to[3] = {shared.high.x, shared.high.y, shared.high.z};
        for (int j = 0; j < 3; ++j) {
            low += std::min(row[j] * from[j], row[j] * to[j]);
            high += std::max(row[j] * from[j], row[j] * to[j]);
        }
        bounds.min[i] = int64_t{snap(low, part.object)} - 1;
        bounds.max[i] = int64_t{snap(high, part.object)} + 1;
    }
    return bounds;
}

double determinant(const double* f) {
    return f[0] * (f[5] * f[10] - f[6] * f[9]) - f[1] * (f[4] * f[10] - f[6] * f[8]) +
           f[2] * (f[4] * f[9] - f[5] * f[8]);
}

std::vector<Point> points_of(const std::vector<Vertex>& vertices) {
    std::vector<Point> points(vertices.size());
    for (size_t v = 0; v < points.size(); ++v)
        points[v] = in_voxels(vertices[v]);
    return points;
}

/// What the faces of a mesh enclose.
struct Enclosed {
    bool closed;
    double volume6; // six times the signed volume
    std::shared_ptr<const HoleCaps> hole_caps;
    std::shared_ptr<const Orientation> orientation;
};

/// Six times the signed volume of what counts, as it counts.
double volume6_of(const MeshView& mesh, const std::vector<Point>& points, const Orientation& orientation) {
    double sum = 0;
    const Point& origin = points[mesh.triangles[0]];
    for (size_t t = 0; t < mesh.triangle_count(); ++t)
        if (!orientation.is_uncounted(t)) {
            const double own = volume6(points[mesh.triangles[3 * t]], points[mesh.triangles[3 * t + 1]],
                                       points[mesh.triangles[3 * t + 2]], origin);
            sum += orientation.is_reversed(t) ? -own : own;
        }
    return sum;
}

/// Whether the faces that count close, as they count.
bool closes(const MeshEdges& edges, const Orientation& orientation) {
    bool closed = true;
    edges.each([&](uint32_t, std::span<const EdgeUse> uses) {
        int sum = 0;
        for (const EdgeUse& use : uses)
            sum += counted_upwards(&orientation, use);
        closed = closed && sum == 0;
    });
    return closed;
}

/// How far rounding of the file may move a vertex away from an edge, as a part of the size of the mesh. Far from the
/// origin, coordinates in float32 are coarser.
double rounding_of(const MeshView& mesh) {
    constexpr double kFloat = 1.0 / (1 << 23);
    std::array<double, 3> low, high;
    low.fill(INFINITY);
    high.fill(-INFINITY);
    bool is_float = true;
    for (const int32_t v : mesh.triangles)
        for (size_t axis = 0; axis < 3; ++axis) {
            const double at = mesh.positions[3 * size_t(v) + axis];
            low[axis] = std::min(low[axis], at);
            high[axis] = std::max(high[axis], at);
            is_float = is_float && double(float(at)) == at;
        }
    double size = 0, farthest = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
        size = std::max(size, high[axis] - low[axis]);
        farthest = std::max({farthest, -low[axis], high[axis]});
    }
    // Both the vertex and the ends of the edge were rounded.
    return kFloat * (is_float && size > 0 ? std::max(1.0, 2 * farthest / size) : 1.0);
}

/// `keys`: of the vertices; equal ones are welded. `box`: the volume of their box. `vertices`: in a lattice. `points`
/// gives them to measure.
Enclosed find_enclosed(const MeshView& mesh, const TriangleSums& sums, double box, const std::vector<uint64_t>& keys,
                       const std::vector<Vertex>& vertices, const std::function<std::vector<Point>()>& points,
                       Fill fill) {
    Enclosed found{sums.boundary == 0, sums.volume6, nullptr, nullptr};
    std::optional<MeshEdges> edges, cut;
    std::optional<Bodies> bodies;
    std::vector<EdgeCut> cuts;
    const auto orient = [&](bool flat) {
        edges.emplace(mesh, weld(keys));
        cuts = find_cuts(*edges, vertices, rounding_of(mesh));
        if (!cuts.empty())
            cut.emplace(*edges, cuts);
        bodies.emplace(*edges, cut ? *cut : *edges);
        found.orientation = find_orientation(*edges, cut ? *cut : *edges, *bodies, vertices, flat);
        if (found.orientation || !found.closed)
            bodies->note_closed(cut ? *cut : *edges,
                                [&](const EdgeUse& use) { return counted_upwards(found.orientation.get(), use); });
        if (found.orientation) {
            found.closed = closes(*edges, *found.orientation);
            found.volume6 = volume6_of(mesh, points(), *found.orientation);
        }
    };
    // Closes holes and flips components; returns whether some component has no volume.
    const auto close_and_flip = [&] {
        if (!found.closed && !fills(fill))
            return false;
        const auto cap_holes = [&] {
            found.hole_caps = std::make_shared<const HoleCaps>(
                find_hole_caps(*edges, cuts, *bodies, found.orientation.get(), points(), fill));
        };
        if (!found.closed)
            cap_holes();
        FlippedComponents flipped = flip_components(mesh, vertices, found.orientation, found.hole_caps.get(),
                                                    cut     ? &*cut
                                                    : edges ? &*edges
                                                            : nullptr,
                                                    bodies ? &*bodies : nullptr);
        const bool are_flipped = flipped.orientation != found.orientation;
        found.orientation = std::move(flipped.orientation);
        if (are_flipped && found.hole_caps && found.hole_caps->are_seams())
            cap_holes();
        return flipped.has_flat;
    };
    const bool flat = found.closed && std::abs(sums.volume6) < 1e-6 * box;
    // Where it is not filled, an open surface decides nothing but the layers of faces between voxels.
    if (found.closed ? flat || !is_manifold(mesh, keys) : fills(fill) || sums.odd_edges == 0)
        orient(flat);
    if (close_and_flip() && !edges) {
        orient(true);
        close_and_flip();
    }
    return found;
}

} // namespace

TriangleSums sum_triangles(const MeshView& mesh, const std::vector<Vertex>& vertices, size_t from, size_t to) {
    TriangleSums sums;
    const Vertex& origin = vertices[mesh.triangles[0]];
    count_work(5 * uint32_t(to - from));
    for (size_t t = from; t < to; ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
        const uint64_t keys[3] = {vertex_key(a), vertex_key(b), vertex_key(c)};
        sums.boundary += boundary_key(keys[0], keys[1], keys[2]);
        sums.odd_edges ^= undirected_key(keys[0], keys[1], keys[2]);
        sums.volume6 += volume6(a, b, c, origin);
        for (const Vertex* v : {&a, &b, &c})
            sums.bounds.add(*v);
    }
    return sums;
}

SharedMesh analyze_shared(const MeshView& mesh, uint32_t object, Fill fill) {
    SharedMesh shared;
    std::vector<Point> points(mesh.vertex_count());
    std::vector<uint64_t> keys(points.size());
    for (size_t v = 0; v < points.size(); ++v) {
        // Adding zero makes the two zeros one.
        points[v] = {mesh.positions[3 * v] + 0.0, mesh.positions[3 * v + 1] + 0.0, mesh.positions[3 * v + 2] + 0.0};
        if (!std::isfinite(points[v].x) || !std::isfinite(points[v].y) || !std::isfinite(points[v].z))
            throw OutOfRange(object);
        keys[v] = point_key(points[v].x, points[v].y, points[v].z);
    }
    shared.low = shared.high = points[mesh.triangles[0]];
    const Point& o = points[mesh.triangles[0]];
    TriangleSums sums;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        count_work(5);
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        sums.boundary += boundary_key(keys[corner[0]], keys[corner[1]], keys[corner[2]]);
        sums.odd_edges ^= undirected_key(keys[corner[0]], keys[corner[1]], keys[corner[2]]);
        sums.volume6 += volume6(points[corner[0]], points[corner[1]], points[corner[2]], o);
        for (int i = 0; i < 3; ++i) {
            const Point& p = points[corner[i]];
            shared.low = {std::min(shared.low.x, p.x), std::min(shared.low.y, p.y), std::min(shared.low.z, p.z)};
            shared.high = {std::max(shared.high.x, p.x), std::max(shared.high.y, p.y), std::max(shared.high.z, p.z)};
        }
    }
    const double box = (shared.high.x - shared.low.x) * (shared.high.y - shared.low.y) * (shared.high.z - shared.low.z);
    const Enclosed found =
        find_enclosed(mesh, sums, box, keys, in_lattice(points, shared.low, shared.high), [&] { return points; }, fill);
    shared.closed = found.closed;
    shared.volume6 = found.volume6;
    shared.hole_caps = found.hole_caps;
    shared.orientation = found.orientation;
    return shared;
}

TriangleSums instance_sums(const SharedMesh& shared, const PartView& part) {
    TriangleSums sums;
    sums.bounds = instance_bounds(shared, part);
    sums.boundary = shared.closed ? 0 : 1;
    sums.volume6 = shared.volume6 * determinant(part.frame);
    return sums;
}

void analyze_part(MeshAnalysis& analysis, const PartView& part, const TriangleSums& sums, const SharedMesh* shared,
                  Fill fill) {
    Enclosed found;
    if (shared != nullptr) {
        found = {shared->closed, sums.volume6, shared->hole_caps, shared->orientation};
    } else {
        std::vector<uint64_t> keys(analysis.vertices.size());
        for (size_t v = 0; v < keys.size(); ++v)
            keys[v] = vertex_key(analysis.vertices[v]);
        double box = 1;
        for (int i = 0; i < 3; ++i)
            box *= double(sums.bounds.max[i] - sums.bounds.min[i]);
        found = find_enclosed(
            *part.mesh, sums, box, keys, analysis.vertices, [&] { return points_of(analysis.vertices); }, fill);
    }
    analysis.closed = found.closed;
    // What closes but for the seams of T-junctions has a volume as well.
    const bool is_tight = found.hole_caps && found.hole_caps->are_seams();
    analysis.inverted = (found.closed || is_tight) && found.volume6 < 0;
    if ((found.closed || is_tight) && found.orientation && found.orientation->components > 0)
        analysis.inverted = shared != nullptr && determinant(part.frame) < 0;
    analysis.hole_caps = found.hole_caps;
    analysis.orientation = found.orientation;
    for (int i = 0; i < 3; ++i) {
        analysis.box.low[i] = voxel_floor(sums.bounds.min[i]);
        analysis.box.high[i] = voxel_below(sums.bounds.max[i]);
    }
}

} // namespace voxrt::voxelize
