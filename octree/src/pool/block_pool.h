// Blocks stored once (hash consing): a flat hash table from the eight words of a block to its number.
//
// A node is a word whose pointers are block numbers instead of addresses; breadth_first_words() turns nodes into words.
// Cost: for a block that is already there, one probe (a cache line of slots) and one comparison (half a line).
#pragma once

#include "block_hash.h"

#include <vector>

namespace voxrt::octree {

using Node = Word;

class BlockPool {
public:
    explicit BlockPool(std::size_t expected_blocks = 512) {
        std::size_t slots = 1024;
        while (slots < 2 * expected_blocks)
            slots *= 2;
        slots_.assign(slots, Slot{0, kFree});
        blocks_.reserve(expected_blocks);
    }

    /// The hash of a block; fetches its place in the table, for an intern() soon.
    std::uint64_t prepare(const Block& children) const {
        const std::uint64_t hash = block_hash(children);
#if defined(__GNUC__)
        __builtin_prefetch(&slots_[block_tag(hash) & (slots_.size() - 1)]);
#endif
        return hash;
    }

    /// The node for eight children: their leaf where all are the same leaf, else the block's number. Throws
    /// std::length_error where that would be the block beyond what 31-bit addresses can reach.
    Node intern(const Block& children) { return intern(children, block_hash(children)); }

    /// The same for a block whose hash is known.
    Node intern(const Block& children, std::uint64_t whole_hash) {
        if (is_leaf(children[0]) && is_uniform(children))
            return children[0];
        const Word hash = block_tag(whole_hash);
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = hash & mask;
        for (; slots_[i].number != kFree; i = (i + 1) & mask)
            if (slots_[i].hash == hash && is_same(blocks_[slots_[i].number], children))
                return slots_[i].number;
        if (blocks_.size() >= kBlockLimit)
            throw_too_many_blocks();
        const Word number = static_cast<Word>(blocks_.size());
        slots_[i] = {hash, number};
        blocks_.push_back(children);
        if (2 * blocks_.size() > slots_.size())
            grow();
        return number;
    }

    const Block& operator[](Node number) const { return blocks_[number]; }
    std::size_t size() const { return blocks_.size(); }

private:
    struct Slot {
        Word hash;
        Word number;
    };
    static constexpr Word kFree = ~Word{0};

    void grow() {
        std::vector<Slot> old(2 * slots_.size(), Slot{0, kFree});
        old.swap(slots_);
        const std::size_t mask = slots_.size() - 1;
        for (const Slot& slot : old) {
            if (slot.number == kFree)
                continue;
            std::size_t i = slot.hash & mask;
            while (slots_[i].number != kFree)
                i = (i + 1) & mask;
            slots_[i] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::vector<Block> blocks_;
};

} // namespace voxrt::octree
