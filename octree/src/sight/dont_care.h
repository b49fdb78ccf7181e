// Merging of blocks that agree wherever both are specified: sharing with don't-cares.
#pragma once

#include "../pool/block_pool.h"

#include <vector>

namespace voxrt::octree {

/// A don't-care: an octant that may be made of any solid voxels. It is no leaf, and no number of a block.
constexpr Node kAnySolid = kTag - 0x100;

/// Merges blocks with don't-care octants into few blocks (interior.h names the problem and its source).
///
/// Blocks are taken children first, then the lowest and best specified first. One whose specified octants are all one
/// material becomes that leaf. Otherwise it joins the first merged block that it is compatible with: octants that both
/// specify are equal, and octants that one of them specifies are solid. The merged block then specifies those too.
/// Blocks are found by the octants that they have to agree on, in a hash table with an index per pair of sets of
/// specified octants that occurs. So the cost is near linear in the blocks.
class DontCareSharing {
public:
    explicit DontCareSharing(const BlockPool& blocks);

    /// The node in `pool` that `node` became. What is still unspecified becomes like a solid leaf beside it, or
    /// `fallback`. `node` must not be kAnySolid.
    Node shared(Node node, Node fallback, BlockPool& pool) const;

private:
    struct MergedBlock {
        Block children;         // leaves, numbers of merged blocks, kAnySolid
        unsigned height;        // longest path down to a leaf
        std::uint8_t specified; // bit i: child i is not kAnySolid
        std::uint8_t full;      // bit i: all of child i is solid
    };
    struct Entry {
        std::uint64_t key;
        Word number; // of a merged block
        Word next;   // entry in the same slot, or kNone
    };
    static constexpr Word kNone = ~Word{0};

    static std::uint64_t key_of(const Block& children, unsigned specified, unsigned query);

    Node place(const Block& children);
    Word find_compatible(const MergedBlock& block);
    MergedBlock describe(const Block& children) const;
    bool merge(const MergedBlock& block, MergedBlock& merged) const;
    void add_index(unsigned specified, unsigned query);
    void enter(Word number);
    void enter(Word number, unsigned query);
    unsigned height(Node node) const { return is_leaf(node) ? 0 : merged_[node].height; }

    std::vector<Node> node_of_;          // by number of block
    std::vector<MergedBlock> merged_;    // by number
    std::vector<Word> groups_[256];      // merged blocks by what they specified when they were entered
    std::vector<unsigned> queries_[256]; // for each such set: the sets of the blocks that were compared with it
    bool has_index_[256][256] = {};
    std::vector<Entry> entries_; // merged blocks by key_of
    std::vector<Word> slots_ = std::vector<Word>(1 << 12, kNone);
};

} // namespace voxrt::octree
