// The blocks of an octree level by level, and how many octants show each.
#pragma once

#include "../words/memory.h"

#include <stdexcept>
#include <vector>

namespace voxrt::octree {

/// A block at one level, and how many octants of that level it is the content of. A block may occur at several levels.
struct Occurrence {
    Word block;
    std::uint64_t octants;
};

/// Goes down the levels of a memory, one step at a time. Remembers 4 bytes per block.
class LevelWalk {
public:
    /// The words of `memory` must outlive the walk.
    explicit LevelWalk(const Memory& memory) : memory_(memory), place_(block_count(memory.size) + 1, 0) {}

    /// The blocks below the blocks `parents`, whose octants have the side 2**level, in the order of a breadth-first
    /// walk. Calls on_leaf(word, octants) for the leaves among the children. Throws std::invalid_argument where the
    /// words are no octree.
    template <typename OnLeaf>
    std::vector<Occurrence> below(const std::vector<Occurrence>& parents, unsigned level, OnLeaf on_leaf) {
        std::vector<Occurrence> found;
        for (const Occurrence& parent : parents)
            for (unsigned octant = 0; octant < 8; ++octant) {
                const Word child = memory_.child(parent.block, octant, level);
                if (is_leaf(child)) {
                    on_leaf(child, parent.octants);
                    continue;
                }
                if (!is_block_address(child) || child >= memory_.size)
                    throw std::invalid_argument(
                        "the words are not a valid octree: a pointer leads to no block; validate them first");
                Word& place = place_[block_number(child)];
                if (place == 0) {
                    found.push_back({child, 0});
                    place = static_cast<Word>(found.size());
                }
                found[place - 1].octants += parent.octants;
            }
        for (const Occurrence& one : found)
            place_[block_number(one.block)] = 0;
        return found;
    }

private:
    Memory memory_;
    std::vector<Word> place_; // by block: one more than where it stands in the level that is made, or 0
};

/// Element `level` holds the blocks whose octants have the side 2**level, in the order of a breadth-first walk. Linear
/// in blocks times levels, whatever the world's size.
inline std::vector<std::vector<Occurrence>> blocks_by_level(const Memory& memory) {
    std::vector<std::vector<Occurrence>> levels(memory.depth + 1);
    if (!is_leaf(memory.root()))
        levels[memory.depth].push_back({memory.root(), 1});
    LevelWalk walk(memory);
    for (unsigned level = memory.depth; level > 0; --level)
        levels[level - 1] = walk.below(levels[level], level, [](Word, std::uint64_t) {});
    return levels;
}

} // namespace voxrt::octree
