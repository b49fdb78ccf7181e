// The parts of a scene as the voxelizer takes them: one mesh instance or one analytic solid each, in grid space.
//
// All views borrow: what they point to must outlive the call that they are handed to. Nothing is checked here.
#pragma once

#include "../grid/fixed_point.h"
#include "../rules/rule.h"
#include "fill.h"

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::voxelize {

/// Rasters of materials for triangles whose material varies (material_raster.h). All spans are empty where no triangle
/// of the mesh has one.
struct MaterialRasters {
    std::span<const int32_t> sizes;     // 2 per triangle: columns and rows; 0 and 0 where it has one material
    std::span<const float> coordinates; // 6 per triangle: (column, row) of its corners in the raster
    std::span<const uint8_t> materials; // of the cells, raster by raster, row by row; 0 where fully transparent
    std::span<const int64_t> starts;    // 1 per triangle: its first cell
    bool has_raster(size_t triangle) const { return !sizes.empty() && sizes[2 * triangle] != 0; }
};

/// Triangles in their object's frame; instances share one.
struct MeshView {
    std::span<const double> positions;  // 3 per vertex
    std::span<const int32_t> triangles; // 3 per triangle: vertices, in range; counter-clockwise seen from outside
    std::span<const uint8_t> materials; // 1 per triangle, never 0; or empty where the part has a material
    MaterialRasters rasters = {};
    size_t vertex_count() const { return positions.size() / 3; }
    size_t triangle_count() const { return triangles.size() / 3; }
};

enum class PartKind : uint8_t { mesh = 0, box = 1, ball = 2, ellipsoid = 3 };

struct PartView {
    PartKind kind = PartKind::mesh;
    const MeshView* mesh = nullptr; // null but for kind mesh
    /// 12 numbers in 1/4096 voxel. mesh, ellipsoid: rows of the affine map (3x4) from the mesh, or from the unit ball,
    /// to grid space. box: minimum and maximum. ball: centre and radius.
    const double* frame = nullptr;
    uint8_t material = 0; // the material of the whole part; 0: each triangle has its own
    uint32_t object = 0;  // ascending from part to part
    Rule rule = Rule::touch;
    Fill fill = Fill::solid; // that of its object
};

/// A part reaches beyond kCoordinateLimit, or has a coordinate that is not a number.
struct OutOfRange : std::runtime_error {
    explicit OutOfRange(uint32_t object)
        : std::runtime_error(
              "object " + std::to_string(object) +
              " reaches beyond 2^18 voxels from the grid's corner, or is not a number; move or scale it"),
          object(object) {}
    uint32_t object;
};

/// Rounds a coordinate in 1/4096 voxel, half to even. Throws OutOfRange.
inline int32_t snap(double value, uint32_t object) {
    const double rounded = std::nearbyint(value);
    if (!(std::abs(rounded) <= double(kCoordinateLimit)))
        throw OutOfRange(object);
    return static_cast<int32_t>(rounded);
}

/// The position of a mesh part's vertex in grid space. Throws OutOfRange.
inline Vertex snap_vertex(const PartView& part, size_t vertex) {
    const double* p = part.mesh->positions.data() + 3 * vertex;
    const double* f = part.frame;
    return {snap(f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3], part.object),
            snap(f[4] * p[0] + f[5] * p[1] + f[6] * p[2] + f[7], part.object),
            snap(f[8] * p[0] + f[9] * p[1] + f[10] * p[2] + f[11], part.object)};
}

} // namespace voxrt::voxelize
