#include "dont_care.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "interrupt.h"

namespace voxrt::octree {
namespace {

// Sets of known octants, the largest first: a block joins another that knows more than it rather than teach one.
const std::array<std::uint8_t, 256> kLargestFirst = [] {
    std::array<std::uint8_t, 256> sets;
    std::iota(sets.begin(), sets.end(), std::uint8_t{0});
    std::stable_sort(sets.begin(), sets.end(),
                     [](std::uint8_t a, std::uint8_t b) { return std::popcount(a) > std::popcount(b); });
    return sets;
}();

unsigned known_octants(const Block& children) {
    unsigned known = 0;
    for (unsigned octant = 0; octant < 8; ++octant)
        known |= unsigned{children[octant] != kAnySolid} << octant;
    return known;
}

// Numbers of blocks: children first, lowest first, then best known first.
std::vector<Word> order_of(const BlockPool& blocks) {
    std::vector<unsigned> heights(blocks.size());
    std::vector<unsigned> ranks(blocks.size());
    for (Word block = 0; block < blocks.size(); ++block) { // children come before their parents
        for (const Node child : blocks[block])
            if (!is_leaf(child))
                heights[block] = std::max(heights[block], heights[child] + 1);
        ranks[block] = 16 * heights[block] + 8 - std::popcount(known_octants(blocks[block]));
    }
    std::vector<Word> order(blocks.size());
    std::iota(order.begin(), order.end(), Word{0});
    std::stable_sort(order.begin(), order.end(), [&](Word a, Word b) { return ranks[a] < ranks[b]; });
    return order;
}

} // namespace

DontCareSharing::DontCareSharing(const BlockPool& blocks) : node_of_(blocks.size()) {
    Interrupt interrupt;
    for (const Word block : order_of(blocks)) {
        interrupt.poll();
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
    const StandIn block = described(children);
    if (uniform && (only != kEmpty || block.known == 0xFF))
        return only;
    if (const Word number = joined(block); number != kNone)
        return number;
    stand_ins_.push_back(block);
    list(static_cast<Word>(stand_ins_.size() - 1));
    return static_cast<Word>(stand_ins_.size() - 1);
}

// The stand-in that `block` joins, or kNone.
Word DontCareSharing::joined(const StandIn& block) {
    for (const unsigned known : kLargestFirst) {
        if (groups_[known].empty() || (block.known & ~known & ~block.full) != 0)
            continue;
        ask(known, block.known);
        const std::uint64_t key = key_of(block.children, known, block.known);
        for (Word entry = slots_[key & (slots_.size() - 1)]; entry != kNone; entry = entries_[entry].next) {
            const Word number = entries_[entry].number;
            if (entries_[entry].key != key || stand_ins_[number].known != known || !joins(block, stand_ins_[number]))
                continue;
            if (stand_ins_[number].known != known) // it learned
                list(number);
            return number;
        }
    }
    return kNone;
}

DontCareSharing::StandIn DontCareSharing::described(const Block& children) const {
    StandIn block{children, 1, static_cast<std::uint8_t>(known_octants(children)), 0};
    for (unsigned octant = 0; octant < 8; ++octant) {
        const Node child = children[octant];
        const bool full = is_leaf(child) ? child != kEmpty : stand_ins_[child].full == 0xFF;
        block.full |= static_cast<std::uint8_t>(unsigned{full} << octant);
        block.height = std::max(block.height, height(child) + 1);
    }
    return block;
}

// Teaches `stand_in` what `block` knows where that contradicts nothing. It may not grow higher by that: what it learns
// could otherwise have it for a part.
bool DontCareSharing::joins(const StandIn& block, StandIn& stand_in) const {
    const unsigned taught = block.known & ~stand_in.known;
    const unsigned filled = stand_in.known & ~block.known;
    if ((taught & ~block.full) != 0 || (filled & ~stand_in.full) != 0)
        return false;
    for (unsigned octant = 0; octant < 8; ++octant) {
        const bool agreed = (block.known & stand_in.known) >> octant & 1;
        if (agreed && block.children[octant] != stand_in.children[octant])
            return false;
        if ((taught >> octant & 1) && height(block.children[octant]) >= stand_in.height)
            return false;
    }
    for (unsigned octant = 0; octant < 8; ++octant)
        if (taught >> octant & 1)
            stand_in.children[octant] = block.children[octant];
    stand_in.known |= block.known;
    return true;
}

// What blocks that know `asked` and stand-ins that know `known` have to agree on.
std::uint64_t DontCareSharing::key_of(const Block& children, unsigned known, unsigned asked) {
    std::uint64_t hash = known << 8 | asked;
    for (unsigned octant = 0; octant < 8; ++octant)
        if ((known & asked) >> octant & 1) {
            hash = (hash ^ children[octant]) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
    hash *= 0xD6E8FEB86659FD93u;
    return hash ^ hash >> 32;
}

// Enters the stand-ins that know `known` for blocks that know `asked`, the first time that one does.
void DontCareSharing::ask(unsigned known, unsigned asked) {
    if (is_asked_[known][asked])
        return;
    is_asked_[known][asked] = true;
    asked_[known].push_back(asked);
    std::erase_if(groups_[known], [&](Word number) { return stand_ins_[number].known != known; });
    for (const Word number : groups_[known])
        enter(number, asked);
}

void DontCareSharing::list(Word number) {
    const unsigned known = stand_ins_[number].known;
    groups_[known].push_back(number);
    for (const unsigned asked : asked_[known])
        enter(number, asked);
}

void DontCareSharing::enter(Word number, unsigned asked) {
    const StandIn& stand_in = stand_ins_[number];
    if ((stand_in.known & ~asked & ~unsigned{stand_in.full}) != 0)
        return;
    if (entries_.size() == slots_.size()) {
        slots_.assign(2 * slots_.size(), kNone);
        for (Word entry = 0; entry < entries_.size(); ++entry) {
            Word& slot = slots_[entries_[entry].key & (slots_.size() - 1)];
            entries_[entry].next = slot;
            slot = entry;
        }
    }
    const std::uint64_t key = key_of(stand_in.children, stand_in.known, asked);
    Word& slot = slots_[key & (slots_.size() - 1)];
    entries_.push_back({key, number, slot});
    slot = static_cast<Word>(entries_.size() - 1);
}

Node DontCareSharing::shared(Node node, Node fallback, BlockPool& pool) const {
    if (is_leaf(node))
        return node;
    std::vector<Word> order(stand_ins_.size());
    std::iota(order.begin(), order.end(), Word{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Word a, Word b) { return stand_ins_[a].height < stand_ins_[b].height; });
    std::vector<Node> result(stand_ins_.size());
    for (const Word number : order) {
        Block children = stand_ins_[number].children;
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
