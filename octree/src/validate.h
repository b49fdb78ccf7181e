// Is it an octree? Linear time and memory in the number of words, whatever they say.
#pragma once

#include <cstddef>

#include "words.h"

namespace voxrt::octree {

enum class Fault {
    none,
    length,     // not 1 + 8 * blocks words
    tag,        // bit 31 set, but not 0xFFFFFFmm
    misaligned, // a pointer that is not 1 + 8k
    range,      // a pointer to a block that the memory does not hold
    cycle,      // a pointer to a block that it lies below
    too_deep,   // a pointer where `depth` levels leave room for a leaf alone
};

/// What is wrong and the address of the word at which it shows; `least_depth` is the levels that the memory has, told
/// for `none` and `too_deep`.
struct Verdict {
    Fault fault;
    std::size_t address;
    std::size_t least_depth;
};

/// Every word is checked, reached from the root or not. `depth` 0 asks for no limit. The GIL must not be held.
Verdict validate(const Word* words, std::size_t size, unsigned depth);

} // namespace voxrt::octree
