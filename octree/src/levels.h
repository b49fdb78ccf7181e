// The blocks of an octree level by level, and how many octants show each.
#pragma once

#include "memory.h"

#include <unordered_map>
#include <vector>

namespace voxrt::octree {

/// A block at one level, and how many octants of that level it is the content of. A block may occur at several levels.
struct Occurrence {
    Word block;
    std::uint64_t octants;
};

/// Element `level` holds the blocks whose octants have the side 2**level, in the order of a breadth-first walk. Linear
/// in blocks times levels, whatever the world's size.
inline std::vector<std::vector<Occurrence>> blocks_by_level(const Memory& memory) {
    std::vector<std::vector<Occurrence>> levels(memory.depth + 1);
    if (!is_leaf(memory.root()))
        levels[memory.depth].push_back({memory.root(), 1});
    for (unsigned level = memory.depth; level > 0; --level) {
        std::unordered_map<Word, std::size_t> row;
        for (const Occurrence& parent : levels[level])
            for (unsigned octant = 0; octant < 8; ++octant) {
                const Word child = memory.child(parent.block, octant, level);
                if (is_leaf(child))
                    continue;
                const auto [entry, missing] = row.try_emplace(child, levels[level - 1].size());
                if (missing)
                    levels[level - 1].push_back({child, 0});
                levels[level - 1][entry->second].octants += parent.octants;
            }
    }
    return levels;
}

} // namespace voxrt::octree
