// A tile of rays from one camera through the octree, as a packet and exactly.
//
// Rays whose directions have the same signs meet the octants of a block in the same order, that of the mirrored octant
// index. So the tile traverses the octree once, front to back, with the set of its rays that visit the current node: no
// ray has a stack, and a word is read once for all of them (packet traversal: Wald, Slusallek, Benthin and Wagner,
// "Interactive Rendering with Coherent Ray Tracing", 2001; here on an octree).
//
// The crossing of plane p on axis a has the key 4 T + a (see ray.h for T): all keys of a ray differ. A ray visits a
// node exactly when the largest key of its three near planes, its entry, is below the smallest key of its far planes;
// entries no later than the ray's start count as the start. Keys are whole numbers held in doubles, which is exact as
// long as they stay below 2^53: tile_fits (frame_tile.h) says whether they do.
#pragma once

#include "frame_tile.h"
#include <voxrt/voxelize/vectors/lanes.h>

#include <cstdint>

namespace voxrt::sim {
namespace {

constexpr int kGroups = kTileSide * kTileSide / kLanes; // a group is 8 rays, side by side

// A ray never crosses the planes of an axis along which it does not move. Their keys have this size: those below the
// ray count as behind it, those above come after all others.
constexpr double kNeverKey = 0x1p56;

// Keys below this one are crossed before the ray starts: 4 T + a with T <= 0.
constexpr double kStartKey = 3.5;

// The rays of a tile, and what they hit.
struct Tile {
    // Plane p of axis a has the key p * scale + offset, in the frame mirrored as `mirrored` says.
    Lanes scale[kGroups][3];
    Lanes offset[kGroups][3];
    Mask mirrored[kGroups][3];  // rays that descend along each axis
    Mask alive[kGroups];        // rays still to be traced; after the walk, those that hit nothing
    uint64_t material[kGroups]; // a byte per ray: the material hit; 0 before
    Mask face[kGroups][3];      // rays that hit a face across each axis; none before
    Lanes reach[kGroups];       // lod_reach of each ray, where LOD is on
};

} // namespace
} // namespace voxrt::sim
