// The octree of a part of a world, joined to that of the other parts in a pool of blocks.
#pragma once

#include "memory.h"

#include <voxrt/voxelize/interrupt.h>

#include <stdexcept>
#include <vector>

namespace voxrt::octree {

/// The words of one part, and the nodes of its blocks as far as they were taken over. `Pool`: BlockPool or FilePool.
template <typename Pool> class JoiningPart {
public:
    JoiningPart(Pool& pool, const Memory& memory) : pool_(pool), memory_(memory), nodes_(memory.size / 8, kUnknown) {}

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

    Word take_over(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        voxelize::WorkCounter::current().count_step();
        memory_.child(word, 0, level); // checks the address
        const std::size_t number = (word - 1) / 8;
        if (word == 0 || number >= nodes_.size())
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
    std::vector<Word> nodes_; // by block of the part
};

} // namespace voxrt::octree
