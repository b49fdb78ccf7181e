// The voxels of a memory as a directed acyclic graph with child masks, without materials: a sparse voxel DAG.
//
// Source: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", 2013. A graph is a sequence of words; node
// addresses count words. A node of level n is a cube of 2**n voxels per side, some of which are solid:
//
//   level 3 and higher: a word with the child mask in bits 0 ... 7 (bit i: octant i has solid voxels) and 0 above, then
//                       the address of the node of each such octant, in the order of the octants
//   level 2:            64 bits in two words, least significant word first; bit x + 4 y + 16 z is that voxel
//
// Equal nodes are stored once. Nodes stand in breadth-first order of first visit, so the root has address 0. The graph
// of an empty world has no words.
#pragma once

#include "block_pool.h"
#include "memory.h"

#include <cstdint>
#include <vector>

namespace voxrt::octree {

/// The lowest level that nodes have, and so the least depth.
constexpr unsigned kBitmapLevel = 2;

/// The graph of `memory`, whose depth is 2 or more. Linear in blocks times the levels at which they stand. Throws
/// std::invalid_argument where the words are no octree, std::length_error where 32-bit addresses do not reach.
Words occupancy_dag(const Memory& memory);

/// The root, in `pool`, of the octree of a graph of `size` words, of `depth` levels. Solid voxels have material 1.
/// Linear in words times levels. Throws std::invalid_argument, with the address of the word, where the words are no
/// graph.
Node occupied_octree(const Word* words, std::size_t size, unsigned depth, BlockPool& pool);

} // namespace voxrt::octree
