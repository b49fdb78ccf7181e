// Octants in Morton order to one octree, from the leaves up.
#pragma once

#include "../pool/block_pool.h"

#include <utility>

namespace voxrt::octree {

/// Takes disjoint octants in Morton order, of any levels. Joins those below level `top` into octants of that level and
/// calls emit(level, code, node) for each octant of level `top` or above, in Morton order. What no octant covers is
/// empty. `Pool`: BlockPool or SharedBlockPool::Writer. Holds one unfinished block per level; all other memory is that
/// of the pool. Linear in octants and blocks.
template <typename Pool, typename Emit> class OctreeBuilder {
public:
    OctreeBuilder(Pool& pool, unsigned top, Emit emit) : pool_(pool), top_(top), emit_(std::move(emit)) {}

    /// Adds an octant. `code` = Morton code of its lowest corner, divided by its volume 8**level.
    void add(unsigned level, std::uint64_t code, Node node) {
        for (unsigned lower = lowest_; lower < level && lower < top_; ++lower)
            flush(lower);
        if (level < lowest_)
            lowest_ = level;
        place(level, code, node);
    }

    /// Emits what is unfinished. Nothing may be added afterwards.
    void finish() {
        for (unsigned level = lowest_; level < top_; ++level)
            flush(level);
    }

private:
    struct Unfinished {
        bool any = false;
        std::uint64_t parent = 0;
        Block children{};
    };

    void place(unsigned level, std::uint64_t code, Node node) {
        if (level >= top_) {
            emit_(level, code, node);
            return;
        }
        Unfinished& block = unfinished_[level];
        if (!block.any || block.parent != code >> 3) {
            flush(level);
            block.any = true;
            block.parent = code >> 3;
            block.children.fill(kEmpty);
        }
        block.children[code & 7] = node;
    }

    void flush(unsigned level) {
        Unfinished& block = unfinished_[level];
        if (!block.any)
            return;
        block.any = false;
        place(level + 1, block.parent, pool_.intern(block.children));
    }

    Pool& pool_;
    unsigned top_;
    Emit emit_;
    unsigned lowest_ = kMaxDepth;
    std::array<Unfinished, kMaxDepth + 1> unfinished_;
};

} // namespace voxrt::octree
