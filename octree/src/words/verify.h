// Memories that may be read without checks: the ray tracer's fast path.
#pragma once

#include "memory.h"

namespace voxrt::octree {

/// A memory that was verified: every path from its root ends in a leaf within `depth` levels, every pointer on a path
/// is 1 + 8k, and its block lies inside the memory. So a reader that starts at the root needs no check. The words are
/// borrowed: they must neither change nor be freed as long as a copy of this is in use.
class VerifiedMemory {
public:
    /// Throws std::invalid_argument, with the address of the word, where `memory` is not so. Blocks that no path
    /// reaches may hold anything. Linear in the blocks where each is reached at one level only, else in blocks times
    /// levels.
    explicit VerifiedMemory(const Memory& memory);

    /// A memory that is so because of how its words were made.
    static VerifiedMemory trusted(const Memory& memory) { return VerifiedMemory(memory, Trusted()); }

    const Memory& memory() const { return memory_; }
    const Word* words() const { return memory_.words; }
    Word root() const { return root_; }
    unsigned depth() const { return memory_.depth; }

private:
    struct Trusted {};
    VerifiedMemory(const Memory& memory, Trusted) : memory_(memory), root_(memory.root()) {}

    Memory memory_;
    Word root_;
};

} // namespace voxrt::octree
