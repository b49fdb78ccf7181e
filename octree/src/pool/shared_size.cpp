#include "shared_size.h"

#include "block_hash.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <vector>

namespace voxrt::octree {
namespace {

// Each block has a representative: the first block that is equal to it, or the leaf that it is equal to. Children are
// compared by their representatives.
class SharedBlocks {
public:
    explicit SharedBlocks(const Memory& memory)
        : memory_(memory), representatives_(block_count(memory.size), kUnknown) {
        std::size_t slots = 1024;
        while (slots < 2 * representatives_.size())
            slots *= 2;
        slots_.assign(slots, kUnknown);
    }

    std::size_t count() const { return count_; }

    Word representative(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        memory_.child(word, 0, level); // checks the address
        const std::size_t number = block_number(word);
        if (!is_block_address(word) || number >= representatives_.size())
            throw std::invalid_argument("the words are not a valid octree; validate them first");
        if (representatives_[number] != kUnknown)
            return representatives_[number];
        work_.count_step();
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = representative(memory_.child(word, octant, level), level - 1);
        return representatives_[number] = find(children, word);
    }

private:
    static constexpr Word kUnknown = 0; // no block has this address

    Word find(const Block& children, Word word) {
        if (is_leaf(children[0]) &&
            std::all_of(children.begin(), children.end(), [&](Word w) { return w == children[0]; }))
            return children[0];
        const std::size_t mask = slots_.size() - 1;
        std::size_t slot = block_hash(children) & mask;
        for (; slots_[slot] != kUnknown; slot = (slot + 1) & mask)
            if (children_of(slots_[slot]) == children)
                return slots_[slot];
        slots_[slot] = word;
        ++count_;
        return word;
    }

    Block children_of(Word word) const {
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child = memory_.words[word + octant];
            children[octant] = is_leaf(child) ? child : representatives_[block_number(child)];
        }
        return children;
    }

    Memory memory_;
    std::vector<Word> representatives_; // by block
    std::vector<Word> slots_;           // blocks by their hash
    std::size_t count_ = 0;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

std::size_t shared_words(const Memory& memory) {
    SharedBlocks blocks(memory);
    blocks.representative(memory.root(), memory.depth);
    return memory_size(blocks.count());
}

} // namespace voxrt::octree
