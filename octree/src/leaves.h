// The leaves of a memory, a chunk at a time.
#pragma once

#include <vector>

#include "query.h"

namespace voxrt::octree {

/// One leaf: the corner of its octant, log2 of its side in voxels, its material.
struct Leaf {
    std::array<std::int32_t, 3> corner;
    std::uint8_t level;
    std::uint8_t material;
};

/// Walks the leaves that overlap a box, whole and in Morton order. Holds a path and no more, however many leaves there
/// are.
class LeafWalk {
public:
    /// `memory` must outlive the walk; `solid_only` leaves empty space out.
    LeafWalk(const Memory& memory, const Box& box, bool solid_only);

    /// At most `limit` further leaves; none at the end.
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
