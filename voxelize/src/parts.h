// The parts of a scene as the voxelizer takes them: one mesh instance or one analytic solid each, in grid space.
#pragma once

#include "fixed_point.h"

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt {

/// The rasters of a mesh's triangles (see tint.h), borrowed; all spans are empty where none has one.
struct Tints {
    std::span<const int32_t> sizes;     // columns and rows of each triangle's, 0 and 0 where it has one material
    std::span<const float> corners;     // 6 a triangle: its corners' places in the raster
    std::span<const uint8_t> materials; // of the cells, raster by raster, row by row; 0 where cut away
    std::span<const int64_t> starts;    // 1 a triangle: its first cell
    bool covers(size_t triangle) const { return !sizes.empty() && sizes[2 * triangle] != 0; }
};

/// Triangles in their object's frame, borrowed; instances share one.
struct MeshView {
    std::span<const double> positions;  // 3 a vertex
    std::span<const int32_t> triangles; // 3 a triangle, in range
    std::span<const uint8_t> materials; // 1 a triangle, or empty
    Tints tints = {};                   // of the triangles whose materials vary
    size_t vertex_count() const { return positions.size() / 3; }
    size_t triangle_count() const { return triangles.size() / 3; }
};

enum class PartKind : uint8_t { mesh = 0, box = 1, ball = 2, ellipsoid = 3 };

struct PartView {
    PartKind kind;
    const MeshView* mesh; // null but for kind mesh
    /// mesh, ellipsoid: rows of the affine map (3x4) to grid space. box: minimum, maximum. ball: centre, radius.
    const double* frame;
    uint8_t material; // of the whole part; 0: each triangle's own
    uint32_t object;  // ascending
};

/// A part reaches so far out of the grid that fixed point cannot hold it, or is not a number.
struct OutOfReach : std::runtime_error {
    explicit OutOfReach(uint32_t object) : std::runtime_error("out of reach"), object(object) {}
    uint32_t object;
};

/// Rounds a coordinate in 1/4096 voxel, half to even.
inline int32_t snap(double value, uint32_t object) {
    const double rounded = std::nearbyint(value);
    if (!(std::abs(rounded) <= double(kReach)))
        throw OutOfReach(object);
    return static_cast<int32_t>(rounded);
}

inline Vertex snap_vertex(const PartView& part, size_t vertex) {
    const double* p = part.mesh->positions.data() + 3 * vertex;
    const double* f = part.frame;
    return {snap(f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3], part.object),
            snap(f[4] * p[0] + f[5] * p[1] + f[6] * p[2] + f[7], part.object),
            snap(f[8] * p[0] + f[9] * p[1] + f[10] * p[2] + f[11], part.object)};
}

} // namespace voxrt
