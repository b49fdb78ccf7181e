// Blocks that no ray from outside can reach.
#pragma once

#include <unordered_map>

#include "memory.h"

namespace voxrt::octree {

/// How many octants of side 2**level hold a block that is solid throughout and has nothing but solid voxels at its six
/// faces, by block. Walks the octants around such blocks, one by one; gives up with an empty answer after 2**22 of
/// them.
std::unordered_map<Word, std::uint64_t> hidden_octants(const Memory& memory, unsigned level);

/// Whether the octant at `corner` of side 2**level and the layer of voxels at its six faces are solid; an octant at the
/// edge of the world is not.
bool enclosed(const Memory& memory, const std::array<std::int64_t, 3>& corner, unsigned level);

} // namespace voxrt::octree
