// From octants in Morton order to larger ones, one pending block a level.
#pragma once

#include <utility>

#include "block_pool.h"

namespace voxrt::octree {

/// Takes disjoint octants in Morton order, of any levels; joins those below level `top` into octants of that level and
/// hands everything to `emit(level, code, node)`, in Morton order. What no octant covers is empty. Holds one unfinished
/// block a level, so memory is that of the pool alone.
template <typename Emit> class Ascent {
public:
    Ascent(BlockPool& pool, unsigned top, Emit emit) : pool_(pool), top_(top), emit_(std::move(emit)) {}

    /// `code` = Morton code of the octant's corner, divided by its volume 8**level.
    void add(unsigned level, std::uint64_t code, Node node) {
        for (unsigned lower = lowest_; lower < level && lower < top_; ++lower)
            flush(lower);
        if (level < lowest_)
            lowest_ = level;
        place(level, code, node);
    }

    /// Emits what is pending; nothing may be added afterwards.
    void finish() {
        for (unsigned level = lowest_; level < top_; ++level)
            flush(level);
    }

private:
    struct Pending {
        bool any = false;
        std::uint64_t parent = 0;
        Block children{};
    };

    void place(unsigned level, std::uint64_t code, Node node) {
        if (level >= top_) {
            emit_(level, code, node);
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
    unsigned top_;
    Emit emit_;
    unsigned lowest_ = kMaxDepth;
    std::array<Pending, kMaxDepth + 1> pending_;
};

} // namespace voxrt::octree
