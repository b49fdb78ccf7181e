#include "pieces.h"

#include "../pool/breadth_first.h"
#include "shapes.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace voxrt::octree {
namespace {

class Cutting {
public:
    Cutting(const Memory& memory, const Box& box, const std::array<std::uint8_t, 256>& materials, BlockPool& pool,
            std::size_t most)
        : memory_(memory), box_(box), materials_(materials), pool_(pool), left_(most) {}

    Node node(Word word, unsigned level, const Place& corner) {
        const Cover covered = word == kEmpty ? Cover::none : cover(box_, corner, level);
        if (covered == Cover::none)
            return kEmpty;
        if (covered == Cover::all)
            return whole(word, level);
        count_step();
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(is_leaf(word) ? word : memory_.child(word, octant, level), level - 1,
                                    child_corner(corner, octant, std::int64_t{1} << (level - 1)));
        return pool_.intern(children);
    }

private:
    Node whole(Word word, unsigned level) {
        if (is_leaf(word))
            return leaf(materials_[material(word)]);
        if (const auto entry = whole_.find(word); entry != whole_.end())
            return entry->second;
        count_step();
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = whole(memory_.child(word, octant, level), level - 1);
        return whole_[word] = pool_.intern(children);
    }

    void count_step() {
        voxelize::WorkCounter::current().count_step();
        if (left_-- == 0)
            throw std::length_error("the box has too many different octants");
    }

    Memory memory_;
    const Box& box_;
    const std::array<std::uint8_t, 256>& materials_;
    BlockPool& pool_;
    std::size_t left_; // octants that may be looked into
    std::unordered_map<Word, Node> whole_;
};

class Turning {
public:
    explicit Turning(BlockPool& pool) : pool_(pool) {}

    Node quarter(Node node) {
        if (is_leaf(node))
            return node;
        if (const auto entry = turned_.find(node); entry != turned_.end())
            return entry->second;
        voxelize::WorkCounter::current().count_step();
        const Block before = pool_[node]; // the pool may grow
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const unsigned x = octant & 1, y = octant >> 1 & 1, z = octant >> 2;
            children[z | y << 1 | (1 - x) << 2] = quarter(before[octant]);
        }
        return turned_[node] = pool_.intern(children);
    }

private:
    BlockPool& pool_;
    std::unordered_map<Node, Node> turned_;
};

struct BlockHash {
    std::size_t operator()(const Block& block) const { return block_hash(block); }
};

// Eight octants of the source, as the octants of a block; the result's octant begins in the first of them.
class Moving {
public:
    Moving(const std::array<std::int64_t, 3>& distance, BlockPool& pool) : distance_(distance), pool_(pool) {}

    Node node(const Block& around, unsigned level) {
        const std::int64_t inside = (std::int64_t{1} << level) - 1;
        if (((distance_[0] | distance_[1] | distance_[2]) & inside) == 0)
            return around[0];
        if (is_leaf(around[0]) && is_uniform(around))
            return around[0];
        std::unordered_map<Block, Node, BlockHash>& known = moved_[level];
        if (const auto entry = known.find(around); entry != known.end())
            return entry->second;
        voxelize::WorkCounter::current().count_step();
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(around_child(around, octant, level), level - 1);
        return known[around] = pool_.intern(children);
    }

private:
    // The children of the eight are four per axis; the result's child begins in number 0, 1 or 2 of these.
    Block around_child(const Block& around, unsigned child, unsigned level) const {
        Block found;
        for (unsigned octant = 0; octant < 8; ++octant) {
            unsigned parent = 0, part = 0;
            for (unsigned axis = 0; axis < 3; ++axis) {
                const auto carry = static_cast<unsigned>(-distance_[axis] >> (level - 1) & 1);
                const unsigned number = (child >> axis & 1) + (octant >> axis & 1) + carry;
                parent |= number / 2 << axis;
                part |= number % 2 << axis;
            }
            found[octant] = is_leaf(around[parent]) ? around[parent] : pool_[around[parent]][part];
        }
        return found;
    }

    std::array<std::int64_t, 3> distance_;
    BlockPool& pool_;
    std::array<std::unordered_map<Block, Node, BlockHash>, kMaxDepth + 2> moved_;
};

// The octant of `level` at `place`, counted in octants of that level; empty outside of the world.
Node octant_of(const BlockPool& pool, Node root, unsigned depth, const Place& place, unsigned level) {
    const std::int64_t side = std::int64_t{1} << (depth - level);
    if (std::min({place[0], place[1], place[2]}) < 0 || std::max({place[0], place[1], place[2]}) >= side)
        return kEmpty;
    for (unsigned above = depth; above > level && !is_leaf(root); --above) {
        const unsigned bit = above - 1 - level;
        root = pool[root][static_cast<unsigned>((place[0] >> bit & 1) | (place[1] >> bit & 1) << 1 |
                                                (place[2] >> bit & 1) << 2)];
    }
    return root;
}

} // namespace

Node cut_out(const Memory& memory, const Box& box, const std::array<std::uint8_t, 256>& materials, BlockPool& pool,
             std::size_t most) {
    return Cutting(memory, box, materials, pool, most).node(memory.root(), memory.depth, {0, 0, 0});
}

Copied copied(const Memory& memory, const Box& box, const std::array<std::uint8_t, 256>& materials, std::size_t most) {
    unsigned depth = 1;
    for (unsigned axis = 0; axis < 3; ++axis)
        while (std::int64_t{1} << depth < box.high[axis] - box.low[axis])
            ++depth;
    BlockPool pool;
    const Node part = cut_out(memory, box, materials, pool, most);
    const Node node = moved(part, memory.depth, {-box.low[0], -box.low[1], -box.low[2]}, depth, pool);
    return {breadth_first_words(pool, node), depth};
}

Node turned(Node root, unsigned quarters, BlockPool& pool) {
    Turning turning(pool);
    for (unsigned turn = 0; turn < quarters % 4; ++turn)
        root = turning.quarter(root);
    return root;
}

Node moved(Node root, unsigned depth, const std::array<std::int64_t, 3>& distance, unsigned new_depth,
           BlockPool& pool) {
    for (; depth < new_depth; ++depth)
        root = pool.intern({root, kEmpty, kEmpty, kEmpty, kEmpty, kEmpty, kEmpty, kEmpty});
    Block around;
    for (unsigned octant = 0; octant < 8; ++octant) {
        Place place;
        for (unsigned axis = 0; axis < 3; ++axis)
            place[axis] = (-distance[axis] >> new_depth) + (octant >> axis & 1);
        around[octant] = octant_of(pool, root, depth, place, new_depth);
    }
    return Moving(distance, pool).node(around, new_depth);
}

} // namespace voxrt::octree
