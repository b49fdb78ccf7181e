// Which triangles lie near which bricks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

// Triangles in voxels, grid frame: corner k of triangle t stands at corners[9 t + 3 k], its unit normal likewise.
struct Triangles {
    std::size_t count;
    const double* corners;
    const float* normals;
};

// For each brick the triangles, ascending, that may come within a voxel of it: those of brick b stand in `triangles`
// from first[b] up to and without first[b + 1].
struct BrickTriangles {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> triangles;
};

// `codes`: Morton codes of the bricks, ascending, in a world of 2^depth voxels per side. Cost: triangles, and the
// bricks of their surface. Throws std::invalid_argument where there are 2^32 triangles or more.
BrickTriangles brick_triangles(const Triangles& triangles, const std::vector<std::uint64_t>& codes, unsigned depth);

} // namespace voxrt::sim
