#include "query.h"

#include "levels.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace voxrt::octree {
namespace {

// Voxels by material in a box, each block once for each way in which the box cuts it.
class BoxCounter {
public:
    BoxCounter(const Memory& memory, const Box& box) : memory_(memory), box_(box) {}

    using Counts = std::array<std::uint64_t, 256>;

    void add(Word word, unsigned level, const std::array<std::int64_t, 3>& corner, Counts& counts) {
        const std::int64_t side = std::int64_t{1} << level;
        std::uint64_t volume = 1;
        unsigned cut = 0;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::int64_t low = std::max(corner[axis], box_.low[axis]);
            const std::int64_t high = std::min(corner[axis] + side, box_.high[axis]);
            if (low >= high)
                return;
            volume *= static_cast<std::uint64_t>(high - low);
            cut |= (low > corner[axis] ? 1u : 0u) << (2 * axis) | (high < corner[axis] + side ? 2u : 0u) << (2 * axis);
        }
        if (is_leaf(word)) {
            counts[material(word)] += volume;
            return;
        }
        work_.count_step();
        // The box cuts octants of one level at the same place on each axis, so these three name the answer.
        const std::uint64_t key = std::uint64_t{word} << 32 | level << 6 | cut;
        auto [entry, missing] = memo_.try_emplace(key, results_.size());
        if (missing) {
            const std::size_t result = results_.size();
            results_.emplace_back();
            Counts below{};
            for (unsigned octant = 0; octant < 8; ++octant)
                add(memory_.child(word, octant, level), level - 1, child_corner(corner, octant, side / 2), below);
            for (unsigned id = 0; id < 256; ++id)
                if (below[id] != 0)
                    results_[result].emplace_back(static_cast<std::uint8_t>(id), below[id]);
            entry = memo_.find(key);
        }
        for (const auto& [id, voxels] : results_[entry->second])
            counts[id] += voxels;
    }

private:
    Memory memory_;
    Box box_;
    std::unordered_map<std::uint64_t, std::size_t> memo_;
    std::vector<std::vector<std::pair<std::uint8_t, std::uint64_t>>> results_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

// Bounds of the solid voxels of a block relative to its corner, each block once: those of an octant twice as large are
// twice as large.
class BoundsFinder {
public:
    explicit BoundsFinder(const Memory& memory) : memory_(memory), extents_(block_count(memory.size)) {}

    // Empty where high <= low.
    Box of(Word word, unsigned level) {
        if (is_leaf(word)) {
            const std::int64_t side = std::int64_t{1} << level;
            return material(word) != 0 ? Box{{0, 0, 0}, {side, side, side}} : Box{};
        }
        memory_.child(word, 0, level); // checks the address
        const std::size_t number = block_number(word);
        if (!is_block_address(word) || number >= extents_.size())
            throw std::invalid_argument("the words are not a valid octree; validate them first");
        if (extents_[number].height == 0)
            find(number, word, level);
        const Extent& extent = extents_[number];
        if (extent.height > level)
            memory_.child(word, 0, 0); // throws: what is below does not fit
        Box bounds{};
        for (unsigned axis = 0; axis < 3 && extent.solid; ++axis) {
            bounds.low[axis] = std::int64_t{extent.low[axis]} << (level - extent.height);
            bounds.high[axis] = (std::int64_t{extent.last[axis]} + 1) << (level - extent.height);
        }
        return bounds;
    }

private:
    struct Extent { // of a block whose octants are as small as its levels allow
        std::array<std::uint16_t, 3> low{}, last{};
        std::uint8_t height = 0; // levels of the block; 0 where nothing is known yet
        bool solid = false;
    };

    void find(std::size_t number, Word word, unsigned level) {
        work_.count_step();
        unsigned height = 1;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child = memory_.child(word, octant, level);
            of(child, level - 1);
            if (!is_leaf(child))
                height = std::max(height, 1u + extents_[block_number(child)].height);
        }
        Extent found;
        found.height = static_cast<std::uint8_t>(height);
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Box child = of(memory_.child(word, octant, level), height - 1);
            if (child.high[0] == 0)
                continue;
            const std::array<std::int64_t, 3> corner = child_corner({0, 0, 0}, octant, std::int64_t{1} << (height - 1));
            for (unsigned axis = 0; axis < 3; ++axis) {
                const auto low = static_cast<std::uint16_t>(corner[axis] + child.low[axis]);
                const auto last = static_cast<std::uint16_t>(corner[axis] + child.high[axis] - 1);
                found.low[axis] = found.solid ? std::min(found.low[axis], low) : low;
                found.last[axis] = found.solid ? std::max(found.last[axis], last) : last;
            }
            found.solid = true;
        }
        extents_[number] = found;
    }

    Memory memory_;
    std::vector<Extent> extents_; // by block
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

