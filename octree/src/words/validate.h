// Whether words are an octree, and what is wrong where they are not. Linear in the words.
#pragma once

#include "words.h"

#include <cstddef>

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

struct Verdict {
    Fault fault;
    std::size_t address;     // of the word at fault; the number of words for Fault::length
    std::size_t least_depth; // levels of pointers below the root; known for `none` and `too_deep`, else 0
};

/// Checks every word, reached from the root or not (verify.h checks the reached ones alone). `depth` 0: no limit.
Verdict validate(const Word* words, std::size_t size, unsigned depth);

} // namespace voxrt::octree
