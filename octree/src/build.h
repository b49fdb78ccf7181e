// Voxels (sparse bricks and uniform octants in Morton order) to memory words.
#pragma once

#include <cstddef>
#include <vector>

#include "words.h"

namespace voxrt::octree {

/// The arrays of voxelize.Voxels; the manual of each field is there. Sizes are counted in rows.
struct VoxelsView {
    unsigned depth;
    std::size_t bricks;
    const std::uint64_t* brick_codes;
    const std::uint64_t* brick_masks; // 8 a brick
    const std::uint8_t* brick_materials;
    const std::int32_t* brick_rows;
    std::size_t rows;
    const std::uint8_t* cells; // 512 a row
    std::size_t octants;
    const std::uint64_t* octant_codes;
    const std::uint8_t* octant_levels;
    const std::uint8_t* octant_materials;
};

/// The shared, breadth-first memory of `voxels`, the same for every number of threads (0: all that the machine has).
/// Cost: bricks and octants, never volume; memory: the blocks that differ, once and once more a further thread. Throws
/// std::invalid_argument where the arrays break their contract. The GIL must not be held.
std::vector<Word> build(const VoxelsView& voxels, unsigned threads);

/// The memory of a world of side 2**depth whose solid voxels are given one by one: Morton codes, strictly ascending,
/// and a material each. Throws std::invalid_argument as above. The GIL must not be held.
std::vector<Word> build_points(const std::uint64_t* codes, const std::uint8_t* materials, std::size_t count,
                               unsigned depth);

} // namespace voxrt::octree
