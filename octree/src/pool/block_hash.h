// Blocks compared, and hashed: multiply-fold mixing (Wang Yi, wyhash, 2019), in two chains that run side by side.
#pragma once

#include "../words/words.h"

#include <cstring>

namespace voxrt::octree {

/// Words 2 i and 2 i + 1 of a block as one number: blocks are compared and hashed two words at a time.
inline std::uint64_t word_pair(const Block& block, unsigned i) {
    std::uint64_t words;
    std::memcpy(&words, &block[2 * i], sizeof words);
    return words;
}

inline std::uint64_t fold_product(std::uint64_t a, std::uint64_t b) {
    const __uint128_t product = static_cast<__uint128_t>(a) * (b ^ 0xD6E8FEB86659FD93u);
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

inline std::uint64_t block_hash(const Block& children) {
    return fold_product(fold_product(word_pair(children, 0) ^ 0x9E3779B97F4A7C15u, word_pair(children, 1)) ^
                            fold_product(word_pair(children, 2) ^ 0xA0761D6478BD642Fu, word_pair(children, 3)),
                        0);
}

/// Whether all eight words are equal.
inline bool is_uniform(const Block& children) {
    const std::uint64_t first = word_pair(children, 0);
    return ((first ^ word_pair(children, 1)) | (first ^ word_pair(children, 2)) | (first ^ word_pair(children, 3)) |
            (children[0] ^ children[1])) == 0;
}

inline bool is_same(const Block& a, const Block& b) {
    return ((word_pair(a, 0) ^ word_pair(b, 0)) | (word_pair(a, 1) ^ word_pair(b, 1)) |
            (word_pair(a, 2) ^ word_pair(b, 2)) | (word_pair(a, 3) ^ word_pair(b, 3))) == 0;
}

/// The hash in 32 bits, for tables that keep it.
inline Word block_tag(std::uint64_t hash) { return static_cast<Word>(hash ^ hash >> 32); }

} // namespace voxrt::octree
