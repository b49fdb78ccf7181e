#include "mesh_analysis.h"

#include "../work/interrupt.h"
#include "closed_surface.h"

namespace voxrt::voxelize {
namespace {

/// Points in a lattice of their own, so fine that those of a float32 file stay apart.
std::vector<Vertex> in_lattice(const std::vector<Point>& points, const Point& low, const Point& high) {
    const double scale = double(kCoordinateLimit) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
    std::vector<Vertex> vertices;
    vertices.reserve(points.size());
    auto whole = [scale](double v, double from) {
        return int32_t(std::clamp(std::nearbyint((v - from) * scale), 0.0, double(kCoordinateLimit)));
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

std::shared_ptr<const HoleCaps> caps_of(const MeshView& mesh, const std::vector<Vertex>& vertices, Fill fill) {
    std::vector<Point> points(vertices.size());
    for (size_t v = 0; v < points.size(); ++v)
        points[v] = in_voxels(vertices[v]);
    return std::make_shared<const HoleCaps>(find_hole_caps(mesh, points, fill));
}

} // namespace

TriangleSums sum_triangles(const MeshView& mesh, const std::vector<Vertex>& vertices, size_t from, size_t to) {
    TriangleSums sums;
    const Vertex& origin = vertices[mesh.triangles[0]];
    count_work(5 * uint32_t(to - from));
    for (size_t t = from; t < to; ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
        sums.boundary += boundary_key(vertex_key(a), vertex_key(b), vertex_key(c));
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
    uint64_t boundary = 0;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        count_work(5);
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        boundary += boundary_key(keys[corner[0]], keys[corner[1]], keys[corner[2]]);
        shared.volume6 += volume6(points[corner[0]], points[corner[1]], points[corner[2]], o);
        for (int i = 0; i < 3; ++i) {
            const Point& p = points[corner[i]];
            shared.low = {std::min(shared.low.x, p.x), std::min(shared.low.y, p.y), std::min(shared.low.z, p.z)};
            shared.high = {std::max(shared.high.x, p.x), std::max(shared.high.y, p.y), std::max(shared.high.z, p.z)};
        }
    }
    shared.closed = boundary == 0;
    if (fills(fill) && !shared.closed)
        shared.hole_caps = std::make_shared<const HoleCaps>(find_hole_caps(mesh, points, fill));
    if (shared.closed || fills(fill))
        shared.flipped =
            find_flipped_components(mesh, in_lattice(points, shared.low, shared.high), shared.hole_caps.get());
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
    analysis.closed = sums.boundary == 0;
    analysis.inverted = analysis.closed && sums.volume6 < 0;
    for (int i = 0; i < 3; ++i) {
        analysis.box.low[i] = voxel_floor(sums.bounds.min[i]);
        analysis.box.high[i] = voxel_below(sums.bounds.max[i]);
    }
    if (!analysis.closed && !fills(fill))
        return;
    if (!analysis.closed) {
        analysis.hole_caps = shared != nullptr ? shared->hole_caps : nullptr;
        if (!analysis.hole_caps)
            analysis.hole_caps = caps_of(*part.mesh, analysis.vertices, fill);
    }
    analysis.flipped = shared != nullptr
                           ? shared->flipped
                           : find_flipped_components(*part.mesh, analysis.vertices, analysis.hole_caps.get());
    if (analysis.closed && analysis.flipped)
        analysis.inverted = shared != nullptr && determinant(part.frame) < 0;
}

} // namespace voxrt::voxelize
