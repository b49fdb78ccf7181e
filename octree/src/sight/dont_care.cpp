#include "dont_care.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <bit>
#include <numeric>

namespace voxrt::octree {
namespace {

// Sets of specified octants, the largest first: a block rather joins one that specifies more than it than extends one.
const std::array<std::uint8_t, 256> kLargestFirst = [] {
    std::array<std::uint8_t, 256> sets;
    std::iota(sets.begin(), sets.end(), std::uint8_t{0});
    std::stable_sort(sets.begin(), sets.end(),
                     [](std::uint8_t a, std::uint8_t b) { return std::popcount(a) > std::popcount(b); });
    return sets;
}();

unsigned specified_octants(const Block& children) {
    unsigned specified = 0;
    for (unsigned octant = 0; octant < 8; ++octant)
        specified |= unsigned{children[octant] != kAnySolid} << octant;
    return specified;
}

// Numbers of blocks: children first, lowest first, then best specified first.
std::vector<Word> order_of(const BlockPool& blocks) {
    std::vector<unsigned> heights(blocks.size());
    std::vector<unsigned> ranks(blocks.size());
    for (Word block = 0; block < blocks.size(); ++block) { // children come before their parents
        for (const Node child : blocks[block])
            if (!is_leaf(child))
                heights[block] = std::max(heights[block], heights[child] + 1);
        ranks[block] = 16 * heights[block] + 8 - std::popcount(specified_octants(blocks[block]));
    }
    std::vector<Word> order(blocks.size());
    std::iota(order.begin(), order.end(), Word{0});
    std::stable_sort(order.begin(), order.end(), [&](Word a, Word b) { return ranks[a] < ranks[b]; });
    return order;
}

} // namespace

DontCareSharing::DontCareSharing(const BlockPool& blocks) : node_of_(blocks.size()) {
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    for (const Word block : order_of(blocks)) {
        work.count_step();
        Block children = blocks[block];
        for (Node& child : children)
            child = is_leaf(child) ? child : node_of_[child];
        node_of_[block] = place(children);
    }
}

Node DontCareSharing::place(const Block& children) {
    Node only = kAnySolid;
    bool uniform = true;
    for (const Node child : children) {
        if (child == kAnySolid || child == only)
            continue;
        uniform = uniform && only == kAnySolid && is_leaf(child);
        only = child;
    }
    const MergedBlock block = describe(children);
    if (uniform && (only != kEmpty || block.specified == 0xFF))
        return only;
    if (const Word number = find_compatible(block); number != kNone)
        return number;
    merged_.push_back(block);
    enter(static_cast<Word>(merged_.size() - 1));
    return static_cast<Word>(merged_.size() - 1);
}

// The merged block that `block` joins, or kNone.
Word DontCareSharing::find_compatible(const MergedBlock& block) {
    for (const unsigned specified : kLargestFirst) {
        if (groups_[specified].empty() || (block.specified & ~specified & ~block.full) != 0)
            continue;
        add_index(specified, block.specified);
        const std::uint64_t key = key_of(block.children, specified, block.specified);
        for (Word entry = slots_[key & (slots_.size() - 1)]; entry != kNone; entry = entries_[entry].next) {
            const Word number = entries_[entry].number;
            if (entries_[entry].key != key || merged_[number].specified != specified || !merge(block, merged_[number]))
                continue;
            if (merged_[number].specified != specified) // it specifies more now
                enter(number);
            return number;
        }
    }
    return kNone;
}

DontCareSharing::MergedBlock DontCareSharing::describe(const Block& children) const {
    MergedBlock block{children, 1, static_cast<std::uint8_t>(specified_octants(children)), 0};
    for (unsigned octant = 0; octant < 8; ++octant) {
        const Node child = children[octant];
        const bool full = is_leaf(child) ? child != kEmpty : merged_[child].full == 0xFF;
        block.full |= static_cast<std::uint8_t>(unsigned{full} << octant);
        block.height = std::max(block.height, height(child) + 1);
    }
    return block;
}

// Adds what `block` specifies to `merged`, where the two are compatible. `merged` must not get higher by that: its new
// children could otherwise contain it.
bool DontCareSharing::merge(const MergedBlock& block, MergedBlock& merged) const {
    const unsigned added = block.specified & ~merged.specified;
    const unsigned filled = merged.specified & ~block.specified;
    if ((added & ~block.full) != 0 || (filled & ~merged.full) != 0)
        return false;
    for (unsigned octant = 0; octant < 8; ++octant) {
        const bool agreed = (block.specified & merged.specified) >> octant & 1;
        if (agreed && block.children[octant] != merged.children[octant])
            return false;
        if ((added >> octant & 1) && height(block.children[octant]) >= merged.height)
            return false;
    }
    for (unsigned octant = 0; octant < 8; ++octant)
        if (added >> octant & 1)
            merged.children[octant] = block.children[octant];
    merged.specified |= block.specified;
    return true;
}

// The key of the octants on which blocks that specify `query` and merged blocks that specify `specified` must agree.
std::uint64_t DontCareSharing::key_of(const Block& children, unsigned specified, unsigned query) {
    std::uint64_t hash = specified << 8 | query;
    for (unsigned octant = 0; octant < 8; ++octant)
        if ((specified & query) >> octant & 1) {
            hash = (hash ^ children[octant]) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
    hash *= 0xD6E8FEB86659FD93u;
    return hash ^ hash >> 32;
}

// Indexes the merged blocks that specify `specified` for blocks that specify `query`, the first time that one comes.
void DontCareSharing::add_index(unsigned specified, unsigned query) {
    if (has_index_[specified][query])
        return;
    has_index_[specified][query] = true;
    queries_[specified].push_back(query);
    std::erase_if(groups_[specified], [&](Word number) { return merged_[number].specified != specified; });
    for (const Word number : groups_[specified])
        enter(number, query);
}

void DontCareSharing::enter(Word number) {
    const unsigned specified = merged_[number].specified;
    groups_[specified].push_back(number);
    for (const unsigned query : queries_[specified])
        enter(number, query);
}

void DontCareSharing::enter(Word number, unsigned query) {
    const MergedBlock& merged = merged_[number];
    if ((merged.specified & ~query & ~unsigned{merged.full}) != 0)
        return;
    if (entries_.size() == slots_.size()) {
        slots_.assign(2 * slots_.size(), kNone);
        for (Word entry = 0; entry < entries_.size(); ++entry) {
            Word& slot = slots_[entries_[entry].key & (slots_.size() - 1)];
            entries_[entry].next = slot;
            slot = entry;
        }
    }
    const std::uint64_t key = key_of(merged.children, merged.specified, query);
    Word& slot = slots_[key & (slots_.size() - 1)];
    entries_.push_back({key, number, slot});
    slot = static_cast<Word>(entries_.size() - 1);
}

Node DontCareSharing::shared(Node node, Node fallback, BlockPool& pool) const {
    if (is_leaf(node))
        return node;
    std::vector<Word> order(merged_.size());
    std::iota(order.begin(), order.end(), Word{0});
    std::stable_sort(order.begin(), order.end(), [&](Word a, Word b) { return merged_[a].height < merged_[b].height; });
    std::vector<Node> result(merged_.size());
    for (const Word number : order) {
        Block children = merged_[number].children;
        const auto solid_leaf = std::find_if(children.begin(), children.end(), [](Node child) {
            return is_leaf(child) && child != kEmpty && child != kAnySolid;
        });
        const Node filling = solid_leaf == children.end() ? fallback : *solid_leaf;
        for (Node& child : children)
            child = child == kAnySolid ? filling : is_leaf(child) ? child : result[child];
        result[number] = pool.intern(children);
    }
    const Node root = node_of_[node];
    return is_leaf(root) ? root : result[root];
}

} // namespace voxrt::octree
