// The leaves of a memory, one chunk at a time.
#pragma once

#include "query.h"

#include <vector>

namespace voxrt::octree {

/// One leaf: the corner of its octant, log2 of its side in voxels, its material.
struct Leaf {
    std::array<std::int32_t, 3> corner;
    std::uint8_t level;
    std::uint8_t material;
};

/// Walks the leaves that overlap a box, whole (not clipped) and in Morton order. Holds one path from the root, however
/// many leaves there are.
class LeafWalk {
public:
    /// The words of `memory` must outlive the walk. `solid_only` leaves empty leaves out.
    LeafWalk(const Memory& memory, const Box& box, bool solid_only);

    /// The next leaves, at most `limit`; none at the end. Throws std::invalid_argument where the words are no octree.
    std::vector<Leaf> next(std::size_t limit);

private:
    struct Step {
        Word word;
        std::uint8_t level;
        std::array<std::int64_t, 3> corner;
    };

    Memory memory_;
    Box box_;
    bool solid_only_;
    std::vector<Step> stack_;
};

} // namespace voxrt::octree
