#include "diff.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <bit>

namespace voxrt::octree {
namespace {

// Counts and bounds (relative to the octant's corner) of a pair of octants.
struct Pair {
    std::uint64_t appeared = 0;
    std::uint64_t vanished = 0;
    std::uint64_t recoloured = 0;
    std::array<std::int32_t, 3> low{};
    std::array<std::int32_t, 3> high{};

    bool differs() const { return high[0] != 0; }
};

class Comparison {
public:
    Comparison(const Memory& first, const Memory& second)
        : first_(first), second_(second), cache_bits_(cache_bits(first.size + second.size)),
          cache_(std::size_t{1} << cache_bits_) {}

    Pair of(Word a, Word b, unsigned level) {
        if (is_leaf(a) && is_leaf(b))
            return leaves(material(a), material(b), level);
        work_.count_step();
        const std::uint64_t key = (std::uint64_t{a} << 32 | b) ^ std::uint64_t{level} << 27;
        Entry& entry = cache_[(key * 0x9E3779B97F4A7C15u) >> (64 - cache_bits_)];
        if (entry.level == level && entry.a == a && entry.b == b)
            return entry.pair;
        Pair sum;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child_a = is_leaf(a) ? a : first_.child(a, octant, level);
            const Word child_b = is_leaf(b) ? b : second_.child(b, octant, level);
            merge(sum, of(child_a, child_b, level - 1), octant, std::int32_t{1} << (level - 1));
        }
        entry = {a, b, level, sum}; // the recursion may have used the entry; the last to finish keeps it
        return sum;
    }

private:
    struct Entry {
        Word a = 0;
        Word b = 0;
        unsigned level = 0; // 0 marks a free entry: pairs of voxels are leaves and never looked up
        Pair pair;
    };

    // A small memory must not pay for the clearing of a large cache.
    static unsigned cache_bits(std::size_t words) {
        return std::clamp(static_cast<unsigned>(std::bit_width(words)) + 2, 6u, 18u);
    }

    static Pair leaves(std::uint8_t a, std::uint8_t b, unsigned level) {
        Pair pair;
        if (a == b)
            return pair;
        (a == 0 ? pair.appeared : b == 0 ? pair.vanished : pair.recoloured) = voxels_at(level);
        pair.high.fill(std::int32_t{1} << level);
        return pair;
    }

    static void merge(Pair& sum, const Pair& child, unsigned octant, std::int32_t half) {
        if (!child.differs())
            return;
        const bool first = !sum.differs();
        sum.appeared += child.appeared;
        sum.vanished += child.vanished;
        sum.recoloured += child.recoloured;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::int32_t corner = static_cast<std::int32_t>(octant >> axis & 1) * half;
            sum.low[axis] = first ? corner + child.low[axis] : std::min(sum.low[axis], corner + child.low[axis]);
            sum.high[axis] = first ? corner + child.high[axis] : std::max(sum.high[axis], corner + child.high[axis]);
        }
    }

    Memory first_;
    Memory second_;
    unsigned cache_bits_;
    std::vector<Entry> cache_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

Difference diff(const Memory& first, const Memory& second) {
    if (first.depth != second.depth)
        throw std::invalid_argument("octrees of different depths cannot be compared voxel by voxel");
    const Pair pair = Comparison(first, second).of(first.root(), second.root(), first.depth);
    Difference difference{pair.appeared, pair.vanished, pair.recoloured, std::nullopt};
    if (pair.differs())
        difference.bounds = Box{{pair.low[0], pair.low[1], pair.low[2]}, {pair.high[0], pair.high[1], pair.high[2]}};
    return difference;
}

} // namespace voxrt::octree
