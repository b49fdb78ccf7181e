// The triangles of a scene with smooth normals, in voxels.
#pragma once

#include "brick_triangles.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::sim {

struct NormalMesh {
    std::span<const double> positions;       // 3 per vertex
    std::span<const std::int32_t> triangles; // 3 vertices per triangle, all in range
    // The author's normals, empty where there are none: 3 per direction, of any length, zero or not finite for none;
    // and the direction of each corner of each triangle, or -1.
    std::span<const double> directions;
    std::span<const std::int32_t> rows;
};

struct PlacedMesh {
    std::size_t mesh;
    std::array<double, 12> transform; // rows of 3x4, to the scene frame
};

struct PlacedTriangles {
    std::vector<double> corners; // 9 per triangle: voxels, grid frame
    std::vector<float> normals;  // the same: unit normals
    Triangles view() const { return {corners.size() / 9, corners.data(), normals.data()}; }
};

// The triangles of all objects, in a grid with this origin and voxel size (metres, scene frame). Normals are the
// author's, turned to the side from which the triangle is counter-clockwise. Where there are none, they are smooth over
// edges with an angle below 45 degrees.
PlacedTriangles place_triangles(const std::vector<NormalMesh>& meshes, const std::vector<PlacedMesh>& objects,
                                const std::array<double, 3>& origin, double voxel_size);

} // namespace voxrt::sim
