// Hidden voxels: those that no ray from outside can reach.
#pragma once

#include "../words/memory.h"

#include <unordered_map>
#include <vector>

namespace voxrt::octree {

/// The memory of the hidden voxels, of material 1. A voxel is hidden where it is solid and all 26 voxels around it are
/// solid voxels of the world.
///
/// A ray crosses one plane at a time, so the first solid voxel that it meets shares a face with an empty one. The
/// neighbours at edges and corners count too, since a camera may stand on an edge or a corner of an empty voxel.
///
/// Cost: octants at the surface, and blocks; never volume. Neighbourhoods met before are looked up in a cache of
/// bounded size. Throws std::invalid_argument where the words are no octree.
Words hidden_voxels(const Memory& memory);

/// The memory of the covered voxels, of material 1. A voxel is covered where it is solid and so are the six voxels that
/// share a face with it: nothing is seen of it. Cost and errors as of hidden_voxels().
Words covered_voxels(const Memory& memory);

/// How many octants of side 2**level hold a block all of whose voxels are solid in `hidden`, by block. Linear in the
/// pairs of blocks that lie in one place.
std::unordered_map<Word, std::uint64_t> hidden_octants(const Memory& memory, const Memory& hidden, unsigned level);

} // namespace voxrt::octree
