// Which voxels no ray from outside can reach.
#pragma once

#include <unordered_map>
#include <vector>

#include "memory.h"

namespace voxrt::octree {

/// The memory of the hidden voxels, material 1 each: those that are solid, as are all 26 around them, inside the world.
///
/// A ray crosses one plane at a time, so its first solid voxel shares a face with an empty one. The voxels at edges and
/// corners count too since a camera may stand on an edge or a corner of an empty voxel, and looks into what lies there.
///
/// Cost: octants at the surface of what is solid, and blocks; never volume. Neighbourhoods met before are looked up in
/// a cache of bounded size. The GIL must not be held.
std::vector<Word> hidden_voxels(const Memory& memory);

/// How many octants of side 2**level hold a block all of whose voxels are solid in `hidden`, by block. Linear in the
/// pairs of blocks that lie in one place.
std::unordered_map<Word, std::uint64_t> hidden_octants(const Memory& memory, const Memory& hidden, unsigned level);

} // namespace voxrt::octree
