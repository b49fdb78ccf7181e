#include "regions.h"

#include "../build/coarsen.h"
#include "diff.h"
#include "leaves.h"

#include <voxrt/voxelize/grid/morton.h>
#include <voxrt/voxelize/work/disjoint_sets.h>
#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace voxrt::octree {
namespace {

enum Kind : std::uint8_t { kAppeared, kVanished, kRecoloured };

// Collects the octants that differ throughout, in Morton order; `material` is the kind. Both memories share a pool, so
// what is equal has one node and is never looked into.
class DifferenceWalk {
public:
    DifferenceWalk(const Memory& first, const Memory& second)
        : first_(coarsen(first, 0, pool_)), second_(coarsen(second, 0, pool_)) {}

    // False where there are more than `limit`.
    bool collect(unsigned depth, std::size_t limit) {
        limit_ = limit;
        return visit(first_, second_, depth, {0, 0, 0});
    }

    std::vector<Leaf> leaves;

private:
    bool visit(Node a, Node b, unsigned level, const std::array<std::int32_t, 3>& corner) {
        if (a == b)
            return true;
        work_.count_step();
        if (is_leaf(a) && is_leaf(b)) {
            const Kind kind = a == kEmpty ? kAppeared : b == kEmpty ? kVanished : kRecoloured;
            leaves.push_back({corner, static_cast<std::uint8_t>(level), kind});
            return leaves.size() <= limit_;
        }
        const std::int32_t half = std::int32_t{1} << (level - 1);
        for (unsigned octant = 0; octant < 8; ++octant) {
            const auto place = [&](unsigned axis) {
                return corner[axis] + static_cast<std::int32_t>(octant >> axis & 1) * half;
            };
            if (!visit(is_leaf(a) ? a : pool_[a][octant], is_leaf(b) ? b : pool_[b][octant], level - 1,
                       {place(0), place(1), place(2)}))
                return false;
        }
        return true;
    }

    BlockPool pool_;
    Node first_;
    Node second_;
    std::size_t limit_ = 0;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

std::uint64_t code_of(const std::array<std::int32_t, 3>& corner) {
    return voxelize::morton(static_cast<std::uint32_t>(corner[0]), static_cast<std::uint32_t>(corner[1]),
                            static_cast<std::uint32_t>(corner[2]));
}

// Connects leaves that touch. Where two touch, the larger one holds a whole octant of the smaller one's size beside the
// smaller one: so each leaf looks for a leaf that holds such an octant, in 26 directions.
std::vector<Region> connected(const std::vector<Leaf>& leaves, std::int32_t size) {
    std::vector<std::uint64_t> codes;
    codes.reserve(leaves.size());
    for (const Leaf& leaf : leaves)
        codes.push_back(code_of(leaf.corner));
    voxelize::DisjointSets sets(leaves.size());
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        work.count_step();
        for (int direction = 0; direction < 27; ++direction) {
            const std::int32_t side = std::int32_t{1} << leaves[i].level;
            const std::array<std::int32_t, 3> beside{leaves[i].corner[0] + (direction % 3 - 1) * side,
                                                     leaves[i].corner[1] + (direction / 3 % 3 - 1) * side,
                                                     leaves[i].corner[2] + (direction / 9 - 1) * side};
            if (direction == 13 || std::min({beside[0], beside[1], beside[2]}) < 0 ||
                std::max({beside[0], beside[1], beside[2]}) >= size)
                continue;
            const std::uint64_t code = code_of(beside);
            const auto after = std::upper_bound(codes.begin(), codes.end(), code);
            if (after == codes.begin())
                continue;
            const auto other = static_cast<std::uint32_t>(after - codes.begin() - 1);
            if (leaves[other].level >= leaves[i].level && code - codes[other] < voxels_at(leaves[other].level))
                sets.merge(i, other);
        }
    }
    std::unordered_map<std::uint32_t, std::size_t> rows;
    std::vector<Region> regions;
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        const Leaf& leaf = leaves[i];
        const auto [row, missing] = rows.try_emplace(sets.find(i), regions.size());
        if (missing)
            regions.push_back({{{size, size, size}, {0, 0, 0}}});
        Region& region = regions[row->second];
        (leaf.material == kAppeared   ? region.appeared
         : leaf.material == kVanished ? region.vanished
                                      : region.recoloured) += voxels_at(leaf.level);
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::int64_t low = leaf.corner[axis];
            region.bounds.low[axis] = std::min(region.bounds.low[axis], low);
            region.bounds.high[axis] = std::max(region.bounds.high[axis], low + (std::int64_t{1} << leaf.level));
        }
    }
    return regions;
}

} // namespace

std::vector<Region> differing_regions(const Memory& first, const Memory& second) {
    if (first.depth != second.depth)
        throw std::invalid_argument("octrees of different depths cannot be compared voxel by voxel");
    DifferenceWalk walk(first, second);
    if (!walk.collect(first.depth, kRegionOctants)) {
        const Difference all = diff(first, second);
        return {{*all.bounds, all.appeared, all.vanished, all.recoloured}};
    }
    std::vector<Region> regions = connected(walk.leaves, std::int32_t{1} << first.depth);
    std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
        return a.voxels() != b.voxels() ? a.voxels() > b.voxels() : a.bounds.low < b.bounds.low;
    });
    return regions;
}

} // namespace voxrt::octree
