// The voxelizer: parts in grid space to sparse voxels.
//
// The grid is cut into tiles of 64 x 64 columns over its whole height. A column's voxels depend on that column's
// triangles alone, so tiles are independent: threads take tiles, need no atomics, and the result does not depend on
// who took which. Steps and what bounds them:
//
//   survey    vertices snapped, closure tested, holes capped                     triangles; memory bandwidth
//   bin       triangles listed by tile                                           triangles; one thread
// then tile by tile
//   coverage  triangles to shell bricks and crossings; boxes and balls           columns under triangles; L2 cache
//   fill      brick columns swept, the inside claimed                            surface bricks; L2 cache
//   holes     the same for open surfaces, their holes looked at                  surface bricks, voxels near holes
//   order     bricks put in Morton order                                         surface bricks; L2 cache
// and at last
//   gather    tiles' bricks laid out one after another                           surface bricks; memory bandwidth
//
// Parts that touch few tiles are not expanded: the tile takes the part as a whole and snaps its vertices again.
#pragma once

#include "parallel.h"
#include "parts.h"
#include "stage_seconds.h"

#include <array>
#include <memory>

namespace voxrt {

/// What `Voxels` in voxels.py holds, and what became of each object.
struct SparseVoxels {
    template <typename T> struct Array {
        std::unique_ptr<T[]> data;
        size_t size = 0;
        void allocate(size_t n) {
            data = std::make_unique_for_overwrite<T[]>(n);
            size = n;
        }
    };
    Array<uint64_t> brick_codes;
    Array<std::array<uint64_t, 8>> brick_masks;
    Array<uint8_t> brick_materials;
    Array<int32_t> brick_rows;
    Array<std::array<uint8_t, 512>> cells;
    Array<uint64_t> octant_codes;
    Array<uint8_t> octant_levels;
    Array<uint8_t> octant_materials;
    Array<int64_t> object_voxels;
    Array<uint8_t> object_modes;  // Mode
    Array<int64_t> object_turned; // connected pieces taken the other way round
    StageSeconds seconds;
};

/// open: what it encloses stands open, like a room without a front, and was not filled. turned: it closes, and some of
/// its pieces were inside out.
enum class Mode : uint8_t { surface = 0, exact = 1, winding = 2, open = 3, turned = 4 };

/// Voxelizes parts (ascending by object) on a grid of 2^depth voxels a side, depth 1 … 16.
///
/// fill: claim what a part encloses, not its shell alone. Throws OutOfReach.
SparseVoxels voxelize(int depth, const std::vector<PartView>& parts, size_t objects, bool fill, Workers& workers);

} // namespace voxrt
