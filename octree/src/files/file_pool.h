// Blocks stored once, as in BlockPool, but in a file: memory holds a table of 8 bytes per block, two thirds full.
#pragma once

#include "../pool/block_hash.h"
#include "block_file.h"

namespace voxrt::octree {

class FilePool {
public:
    /// `folder`, `cache_bytes`: as BlockFile takes them.
    FilePool(const std::string& folder, std::size_t cache_bytes) : blocks_(folder, cache_bytes) {}

    std::size_t size() const { return blocks_.size(); }
    const Block& operator[](Word number) { return blocks_[number]; }

    /// The hash of a block; fetches its place in the table, for an intern() soon.
    std::uint64_t prepare(const Block& children) const {
        const std::uint64_t hash = block_hash(children);
#if defined(__GNUC__)
        __builtin_prefetch(&slots_[place_of(hash)]);
#endif
        return hash;
    }

    /// The node for eight children, as BlockPool::intern() gives it.
    Word intern(const Block& children) { return intern(children, block_hash(children)); }

    /// The same for a block whose hash is known.
    Word intern(const Block& children, std::uint64_t hash) {
        if (is_leaf(children[0]) && children == Block{children[0], children[0], children[0], children[0], children[0],
                                                      children[0], children[0], children[0]})
            return children[0];
        std::size_t i = place_of(hash);
        for (; slots_[i].number != kFree; i = i + 1 == slots_.size() ? 0 : i + 1)
            if (slots_[i].tag == static_cast<Word>(hash) && blocks_[slots_[i].number] == children)
                return slots_[i].number;
        if (blocks_.size() >= kBlockLimit)
            throw_too_many_blocks();
        const auto number = static_cast<Word>(blocks_.size());
        blocks_.append(children);
        slots_[i] = {static_cast<Word>(hash), number};
        if (3 * blocks_.size() > 2 * slots_.size())
            grow();
        return number;
    }

    /// Frees the table. Nothing can be interned afterwards.
    void close() { slots_ = {}; }

private:
    struct Slot {
        Word tag; // the low half of the hash; the high half tells the place
        Word number;
    };
    static constexpr Word kFree = ~Word{0};

    std::size_t place_of(std::uint64_t hash) const { return (hash >> 32) * slots_.size() >> 32; }

    // The hashes are computed again, so that the old table need not stay beside the new one.
    void grow() {
        const std::size_t places = slots_.size() * 3 / 2;
        slots_ = {};
        slots_.assign(places, Slot{0, kFree});
        for (std::size_t number = 0; number < blocks_.size(); ++number) {
            const std::uint64_t hash = block_hash(blocks_[number]);
            std::size_t i = place_of(hash);
            while (slots_[i].number != kFree)
                i = i + 1 == places ? 0 : i + 1;
            slots_[i] = {static_cast<Word>(hash), static_cast<Word>(number)};
        }
    }

    BlockFile blocks_;
    std::vector<Slot> slots_ = std::vector<Slot>(std::size_t{1} << 16, Slot{0, kFree});
};

} // namespace voxrt::octree
