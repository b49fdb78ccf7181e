// A view of memory words that cannot be walked out of.
#pragma once

#include <cstddef>
#include <stdexcept>

#include "words.h"

namespace voxrt::octree {

/// Words that claim to be an octree of `depth` levels. Every walk goes through `child`, so words that are not an octree
/// end in an exception and never in a bad read; a walk ends because its level falls with every step.
struct Memory {
    const Word* words;
    std::size_t size;
    unsigned depth;

    Word root() const {
        if (size == 0)
            throw std::invalid_argument("an octree memory has at least one word");
        return words[0];
    }

    /// Child `octant` of the block at `pointer`; `level` is the level of the pointer, of side 2**level voxels.
    Word child(Word pointer, unsigned octant, unsigned level) const {
        const std::size_t address = std::size_t{pointer} + octant;
        if (address >= size || level == 0)
            throw std::invalid_argument("the words are not a valid octree; read them with octree.decode");
        return words[address];
    }
};

} // namespace voxrt::octree
