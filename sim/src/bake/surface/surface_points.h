// Where the light of each exposed voxel is measured: a voxel before the surface, and the normal there.
#pragma once

#include "brick_triangles.h"
#include "exposed_bricks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::sim {

inline constexpr int kUnitNormal = 1 << 14; // the length of a normal

// Points in the order of their voxels: bricks, then Morton order in the brick.
struct SurfacePoints {
    std::vector<std::uint64_t> voxels; // kBrickVoxels * brick + index in the brick
    std::vector<std::int32_t> origins; // 3 per point: 1/16 voxel, grid frame
    std::vector<std::int16_t> normals; // 3 per point: length kUnitNormal, rounded
};

// A voxel with exposed faces has one point; a second one follows where it is exposed on both sides, as in a sheet that
// is one voxel thick.
//
// The normal is the mean of the normals that the triangles within sqrt(3)/2 voxel of the voxel's centre have at their
// points nearest to it, each weighted by area (at most 1 voxel^2) and by 3/4 - distance^2. Of triangles that face away
// from all exposed faces none counts, unless there are no others: then they are turned. Without triangles the normal
// points from the solid to the empty voxels among the 5 x 5 x 5 around it.
//
// The light is measured in the centre of a voxel before the surface. Let p be the nearest point of these triangles, or
// the voxel's centre without triangles, and h = |n_x| + |n_y| + |n_z|: no voxel that a plane crosses reaches farther
// above it, so that from there on a plane casts no shadow on itself. It is the first voxel along the normal n from p
// whose centre lies at least h above p, or h - 1/2 for a normal along an axis. Where this one is solid, it is the empty
// voxel beyond the exposed face that faces the normal most.
SurfacePoints surface_points(const octree::VerifiedMemory& memory, const ExposedBricks& bricks,
                             const Triangles& triangles, int threads);

// A point beyond each exposed face of some voxels, with the normal of that face. `voxels`: numbers as above.
SurfacePoints face_points(const octree::VerifiedMemory& memory, std::span<const std::uint64_t> brick_codes,
                          std::span<const std::uint64_t> voxels);

} // namespace voxrt::sim
