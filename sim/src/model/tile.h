// A tile of rays from one camera through the octree, together and exactly.
//
// The rays of a tile whose directions have the same signs meet the octants of a block in the same order, that of the
// mirrored octant index. So the tile walks the octree once, front to back, and carries along which of its rays visit
// the node at hand: no ray has a stack, and a word is read once for all of them (the idea of ranged and packet
// traversal, Wald et al., "Interactive rendering with coherent ray tracing", 2001, on an octree).
//
// The crossing of plane p on axis a has the key 4 T + a (see ray.h for T): all keys of a ray differ. A ray visits a
// node exactly when the largest key of its three near planes, its entry, is below the smallest key of its far planes;
// entries no later than the ray's start count as the start. Keys are whole numbers held in doubles, which is exact as
// long as they stay below 2^53: tile_fits says whether they do.
#pragma once

#include "memory.h"

#include <cstdint>

namespace voxrt::model {

inline constexpr int kTileSide = 16;
inline constexpr int kGroups = kTileSide * kTileSide / 8; // a group is 8 rays, side by side

// Planes that a ray never crosses, those of an axis along which it does not move, get keys of this size: those below
// the ray count as behind it, those above come after all others.
inline constexpr double kNeverKey = 0x1p56;

// Keys up to this one are crossed before the ray starts: 4 T + a with T <= 0.
inline constexpr double kStartKey = 3.5;

// The rays of a tile: plane p of axis a has the key p * scale + offset, in the frame mirrored as `mirror` says.
struct Tile {
    alignas(64) double scale[kGroups][3][8];
    alignas(64) double offset[kGroups][3][8];
    alignas(64) double entry[kGroups][8]; // out: the key of the hit's entry
    uint8_t material[kGroups][8];         // in: 0; out: the material hit, or still 0
    uint8_t mirror[kGroups][8];           // bit a: axis a is mirrored
    uint8_t alive[kGroups];               // in: bit i: trace ray i; out: the rays that hit nothing
};

} // namespace voxrt::model
