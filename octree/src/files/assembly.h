// Memories of one world that hold its parts, joined to the memory of the whole.
//
//     Assembly whole(depth);
//     for (const VoxelsView& part : parts)       // disjoint, such as the blocks of voxelize_in_blocks()
//         whole.add(build(part, threads));
//     const Words words = whole.words(); // the same bytes as of all voxels at once
//
// Equal blocks are stored once whichever part they come from, so memory grows with what is new in each part. The parts
// meet in few octants, high up; all below is taken over block by block, each once per part.
#pragma once

#include "../pool/block_pool.h"
#include "../words/memory.h"

#include <cstddef>
#include <vector>

namespace voxrt::octree {

class Assembly {
public:
    /// An empty world of `depth` levels, 1 … kMaxDepth. Makes room for `expected_blocks` at once.
    explicit Assembly(unsigned depth, std::size_t expected_blocks = 512) : pool_(expected_blocks), depth_(depth) {}

    /// Adds a part: `size` words of an octree of the same depth. Its solid octants must be empty so far. Throws
    /// std::invalid_argument where they are not or the words are no octree, std::length_error as BlockPool does.
    void add(const Word* words, std::size_t size);

    /// The words of the world so far, breadth-first.
    Words words() const;

private:
    BlockPool pool_;
    unsigned depth_;
    Node root_ = kEmpty;
};

} // namespace voxrt::octree
