#include "memory.h"

#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::model {
namespace {

[[noreturn]] void refuse(size_t address, uint32_t word, const char* problem) {
    char text[160];
    std::snprintf(text, sizeof text, "word %zu (%08X) of the octree memory %s", address, word, problem);
    throw std::invalid_argument(text);
}

} // namespace

void Memory::verify() const {
    if (depth < 1 || depth > kMaxDepth)
        throw std::invalid_argument("depth " + std::to_string(depth) + " is not 1 ... 16");
    if (count % 8 != 1 || count > 0x80000000u)
        throw std::invalid_argument("an octree memory holds 1 + 8k words, not " + std::to_string(count));

    // One level at a time, each block once a level: a cycle shows as a pointer below the last level.
    std::vector<uint32_t> blocks, below;
    std::vector<uint8_t> level_seen((count - 1) / 8, 0);
    const auto follow = [&](size_t address, int level) {
        const uint32_t word = words[address];
        if (is_leaf(word)) {
            if (word < 0xFFFFFF00u)
                refuse(address, word, "is neither a pointer nor a material tag");
            return;
        }
        if (word % 8 != 1)
            refuse(address, word, "points to no block: blocks stand at 1 + 8k");
        if (word + size_t{8} > count)
            refuse(address, word, "points outside the memory");
        if (level == depth)
            refuse(address, word, "points below the last level: the memory is cyclic or deeper than its depth");
        uint8_t& seen = level_seen[word / 8];
        if (seen != level + 1) {
            seen = static_cast<uint8_t>(level + 1);
            below.push_back(word);
        }
    };
    follow(0, 0);
    for (int level = 1; !below.empty(); ++level) {
        blocks.swap(below);
        below.clear();
        for (const uint32_t block : blocks)
            for (uint32_t octant = 0; octant < 8; ++octant)
                follow(block + octant, level);
    }
}

} // namespace voxrt::model
