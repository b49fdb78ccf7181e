// Blocks some of whose octants may be any solid thing, merged where they contradict each other nowhere.
#pragma once

#include <vector>

#include "block_pool.h"

namespace voxrt::octree {

/// An octant that may be made of any solid voxels. No leaf: their third byte is 0xFF.
constexpr Node kAnySolid = 0xFFFFFE00u;

/// Finds, for blocks with octants that may be anything, few blocks that stand for all of them.
///
/// Blocks come children first, lowest and best known first. One whose known octants are one material becomes that leaf.
/// Otherwise it joins the first block that it contradicts nowhere: where both know an octant they agree, and where one
/// knows it and the other does not, what is known is solid. The block that it joins learns what it did not know. Blocks
/// are looked up by what they have to agree on, in one hash table for each pair of sets of known octants that is met,
/// so that the cost is near linear in blocks.
class DontCareSharing {
public:
    explicit DontCareSharing(const BlockPool& blocks);

    /// The node that stands for `node`, in `pool`; what is still unknown becomes like a solid leaf beside it, or
    /// `fallback`. `node` must not be kAnySolid.
    Node shared(Node node, Node fallback, BlockPool& pool) const;

private:
    struct StandIn {
        Block children;     // leaves, numbers of stand-ins, kAnySolid
        unsigned height;    // longest way down to a leaf
        std::uint8_t known; // bit i: child i is not kAnySolid
        std::uint8_t full;  // bit i: all of child i is solid
    };
    struct Entry {
        std::uint64_t key;
        Word number; // of a stand-in
        Word next;   // entry in the same slot, or kNone
    };
    static constexpr Word kNone = 0xFFFFFFFFu;

    static std::uint64_t key_of(const Block& children, unsigned known, unsigned asked);

    Node place(const Block& children);
    Word joined(const StandIn& block);
    StandIn described(const Block& children) const;
    bool joins(const StandIn& block, StandIn& stand_in) const;
    void ask(unsigned known, unsigned asked);
    void list(Word number);
    void enter(Word number, unsigned asked);
    unsigned height(Node node) const { return is_leaf(node) ? 0 : stand_ins_[node].height; }

    std::vector<Node> node_of_;        // by number of block
    std::vector<StandIn> stand_ins_;   // by number
    std::vector<Word> groups_[256];    // stand-ins by what they knew when they were listed
    std::vector<unsigned> asked_[256]; // for each: what blocks knew that have asked it
    bool is_asked_[256][256] = {};
    std::vector<Entry> entries_; // stand-ins by what they agree on with blocks that ask
    std::vector<Word> slots_ = std::vector<Word>(1 << 12, kNone);
};

} // namespace voxrt::octree
