// The words of an octree memory, and a view of them that checks each address. words.h describes a word.
#pragma once

#include "words.h"

#include <voxrt/voxelize/work/large_vector.h>

namespace voxrt::octree {

/// The words of a memory that was made.
using Words = voxelize::LargeVector<Word>;

/// In place of the word of a root: it is word 0 of the memory.
constexpr std::uint64_t kWord0 = ~std::uint64_t{0};

/// Borrowed words that claim to be an octree of `depth` levels, 1 … kMaxDepth: a world of 2**depth voxels per side.
///
/// Memories are read through root() and child(), which check every address. So words that are no octree end in
/// std::invalid_argument, never in a read outside the memory. Each step goes down one level, so every walk ends.
/// validate.h tells what is wrong with words; VerifiedMemory (verify.h) is for readers that check nothing.
struct Memory {
    const Word* words;
    std::size_t size; // words
    unsigned depth;
    std::uint64_t root_word = kWord0; // the root; kWord0: word 0

    /// The word of the whole world.
    Word root() const {
        if (root_word != kWord0)
            return static_cast<Word>(root_word);
        if (size == 0)
            throw std::invalid_argument("the octree memory has no words; it needs at least its root");
        return words[0];
    }

    /// The word of child `octant` in the block at `pointer`, a word of an octant of side 2**level.
    Word child(Word pointer, unsigned octant, unsigned level) const {
        const std::size_t address = std::size_t{pointer} + octant;
        if (address >= size || level == 0)
            throw std::invalid_argument("the words are not a valid octree: a pointer leads outside the memory or below "
                                        "its depth; validate them first");
        return words[address];
    }
};

} // namespace voxrt::octree
