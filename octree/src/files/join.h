// The octree of a part of a world, joined to that of the other parts in a pool of blocks.
//
// Where each block of a part stands behind all that point to it, as in every memory of build(), its blocks are taken
// over in one pass from the last to the first: addresses go down evenly, and the places of the next blocks in the
// pool's table are fetched meanwhile. Other memories are walked from the root.
#pragma once

#include "../words/memory.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace voxrt::octree {

/// The words of one part, and the nodes of its blocks as far as they were taken over. `Pool`: BlockPool or FilePool.
template <typename Pool> class JoiningPart {
public:
    JoiningPart(Pool& pool, const Memory& memory)
        : pool_(pool), memory_(memory), nodes_(block_count(memory.size) + 1, kUnknown) {
        if (!take_over_in_order())
            std::fill(nodes_.begin(), nodes_.end(), kUnknown);
    }

    /// What stands in an octant, joined with `word` of this part. Throws std::invalid_argument where both are solid.
    Word join(Word there, Word word, unsigned level) {
        if (word == kEmpty)
            return there;
        if (there == kEmpty)
            return take_over(word, level);
        if (is_leaf(there) || is_leaf(word))
            throw std::invalid_argument("the parts of a memory overlap; join parts of disjoint voxels");
        const Block before = pool_[there]; // the pool may grow
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = join(before[octant], memory_.child(word, octant, level), level - 1);
        return pool_.intern(children);
    }

private:
    static constexpr Word kUnknown = 0x7FFF'FFFFu; // behind the last block that a pool can hold
    static constexpr std::size_t kAhead = 16;      // blocks whose places are fetched

    struct Waiting {
        Block children;
        std::uint64_t hash;
    };

    // Takes over all blocks; false where one does not stand in front of its children, or is too high for the depth.
    bool take_over_in_order() {
        if (!is_memory_size(memory_.size))
            return false;
        const std::size_t blocks = block_count(memory_.size);
        std::vector<std::uint8_t> levels(blocks + 1, 0);
        std::array<Waiting, kAhead> waiting;
        std::size_t taken = blocks; // this block and all behind it are in the pool
        const auto take_to = [&](std::size_t end) {
            while (taken > end) {
                --taken;
                const Waiting& next = waiting[taken % kAhead];
                nodes_[taken] = pool_.intern(next.children, next.hash);
            }
        };
        voxelize::WorkCounter& work = voxelize::WorkCounter::current();
        for (std::size_t number = blocks; number-- > 0;) {
            work.count_step();
            take_to(std::min(blocks, number + kAhead)); // their places are fetched next
            const Word* words = memory_.words + block_address(number);
            Waiting& next = waiting[number % kAhead];
            unsigned level = 0;
            for (unsigned octant = 0; octant < 8; ++octant) {
                const Word word = words[octant];
                const std::size_t block = block_number(word);
                const std::size_t child = block < blocks ? block : blocks; // a leaf's, so that nothing branches on it
                if ((!is_leaf(word)) & (!is_block_address(word) | (block <= number) | (block >= blocks)))
                    return false;
                if (child < taken)
                    take_to(child);
                level = std::max<unsigned>(level, levels[child]);
                next.children[octant] = is_leaf(word) ? word : nodes_[child];
            }
            if (level >= memory_.depth)
                return false;
            levels[number] = static_cast<std::uint8_t>(level + 1);
            next.hash = pool_.prepare(next.children);
        }
        take_to(0);
        return true;
    }

    Word take_over(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        voxelize::WorkCounter::current().count_step();
        memory_.child(word, 0, level); // checks the address
        const std::size_t number = block_number(word);
        if (!is_block_address(word) || number + 1 >= nodes_.size())
            throw std::invalid_argument("the words are not a valid octree; validate them first");
        if (nodes_[number] != kUnknown)
            return nodes_[number];
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = take_over(memory_.child(word, octant, level), level - 1);
        return nodes_[number] = pool_.intern(children);
    }

    Pool& pool_;
    Memory memory_;
    std::vector<Word> nodes_; // by block of the part, and one for none
};

} // namespace voxrt::octree
