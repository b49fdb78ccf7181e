// How much of a memory is stored once, in the forms of the literature: plain octree, graph, graph with mirrors.
#pragma once

#include "memory.h"

#include <cstdint>
#include <vector>

namespace voxrt::octree {

/// Nodes of one level and the words that they take, in the form of occupancy_dag.h.
struct DagLevel {
    std::uint64_t tree_nodes = 0; // without sharing
    std::uint64_t tree_words = 0;
    std::uint64_t nodes = 0; // as occupancy_dag() makes them
    std::uint64_t words = 0;
    std::uint64_t mirrored_nodes = 0; // if nodes that are equal up to mirroring along axes were stored once, and each
    std::uint64_t mirrored_words = 0; // pointer held its mirror in three bits
};

/// Element n counts level n of the voxels of `memory`, without materials. Below the levels that nodes have, element 1
/// counts the cubes of 2 voxels per side that are not empty, and element 0 the solid voxels, both under `tree_nodes`.
/// Throws as occupancy_dag() does.
std::vector<DagLevel> dag_levels(const Memory& memory);

/// The blocks that would remain of `memory`, with its materials, if blocks that are equal up to mirroring along axes
/// were stored once. Throws std::invalid_argument where the words are no octree.
std::size_t mirrored_blocks(const Memory& memory);

} // namespace voxrt::octree
