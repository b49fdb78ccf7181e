// The voxelizer: parts in grid space to sparse voxels. This is the entry of the library voxrt::voxelize.
//
// A voxel is solid where the closed solid of an object overlaps the voxel's interior at all; touching is not overlap.
// Another rule (rule.h) takes some of these voxels away again (rule_voxels.h).
// Where objects compete, the first in authored order keeps the voxel. Coverage of triangles is exact
// (triangle_coverage.h). Inside is where the winding number is not zero, or, for surfaces with holes, where the
// generalized winding number exceeds 1/2 (generalized_inside.h).
//
//     const MeshView mesh{positions, triangles, materials};            // spans, borrowed
//     const double frame[12] = {s, 0, 0, x, 0, s, 0, y, 0, 0, s, z};   // mesh to grid space, in 1/4096 voxel
//     const SparseVoxels voxels = voxelize(8, {{.mesh = &mesh, .frame = frame}}, 1, 0);
//     const std::vector<octree::Word> words = octree::build(voxels.view(), 0);
//
// The grid is cut into tiles of 64 x 64 columns over its whole height. A column's voxels depend on that column's
// triangles alone, so tiles are independent: threads take tiles, need no atomics, and the result does not depend on
// which thread took which tile. Stages and what bounds them:
//
//   analysis  vertices snapped, closed surfaces recognized, holes capped         triangles; memory bandwidth
//   bin       triangles listed by tile                                           triangles; one thread
// then tile by tile
//   coverage  triangles to shell bricks and crossings; boxes and balls           columns under triangles; vector units
//   fill      brick columns swept, the inside claimed                            surface bricks; L2 cache
//   holes     the same for surfaces with holes                                   surface bricks, voxels near holes
//   order     bricks put in Morton order                                         surface bricks; L2 cache
// and at last
//   rule      voxels that a rule does not fill are taken away, thin parts kept     surface bricks; L2 cache
//             (a single part of one material: its tiles take what the rule fills, and only thin parts are left)
//   gather    the bricks of all tiles laid out one after another                 surface bricks; memory bandwidth
//
// A part that touches few tiles is not binned by triangle: its tiles take it whole and snap its vertices themselves.
#pragma once

#include "../grid/sparse_voxels.h"
#include "../rules/rule.h"
#include "../scene/object_mode.h"
#include "../scene/parts.h"
#include "../work/interrupt.h"
#include "../work/large_vector.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace voxrt::voxelize {

/// Voxelizes `parts`, ascending by object, on a grid of 2^depth voxels per side.
///
/// `depth` is 1 … 16, `objects` is above the object of every part. `thin`: rule.h. `threads`: 0 takes
/// as many as the machine has; the result does not depend on it. `instructions`: one of the processor's instruction
/// sets (vector_coverage.h), or empty for the fastest; all give the same voxels. The arguments are not checked. Throws
/// OutOfRange (parts.h), std::length_error where the tiles would list 2^32 triangles or more, std::invalid_argument
/// where the processor has no such instructions, and what the caller's interrupt check throws (interrupt.h).
SparseVoxels voxelize(int depth, const std::vector<PartView>& parts, size_t objects, int threads,
                      Thin thin = Thin::keep, const std::string& instructions = {});

/// Which part of each voxel with surface an object fills, whatever other objects there are.
struct ObjectVolumes {
    LargeVector<uint32_t> objects;              // by voxel, ascending
    LargeVector<std::array<int32_t, 3>> voxels; // (x, y, z)
    LargeVector<double> volumes;                // 0 … 1
    LargeVector<int64_t> whole;                 // by object: voxels that it fills and that have no surface of it
    LargeVector<uint8_t> known;                 // by object: 0 where it has surfaces with openings, balls or ellipsoids
};

/// Finds the volumes of objects. Arguments and errors are those of voxelize(); the rules and fills of parts do not
/// matter.
ObjectVolumes find_volumes(int depth, std::vector<PartView> parts, size_t objects, int threads,
                           const std::string& instructions = {});

/// Receives the voxels of a block, all that no other block has; its lists of objects are empty.
using TakeBlock = std::function<void(SparseVoxels&&)>;

/// The same block by block: squares of `block_side` columns (a multiple of 64), over the grid's whole height, in Morton
/// order. Only one block's voxels are in memory at a time. `take` is called for blocks with geometry; octree::Assembly
/// joins their octrees. Returns what became of the objects, without voxels.
SparseVoxels voxelize_in_blocks(int depth, const std::vector<PartView>& parts, size_t objects, int threads,
                                int block_side, const TakeBlock& take, Thin thin = Thin::keep,
                                const std::string& instructions = {});

/// A square of columns over the grid's whole height: its lowest column, and columns per side.
struct ColumnBlock {
    int x, y, side;
};

/// What some blocks found of an object. The sum over disjoint blocks is what they find together.
struct ObjectTally {
    int64_t voxels = 0;                            // that belong to it
    int64_t shell_of_open = 0, inside_of_open = 0; // of its parts with openings worth a note
    int64_t overlaps_itself = 0;                   // 0, or 1
    int64_t positive = 0, negative = 0;            // 1 where winding numbers above 0, or below, were met

    void add(const ObjectTally& other) {
        voxels += other.voxels;
        shell_of_open += other.shell_of_open;
        inside_of_open += other.inside_of_open;
        overlaps_itself |= other.overlaps_itself;
        positive |= other.positive;
        negative |= other.negative;
    }
};

/// Parts that are ready to be voxelized, a block of columns at a time and in any order: what is done for all blocks
/// together, analysis and binning, is done once. Arguments and errors are those of voxelize(); the meshes and frames of
/// the parts must outlive this.
class BlockVoxelizer {
public:
    /// `wanted`: by object, 0 where it is left out, for blocks that it does not reach; empty for all objects.
    BlockVoxelizer(int depth, std::vector<PartView> parts, size_t objects, int threads, Thin thin = Thin::keep,
                   std::span<const uint8_t> wanted = {});
    ~BlockVoxelizer();

    /// Sets the number of threads; 0 takes as many as the machine has.
    void use_threads(int threads);

    /// Takes an instruction set, as voxelize() does.
    void use_instructions(const std::string& instructions);

    /// The blocks with geometry, in Morton order. `block_side`: a multiple of 64.
    std::vector<ColumnBlock> blocks(int block_side) const;

    /// By object: whether it may have a voxel in a block.
    std::vector<uint8_t> objects_of(const ColumnBlock& block) const;

    /// The voxels of a block, without lists of objects. Adds to the tally of each object.
    SparseVoxels block(const ColumnBlock& block, std::vector<ObjectTally>& tallies);

    /// The same for the last block, and the report; then nothing is left, to make room for its voxels.
    SparseVoxels last_block(const ColumnBlock& block, std::vector<ObjectTally>& tallies, SparseVoxels& report);

    /// What became of the objects, without voxels. `tallies`: of all blocks, whoever made them.
    SparseVoxels report(const std::vector<ObjectTally>& tallies) const;

    /// The volumes of objects whose parts all have the rule `half`.
    ObjectVolumes volumes();

    /// Wall seconds so far.
    const StageSeconds& seconds() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace voxrt::voxelize
