#include "hidden.h"

#include "../build/brick.h"
#include "../pool/breadth_first.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace voxrt::octree {
namespace {

constexpr Node kSolid = leaf(1);
constexpr unsigned kBrickLevel = 3;
constexpr unsigned kCentre = 13;

// Which voxels around a solid one must be solid for it to be found.
enum class Around { all, faces };

// An octant and the 26 around it, x fastest: nodes of one level.
using Neighbourhood = std::array<Node, 27>;

// A memory with all materials replaced by one, so that neighbourhoods that are solid alike are equal.
class Solidity {
public:
    Solidity(const Memory& memory, BlockPool& pool) : memory_(memory), pool_(pool) {}

    Node node(Word word, unsigned level) {
        if (is_leaf(word))
            return material(word) == 0 ? kEmpty : kSolid;
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto entry = nodes_.find(key); entry != nodes_.end())
            return entry->second;
        work_.count_step();
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(memory_.child(word, octant, level), level - 1);
        return nodes_[key] = pool_.intern(children);
    }

private:
    Memory memory_;
    BlockPool& pool_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

// The solid voxels of a brick and of one voxel around it: a row along z for each (x, y), bit z + 1 of it for voxel z.
class Halo {
public:
    Halo(const BlockPool& pool, const Neighbourhood& around, unsigned level) : pool_(pool), side_(1 << level) {
        for (unsigned i = 0; i < 27; ++i)
            mark(around[i], level,
                 {(static_cast<int>(i % 3) - 1) * side_, (static_cast<int>(i / 3 % 3) - 1) * side_,
                  (static_cast<int>(i / 9) - 1) * side_});
    }

    // Bit z + 1 of element 8 * x + y: voxel (x, y, z) of the brick and those around it are solid.
    std::array<std::uint16_t, 64> interior(Around around) const {
        std::array<std::uint16_t, 64> result{};
        if (around == Around::faces) {
            for (int x = 0; x < side_; ++x)
                for (int y = 0; y < side_; ++y) {
                    const std::uint16_t own = rows_[row(x + 1, y + 1)];
                    result[static_cast<std::size_t>(8 * x + y)] = own & own << 1 & own >> 1 & rows_[row(x, y + 1)] &
                                                                  rows_[row(x + 2, y + 1)] & rows_[row(x + 1, y)] &
                                                                  rows_[row(x + 1, y + 2)];
                }
            return result;
        }
        std::array<std::uint16_t, kRows> z_done;
        for (unsigned i = 0; i < kRows; ++i)
            z_done[i] = rows_[i] & rows_[i] << 1 & rows_[i] >> 1;
        std::array<std::uint16_t, kRows> y_done{};
        for (int x = 0; x < side_ + 2; ++x)
            for (int y = 1; y <= side_; ++y)
                y_done[row(x, y)] = z_done[row(x, y - 1)] & z_done[row(x, y)] & z_done[row(x, y + 1)];
        for (int x = 0; x < side_; ++x)
            for (int y = 0; y < side_; ++y)
                result[static_cast<std::size_t>(8 * x + y)] =
                    y_done[row(x, y + 1)] & y_done[row(x + 1, y + 1)] & y_done[row(x + 2, y + 1)];
        return result;
    }

private:
    static constexpr std::size_t kRows = 100;

    static std::size_t row(int x, int y) { return static_cast<std::size_t>(10 * x + y); }

    // `corner` counts from the brick's lowest voxel.
    void mark(Node node, unsigned level, const std::array<int, 3>& corner) {
        if (node == kEmpty)
            return;
        const int side = 1 << level;
        std::array<int, 3> low;
        std::array<int, 3> high;
        for (unsigned axis = 0; axis < 3; ++axis) {
            low[axis] = std::max(corner[axis], -1) + 1;
            high[axis] = std::min(corner[axis] + side, side_ + 1) + 1;
            if (low[axis] >= high[axis])
                return;
        }
        if (is_leaf(node)) {
            const auto run = static_cast<std::uint16_t>((1u << high[2]) - (1u << low[2]));
            for (int x = low[0]; x < high[0]; ++x)
                for (int y = low[1]; y < high[1]; ++y)
                    rows_[row(x, y)] |= run;
            return;
        }
        for (int octant = 0; octant < 8; ++octant)
            mark(pool_[node][static_cast<std::size_t>(octant)], level - 1,
                 {corner[0] + (octant & 1) * side / 2, corner[1] + (octant >> 1 & 1) * side / 2,
                  corner[2] + (octant >> 2) * side / 2});
    }

    const BlockPool& pool_;
    int side_;
    std::array<std::uint16_t, kRows> rows_{};
};

class HiddenFinder {
public:
    HiddenFinder(const BlockPool& solid, Around around)
        : solid_(solid), wanted_(around), cache_bits_(cache_bits(solid.size())), cache_(std::size_t{1} << cache_bits_) {
    }

    Words words(Node root, unsigned depth) {
        Neighbourhood world;
        world.fill(kEmpty);
        world[kCentre] = root;
        return breadth_first_words(pool_, visit(world, depth));
    }

private:
    struct Entry {
        Neighbourhood around{};
        unsigned level = 0; // 0 marks a free entry
        Node node = 0;
    };

