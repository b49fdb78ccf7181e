#include "verify.h"

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace voxrt::octree {
namespace {

[[noreturn]] void refuse(std::size_t address, Word word, const char* problem) {
    char text[160];
    std::snprintf(text, sizeof text, "word %zu (%08X) of the octree memory %s", address, word, problem);
    throw std::invalid_argument(text);
}

} // namespace

VerifiedMemory::VerifiedMemory(const Memory& memory) : memory_(memory), root_(kEmpty) {
    const unsigned depth = memory.depth;
    const std::size_t size = memory.size;
    if (depth < 1 || depth > kMaxDepth)
        throw std::invalid_argument("depth " + std::to_string(depth) + " is not 1 ... 16");
    if (!is_memory_size(size) || block_count(size) > kBlockLimit)
        throw std::invalid_argument("an octree memory holds 1 + 8k words, not " + std::to_string(size));

    root_ = memory.root();
    // One level at a time, each block once per level: a cycle shows as a pointer below the last level.
    std::vector<Word> blocks, below;
    std::vector<std::uint8_t> level_seen(block_count(size), 0);
    const auto follow = [&](std::size_t address, Word word, unsigned level) {
        if (is_leaf(word)) {
            if (!is_tagged(word))
                refuse(address, word, "is neither a pointer nor a material tag");
            return;
        }
        if (!is_block_address(word))
            refuse(address, word, "points to no block: blocks stand at 1 + 8k");
        if (word + std::size_t{8} > size)
            refuse(address, word, "points outside the memory");
        if (level == depth)
            refuse(address, word, "points below the last level: the memory is cyclic or deeper than its depth");
        std::uint8_t& seen = level_seen[block_number(word)];
        if (seen != level + 1) {
            seen = static_cast<std::uint8_t>(level + 1);
            below.push_back(word);
        }
    };
    follow(0, root_, 0);
    for (unsigned level = 1; !below.empty(); ++level) {
        blocks.swap(below);
        below.clear();
        for (const Word block : blocks)
            for (unsigned octant = 0; octant < 8; ++octant)
                follow(block + octant, memory.words[block + octant], level);
    }
}

} // namespace voxrt::octree
