// A flat hash table from voxels (a 64-bit pattern, and the kind of pattern) to their node.
#pragma once

#include "block_pool.h"

#include <cstdint>
#include <vector>

namespace voxrt::octree {

/// Memoizes nodes by their voxels. Pattern 0 (nothing solid) is not a key.
class NodeMemo {
public:
    /// The node of (`pattern`, `kind`), made by `make()` the first time.
    template <typename Make> Node get(std::uint64_t pattern, Word kind, Make make) {
        std::size_t i = slot_of(pattern, kind);
        for (; entries_[i].pattern != 0; i = (i + 1) & (entries_.size() - 1))
            if (entries_[i].pattern == pattern && entries_[i].kind == kind)
                return entries_[i].node;
        const Node node = make();
        entries_[i] = {pattern, kind, node};
        if (2 * ++count_ > entries_.size())
            grow();
        return node;
    }

private:
    struct Entry {
        std::uint64_t pattern = 0; // 0 marks a free entry
        Word kind = 0;
        Node node = 0;
    };

    std::size_t slot_of(std::uint64_t pattern, Word kind) const {
        const std::uint64_t mixed = (pattern ^ std::uint64_t{kind} << 55) * 0x9E3779B97F4A7C15u;
        return ((mixed ^ mixed >> 32) * 0xD6E8FEB86659FD93u >> 32) & (entries_.size() - 1);
    }

    void grow() {
        std::vector<Entry> old(2 * entries_.size());
        old.swap(entries_);
        for (const Entry& entry : old) {
            if (entry.pattern == 0)
                continue;
            std::size_t i = slot_of(entry.pattern, entry.kind);
            while (entries_[i].pattern != 0)
                i = (i + 1) & (entries_.size() - 1);
            entries_[i] = entry;
        }
    }

    std::vector<Entry> entries_ = std::vector<Entry>(1 << 12);
    std::size_t count_ = 0;
};

} // namespace voxrt::octree
