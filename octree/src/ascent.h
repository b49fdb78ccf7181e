// From octants in Morton order to the root, one pending block a level.
#pragma once

#include "block_pool.h"

namespace voxrt::octree {

/// Takes the octants of a world of side 2**depth in Morton order, disjoint, of any levels; what none covers is empty.
/// Holds one unfinished block a level, so memory is that of the pool alone.
class Ascent {
public:
    Ascent(BlockPool& pool, unsigned depth) : pool_(pool), depth_(depth), root_(kEmpty) {}

    /// `code` = Morton code of the octant's corner, divided by its volume 8**level.
    void add(unsigned level, std::uint64_t code, Node node) {
        for (unsigned lower = lowest_; lower < level; ++lower)
            flush(lower);
        place(level, code, node);
        if (level < lowest_)
            lowest_ = level;
    }

    /// The root; nothing may be added afterwards.
    Node finish() {
        for (unsigned level = lowest_; level < depth_; ++level)
            flush(level);
        return root_;
    }

private:
    struct Pending {
        bool any = false;
        std::uint64_t parent = 0;
        Block children{};
    };

    void place(unsigned level, std::uint64_t code, Node node) {
        if (level == depth_) {
            root_ = node;
            return;
        }
        Pending& pending = pending_[level];
        if (!pending.any || pending.parent != code >> 3) {
            flush(level);
            pending.any = true;
            pending.parent = code >> 3;
            pending.children.fill(kEmpty);
        }
        pending.children[code & 7] = node;
    }

    void flush(unsigned level) {
        Pending& pending = pending_[level];
        if (!pending.any)
            return;
        pending.any = false;
        place(level + 1, pending.parent, pool_.intern(pending.children));
    }

    BlockPool& pool_;
    unsigned depth_;
    unsigned lowest_ = kMaxDepth;
    Node root_;
    std::array<Pending, kMaxDepth + 1> pending_;
};

} // namespace voxrt::octree
