// Blocks stored once: a flat hash table from the eight words of a block to its number.
//
// A node is a word whose pointers are block numbers instead of addresses: `breadth_first_words` turns one into the
// other. Bounded by the cache: one probe (a line of slots) and one compare (half a line) a block that is already there.
#pragma once

#include <stdexcept>
#include <vector>

#include "words.h"

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

    /// The node for eight children: their leaf when all are the same leaf, else the block's number.
    Node intern(const Block& children) {
        if (is_leaf(children[0]) && all_equal(children))
            return children[0];
        const Word hash = hash_of(children);
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = hash & mask;
        for (; slots_[i].number != kFree; i = (i + 1) & mask)
            if (slots_[i].hash == hash && blocks_[slots_[i].number] == children)
                return slots_[i].number;
        if (blocks_.size() >= kBlockLimit)
            throw std::length_error("the octree has more blocks than 31-bit addresses can reach");
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
    static constexpr Word kFree = 0xFFFFFFFFu;
    static constexpr std::size_t kBlockLimit = (std::size_t{1} << 28) - 1;

    static bool all_equal(const Block& children) {
        Word difference = 0;
        for (unsigned octant = 1; octant < 8; ++octant)
            difference |= children[octant] ^ children[0];
        return difference == 0;
    }

    // Multiply-fold mixing, two words a step (Wang Yi, wyhash, 2019).
    static Word hash_of(const Block& children) {
        std::uint64_t state = 0x9E3779B97F4A7C15u;
        for (unsigned pair = 0; pair < 4; ++pair) {
            const std::uint64_t two = children[2 * pair] | std::uint64_t{children[2 * pair + 1]} << 32;
            const __uint128_t product = static_cast<__uint128_t>(state ^ two) * 0xD6E8FEB86659FD93u;
            state = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
        }
        return static_cast<Word>(state ^ (state >> 32));
    }

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
