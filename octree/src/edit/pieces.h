// Parts of an octree cut out, moved by any number of voxels, and turned: nodes of a pool.
//
// Moving by voxels: an octant of the result covers parts of up to eight octants of its size in the source. Its children
// are found from their children, so each different eight are looked at once per level, as in Gosper, "Exploiting
// Regularities in Large Cellular Spaces", 1984.
#pragma once

#include "../pool/block_pool.h"
#include "../query/query.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxrt::octree {

inline constexpr std::size_t kEndless = ~std::size_t{0};

/// What `memory` has inside `box`, of the same depth; `materials` replaces each material by another. Cost: the octants
/// on the faces of the box, and the blocks inside, each once. Throws std::length_error where these are more than
/// `most`.
Node cut_out(const Memory& memory, const Box& box, const std::array<std::uint8_t, 256>& materials, BlockPool& pool,
             std::size_t most = kEndless);

/// The memory of a box of at least one voxel, whose lowest voxel becomes 0, 0, 0, and its depth: the least.
struct Copied {
    Words words;
    unsigned depth;
};

/// What cut_out() takes, as a memory of its own; it throws the same.
Copied copied(const Memory& memory, const Box& box, const std::array<std::uint8_t, 256>& materials,
              std::size_t most = kEndless);

/// An octree turned by quarters of a turn around the y axis of its world: one takes the z axis to the x axis, and the x
/// axis to the opposite of the z axis. Cost: its blocks, each once.
Node turned(Node root, unsigned quarters, BlockPool& pool);

/// An octree of `depth` moved by `distance` into a world of `new_depth`; what leaves that world is lost. Distances are
/// below 2**21.
Node moved(Node root, unsigned depth, const std::array<std::int64_t, 3>& distance, unsigned new_depth, BlockPool& pool);

} // namespace voxrt::octree