class RegionFiller {
public:
    RegionFiller(const Memory& memory, const Box& box, std::uint8_t* materials)
        : memory_(memory), box_(box), materials_(materials), size_y_(box.high[1] - box.low[1]),
          size_z_(box.high[2] - box.low[2]) {}

    // Empty octants are skipped: the caller cleared the region.
    void fill(Word word, unsigned level, const std::array<std::int64_t, 3>& corner) {
        if (word == kEmpty)
            return;
        const std::int64_t side = std::int64_t{1} << level;
        std::array<std::int64_t, 3> low;
        std::array<std::int64_t, 3> high;
        for (unsigned axis = 0; axis < 3; ++axis) {
            low[axis] = std::max(corner[axis], box_.low[axis]) - box_.low[axis];
            high[axis] = std::min(corner[axis] + side, box_.high[axis]) - box_.low[axis];
            if (low[axis] >= high[axis])
                return;
        }
        if (!is_leaf(word)) {
            work_.count_step();
            for (unsigned octant = 0; octant < 8; ++octant)
                fill(memory_.child(word, octant, level), level - 1, child_corner(corner, octant, side / 2));
            return;
        }
        for (std::int64_t x = low[0]; x < high[0]; ++x)
            for (std::int64_t y = low[1]; y < high[1]; ++y)
                std::memset(materials_ + (x * size_y_ + y) * size_z_ + low[2], material(word),
                            static_cast<std::size_t>(high[2] - low[2]));
    }

private:
    Memory memory_;
    Box box_;
    std::uint8_t* materials_;
    std::int64_t size_y_;
    std::int64_t size_z_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

void materials_at(const Memory& memory, const std::int64_t* points, std::size_t count, std::uint8_t* materials) {
    const std::uint64_t side = std::uint64_t{1} << memory.depth;
    const Word root = memory.root();
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    for (std::size_t i = 0; i < count; ++i, points += 3) {
        work.count_step();
        const std::uint64_t x = static_cast<std::uint64_t>(points[0]);
        const std::uint64_t y = static_cast<std::uint64_t>(points[1]);
        const std::uint64_t z = static_cast<std::uint64_t>(points[2]);
        if (x >= side || y >= side || z >= side) {
            materials[i] = 0;
            continue;
        }
        Word word = root;
        for (unsigned level = memory.depth; !is_leaf(word); --level) {
            const unsigned bit = level - 1; // of the coordinates; `child` refuses a pointer at level 0
            const unsigned octant =
                level == 0 ? 0 : static_cast<unsigned>((x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2);
            word = memory.child(word, octant, level);
        }
        materials[i] = material(word);
    }
}

std::vector<std::uint64_t> leaf_counts(const Memory& memory) {
    std::vector<std::uint64_t> counts(256 * (std::size_t{memory.depth} + 1), 0);
    if (is_leaf(memory.root())) {
        counts[256 * std::size_t{memory.depth} + material(memory.root())] = 1;
        return counts;
    }
    LevelWalk walk(memory);
    std::vector<Occurrence> blocks{{memory.root(), 1}};
    for (unsigned level = memory.depth; !blocks.empty(); --level) {
        std::uint64_t* row = level > 0 ? counts.data() + 256 * std::size_t{level - 1} : nullptr; // below() refuses 0
        voxelize::count_work(4 * static_cast<std::uint32_t>(std::min<std::size_t>(blocks.size(), 1 << 24)));
        blocks = walk.below(blocks, level, [row](Word leaf, std::uint64_t octants) { row[material(leaf)] += octants; });
    }
    return counts;
}

std::array<std::uint64_t, 256> count_in_box(const Memory& memory, const Box& box) {
    std::array<std::uint64_t, 256> counts{};
    BoxCounter(memory, box).add(memory.root(), memory.depth, {0, 0, 0}, counts);
    return counts;
}

std::optional<Box> solid_bounds(const Memory& memory) {
    const Box bounds = BoundsFinder(memory).of(memory.root(), memory.depth);
    if (bounds.high[0] == 0)
        return std::nullopt;
    return bounds;
}

void fill_region(const Memory& memory, const Box& box, std::uint8_t* materials) {
    std::size_t volume = 1;
    for (unsigned axis = 0; axis < 3; ++axis)
        volume *= static_cast<std::size_t>(std::max<std::int64_t>(0, box.high[axis] - box.low[axis]));
    std::memset(materials, 0, volume);
    if (volume != 0)
        RegionFiller(memory, box, materials).fill(memory.root(), memory.depth, {0, 0, 0});
}

} // namespace voxrt::octree
