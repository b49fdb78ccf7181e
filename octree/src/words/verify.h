// Memories that may be read without checks: the ray tracer's fast path.
#pragma once

#include "memory.h"

namespace voxrt::octree {

/// A memory that was verified: every path from word 0 ends in a leaf within `depth` levels, every pointer on a path is
/// 1 + 8k, and its block lies inside the memory. So a reader that starts at word 0 needs no check. The words are
/// borrowed: they must neither change nor be freed as long as a copy of this is in use.
class VerifiedMemory {
public:
    /// Throws std::invalid_argument, with the address of the word, where `memory` is not so. Blocks that no path
    /// reaches may hold anything. Linear in the blocks where each is reached at one level only, else in blocks times
    /// levels.
    explicit VerifiedMemory(const Memory& memory);

    const Memory& memory() const { return memory_; }
    const Word* words() const { return memory_.words; }
    unsigned depth() const { return memory_.depth; }

private:
    Memory memory_;
};

} // namespace voxrt::octree
