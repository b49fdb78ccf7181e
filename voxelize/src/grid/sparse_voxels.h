// Sparse voxels: what the voxelizer makes and octree::build takes.
//
// A grid has 2^depth voxels per side, depth 1 … 16. Its solid voxels are bricks (8x8x8 voxels of mixed content) and
// octants (uniform cubes of 8 voxels or more per side), each list in Morton order (morton.h) and disjoint. What neither
// holds is empty. So the size grows with the surface, not with the volume.
#pragma once

#include "../work/large_vector.h"
#include "../work/stage_seconds.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxrt::voxelize {

/// Borrowed arrays. Voxel i of a brick (0 … 511) stands at the Morton code i in it; a grid of depth 1 or 2 uses the
/// first 8^depth voxels of the single brick 0.
struct VoxelsView {
    unsigned depth;
    std::size_t bricks;
    const std::uint64_t* brick_codes; // Morton code of the brick's lowest corner / 8, strictly ascending
    const std::uint64_t* brick_masks; // 8 per brick: bit i % 64 of word i / 64 is 1 where voxel i is solid; never all 0
    const std::uint8_t* brick_materials; // of all solid voxels of the brick; 0 where `cells` has them
    const std::int32_t* brick_rows;      // row of `cells`, or -1 where the brick has one material
    std::size_t rows;
    const std::uint8_t* cells; // 512 per row: the material of each voxel, 0 where it is empty
    std::size_t octants;
    const std::uint64_t* octant_codes; // Morton code of the octant's lowest corner / its volume, ascending by position
    const std::uint8_t* octant_levels; // log2 of the side in voxels, 3 … depth
    const std::uint8_t* octant_materials;
};

/// What an object's author should know, by number.
enum ObjectNote : std::size_t {
    kFlippedComponents, // connected components that were inside out
    kTurnedFaces,       // triangles that were wound against those beside them
    kOneSidedPieces,    // that cannot be wound consistently, like a Klein bottle
    kMostlyFilled,      // 1: its open parts have more inside than shell
    kInwardParts,       // not 0: winding numbers above and below 0 were met, or bodies may count wrongly
    kObjectNotes
};
using ObjectNotes = std::array<std::int64_t, kObjectNotes>; // how often each was met

/// The voxels of a scene, and what became of each of its objects.
struct SparseVoxels {
    unsigned depth = 0;
    LargeVector<std::uint64_t> brick_codes;
    LargeVector<std::array<std::uint64_t, 8>> brick_masks;
    LargeVector<std::uint8_t> brick_materials;
    LargeVector<std::int32_t> brick_rows;
    LargeVector<std::array<std::uint8_t, 512>> cells;
    LargeVector<std::uint64_t> octant_codes;
    LargeVector<std::uint8_t> octant_levels;
    LargeVector<std::uint8_t> octant_materials;
    LargeVector<std::int64_t> object_voxels; // by object: voxels that belong to it
    LargeVector<std::uint8_t> object_modes;  // by object: ObjectMode
    LargeVector<ObjectNotes> object_notes;   // by object
    StageSeconds seconds;

    /// Makes all lists of voxels empty.
    void clear() {
        brick_codes.clear();
        brick_masks.clear();
        brick_materials.clear();
        brick_rows.clear();
        cells.clear();
        octant_codes.clear();
        octant_levels.clear();
        octant_materials.clear();
    }

    /// Borrows the voxels: valid as long as this is.
    VoxelsView view() const {
        return {depth,
                brick_codes.size(),
                brick_codes.data(),
                reinterpret_cast<const std::uint64_t*>(brick_masks.data()),
                brick_materials.data(),
                brick_rows.data(),
                cells.size(),
                reinterpret_cast<const std::uint8_t*>(cells.data()),
                octant_codes.size(),
                octant_codes.data(),
                octant_levels.data(),
                octant_materials.data()};
    }
};

} // namespace voxrt::voxelize
