// The voxels of a memory that can be seen, brick by brick, and all others as octants.
#pragma once

#include <voxrt/octree/words/verify.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

inline constexpr std::size_t kBrickVoxels = 512; // 8 x 8 x 8, by the Morton code of the position in the brick

// Bricks and octants are disjoint; together they hold every solid voxel. A world of depth below 3 is brick 0, of which
// it takes the first 8^depth voxels.
struct ExposedBricks {
    std::vector<std::uint64_t> brick_codes;  // Morton codes of the corners / 8, ascending
    std::vector<std::uint8_t> cells;         // kBrickVoxels per brick: materials, 0 empty
    std::vector<std::uint8_t> exposed;       // the same: the faces that are exposed, see below
    std::vector<std::uint64_t> octant_codes; // Morton codes of the corners / side, ascending by corner
    std::vector<std::uint8_t> octant_levels; // log2 of the side, 3 ...
    std::vector<std::uint8_t> octant_materials;
};

// A face of a solid voxel is exposed where the voxel beyond it is empty or outside the world. Bit 2 a of an entry of
// `exposed` stands for the face towards lower coordinates on axis a, bit 2 a + 1 for the other.
//
// Bricks are the ones with an exposed voxel, and others that are not uniform. `threads`: 0 takes as many as the machine
// has; the result does not depend on it. Cost: the surface. Throws std::invalid_argument where a brick would not be
// counted in 32 bits.
ExposedBricks exposed_bricks(const octree::VerifiedMemory& memory, int threads);

} // namespace voxrt::sim
