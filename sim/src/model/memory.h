// The octree memory as the model reads it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace voxrt::model {

inline constexpr int kMaxDepth = 16;
inline constexpr uint8_t kFaceNone = 3; // of a hit or miss that crossed no face

inline constexpr bool is_leaf(uint32_t word) { return word >> 31 != 0; }
inline constexpr uint8_t material_of(uint32_t word) { return static_cast<uint8_t>(word); }

// A memory in the report dialect: `words` is borrowed, `depth` is 1 ... kMaxDepth.
struct Memory {
    const uint32_t* words;
    size_t count;
    int depth;

    // Throws std::invalid_argument, naming the word, unless every path from word 0 ends in a tag within `depth` levels
    // and every pointer on it stands at 1 + 8k with its block inside the memory. Tracing a memory that passed reads
    // nothing outside it and always ends. O(blocks) for memories in which a block is reached at one level only.
    void verify() const;
};

} // namespace voxrt::model
