#include "validate.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <vector>

namespace voxrt::octree {
namespace {

Verdict check_words(const Word* words, std::size_t size) {
    if (!is_memory_size(size))
        return {Fault::length, size, 0};
    for (std::size_t address = 0; address < size; ++address) {
        const Word word = words[address];
        if (is_leaf(word)) {
            if (!is_tagged(word))
                return {Fault::tag, address, 0};
        } else if (!is_block_address(word)) {
            return {Fault::misaligned, address, 0};
        } else if (word >= size) {
            return {Fault::range, address, 0};
        }
    }
    return {Fault::none, 0, 0};
}

// The longest path of pointers from each block down, by depth-first search with a stack of its own.
class Heights {
public:
    Heights(const Word* words, std::size_t size) : words_(words), heights_(block_count(size), kUnvisited) {}

    // False where a cycle was met; `cycle_address` then holds the word that closes it.
    bool measure(std::size_t first) {
        if (heights_[first] != kUnvisited)
            return true;
        stack_.assign(1, {first, 0});
        heights_[first] = kOpen;
        while (!stack_.empty()) {
            work_.count_step();
            Visit& visit = stack_.back();
            if (visit.octant == 8) {
                close(visit.block);
                stack_.pop_back();
                continue;
            }
            const std::size_t address = block_address(visit.block) + visit.octant++;
            if (is_leaf(words_[address]))
                continue;
            const std::size_t below = block_number(words_[address]);
            if (heights_[below] == kOpen) {
                cycle_address = address;
                return false;
            }
            if (heights_[below] == kUnvisited) {
                heights_[below] = kOpen;
                stack_.push_back({below, 0});
            }
        }
        return true;
    }

    std::size_t of(Word word) const { return is_leaf(word) ? 0 : heights_[block_number(word)]; }

    std::size_t cycle_address = 0;

private:
    struct Visit {
        std::size_t block;
        unsigned octant;
    };
    static constexpr std::uint32_t kUnvisited = ~std::uint32_t{0};
    static constexpr std::uint32_t kOpen = kUnvisited - 1;

    void close(std::size_t block) {
        std::size_t highest = 0;
        for (unsigned octant = 0; octant < 8; ++octant)
            highest = std::max(highest, of(words_[block_address(block) + octant]));
        heights_[block] = static_cast<std::uint32_t>(highest + 1);
    }

    const Word* words_;
    std::vector<std::uint32_t> heights_;
    std::vector<Visit> stack_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

Verdict validate(const Word* words, std::size_t size, unsigned depth) {
    const Verdict verdict = check_words(words, size);
    if (verdict.fault != Fault::none)
        return verdict;
    Heights heights(words, size);
    if (!is_leaf(words[0]) && !heights.measure(block_number(words[0])))
        return {Fault::cycle, heights.cycle_address, 0};
    for (std::size_t block = 0; block < block_count(size); ++block)
        if (!heights.measure(block))
            return {Fault::cycle, heights.cycle_address, 0};
    const std::size_t levels = heights.of(words[0]);
    if (depth == 0 || levels <= depth)
        return {Fault::none, 0, levels};
    std::size_t address = 0;
    for (unsigned level = 0; level < depth; ++level) {
        address = words[address];
        while (heights.of(words[address]) + level + 1 < levels)
            ++address;
    }
    return {Fault::too_deep, address, levels};
}

} // namespace voxrt::octree