    // A small memory must not pay for the clearing of a large cache. A block is met with a few neighbourhoods.
    static unsigned cache_bits(std::size_t blocks) {
        return std::clamp(static_cast<unsigned>(std::bit_width(blocks)) + 4, 6u, 15u);
    }

    Node visit(const Neighbourhood& around, unsigned level) {
        if (around[kCentre] == kEmpty)
            return kEmpty;
        if (std::all_of(around.begin(), around.end(), [](Node node) { return node == kSolid; }))
            return kSolid;
        work_.count_step();
        Entry& entry = cache_[slot_of(around, level)];
        if (entry.level == level && entry.around == around)
            return entry.node;
        Node node;
        if (level <= kBrickLevel) {
            node = brick(Halo(solid_, around, level).interior(wanted_), level);
        } else {
            Block children;
            for (unsigned octant = 0; octant < 8; ++octant)
                children[octant] = visit(around_child(around, octant), level - 1);
            node = pool_.intern(children);
        }
        entry = {around, level, node}; // the recursion may have used the entry; the last to finish keeps it
        return node;
    }

    // Along an axis, the children of three octants count -1 ... 4 from the first child of the middle one, 0 and 1.
    Neighbourhood around_child(const Neighbourhood& around, unsigned octant) const {
        Neighbourhood result;
        for (unsigned i = 0; i < 27; ++i) {
            const unsigned x = i % 3 + (octant & 1) + 1;
            const unsigned y = i / 3 % 3 + (octant >> 1 & 1) + 1;
            const unsigned z = i / 9 + (octant >> 2) + 1;
            const Node parent = around[x / 2 + 3 * (y / 2) + 9 * (z / 2)];
            result[i] = is_leaf(parent) ? parent : solid_[parent][(x & 1) | (y & 1) << 1 | (z & 1) << 2];
        }
        return result;
    }

    Node brick(const std::array<std::uint16_t, 64>& interior, unsigned level) {
        std::uint64_t mask[8] = {};
        for (unsigned x = 0; x < 8; ++x)
            for (unsigned y = 0; y < 8; ++y)
                for (unsigned row = interior[8 * x + y] >> 1; row != 0; row &= row - 1) {
                    const unsigned z = static_cast<unsigned>(std::countr_zero(row));
                    const unsigned code = spread(x) | spread(y) << 1 | spread(z) << 2;
                    mask[code / 64] |= std::uint64_t{1} << (code % 64);
                }
        switch (level) {
        case 1:
            return bricks_.from_mask8(static_cast<std::uint8_t>(mask[0]), 1);
        case 2:
            return bricks_.from_mask64(mask[0], 1);
        default:
            return bricks_.from_mask(mask, 1);
        }
    }

    // Bit k of three at bit 3k.
    static constexpr unsigned spread(unsigned value) { return (value & 1) | (value & 2) << 2 | (value & 4) << 4; }

    std::size_t slot_of(const Neighbourhood& around, unsigned level) const {
        std::uint64_t hash = level;
        for (const Node node : around) {
            hash = (hash ^ node) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash * 0x9E3779B97F4A7C15u >> (64 - cache_bits_));
    }

    const BlockPool& solid_;
    const Around wanted_;
    BlockPool pool_;
    BrickBuilder bricks_{pool_};
    unsigned cache_bits_;
    std::vector<Entry> cache_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

Words voxels_within(const Memory& memory, Around around) {
    BlockPool solid;
    const Node root = Solidity(memory, solid).node(memory.root(), memory.depth);
    return HiddenFinder(solid, around).words(root, memory.depth);
}

} // namespace

Words hidden_voxels(const Memory& memory) { return voxels_within(memory, Around::all); }

Words covered_voxels(const Memory& memory) { return voxels_within(memory, Around::faces); }

std::unordered_map<Word, std::uint64_t> hidden_octants(const Memory& memory, const Memory& hidden, unsigned level) {
    std::unordered_map<std::uint64_t, std::uint64_t> pairs{{std::uint64_t{memory.root()} << 32 | hidden.root(), 1}};
    for (unsigned above = memory.depth; above > level; --above) {
        std::unordered_map<std::uint64_t, std::uint64_t> below;
        for (const auto& [pair, octants] : pairs) {
            const Word word = static_cast<Word>(pair >> 32);
            const Word hidden_word = static_cast<Word>(pair);
            if (is_leaf(word) || hidden_word == kEmpty)
                continue;
            for (unsigned octant = 0; octant < 8; ++octant) {
                const Word child = is_leaf(hidden_word) ? hidden_word : hidden.child(hidden_word, octant, above);
                below[std::uint64_t{memory.child(word, octant, above)} << 32 | child] += octants;
            }
        }
        pairs = std::move(below);
    }
    std::unordered_map<Word, std::uint64_t> result;
    for (const auto& [pair, octants] : pairs)
        if (const Word hidden_word = static_cast<Word>(pair); is_leaf(hidden_word) && hidden_word != kEmpty)
            result[static_cast<Word>(pair >> 32)] += octants;
    return result;
}

} // namespace voxrt::octree
