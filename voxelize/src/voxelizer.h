// The voxelizer: parts in grid space to sparse voxels. This is the entry of the library voxrt::voxelize.
//
// A voxel is solid where the closed solid of an object overlaps the voxel's interior at all; touching is not overlap.
// Where objects compete, the first in authored order keeps the voxel. Coverage of triangles is exact
// (triangle_coverage.h). Inside is where the winding number is not zero, or, for surfaces with holes, where the
// generalized winding number exceeds 1/2 (generalized_inside.h).
//
//     const MeshView mesh{positions, triangles, materials};            // spans, borrowed
//     const double frame[12] = {s, 0, 0, x, 0, s, 0, y, 0, 0, s, z};   // mesh to grid space, in 1/4096 voxel
//     const SparseVoxels voxels = voxelize(8, {{PartKind::mesh, &mesh, frame, 0, 0}}, 1, Fill::solid, 0);
//     const std::vector<octree::Word> words = octree::build(voxels.view(), 0);
//
// The grid is cut into tiles of 64 x 64 columns over its whole height. A column's voxels depend on that column's
// triangles alone, so tiles are independent: threads take tiles, need no atomics, and the result does not depend on
// which thread took which tile. Stages and what bounds them:
//
//   analysis  vertices snapped, closed surfaces recognized, holes capped         triangles; memory bandwidth
//   bin       triangles listed by tile                                           triangles; one thread
// then tile by tile
//   coverage  triangles to shell bricks and crossings; boxes and balls           columns under triangles; L2 cache
//   fill      brick columns swept, the inside claimed                            surface bricks; L2 cache
//   holes     the same for surfaces with holes                                   surface bricks, voxels near holes
//   order     bricks put in Morton order                                         surface bricks; L2 cache
// and at last
//   gather    the bricks of all tiles laid out one after another                 surface bricks; memory bandwidth
//
// A part that touches few tiles is not binned by triangle: its tiles take it whole and snap its vertices themselves.
#pragma once

#include "fill.h"
#include "interrupt.h"
#include "object_mode.h"
#include "parts.h"
#include "sparse_voxels.h"

#include <functional>
#include <vector>

namespace voxrt::voxelize {

/// Voxelizes `parts`, ascending by object, on a grid of 2^depth voxels per side.
///
/// `depth` is 1 … 16, `objects` is above the object of every part. `fill`: fill.h. `threads`: 0 takes as many as the
/// machine has; the result does not depend on it. The arguments are not checked. Throws OutOfRange (parts.h),
/// std::length_error where the tiles would list 2^32 triangles or more, and what the caller's interrupt check throws
/// (interrupt.h).
SparseVoxels voxelize(int depth, const std::vector<PartView>& parts, size_t objects, Fill fill, int threads);

/// Receives the voxels of a block, all that no other block has; its lists of objects are empty.
using TakeBlock = std::function<void(SparseVoxels&&)>;

/// The same block by block: squares of `block_side` columns (a multiple of 64), over the grid's whole height, in Morton
/// order. Only one block's voxels are in memory at a time. `take` is called for blocks with geometry and for the last;
/// octree::Assembly joins their octrees. Returns what became of the objects, without voxels.
SparseVoxels voxelize_in_blocks(int depth, const std::vector<PartView>& parts, size_t objects, Fill fill, int threads,
                                int block_side, const TakeBlock& take);

} // namespace voxrt::voxelize
