#include "surface.h"

#include "../query/query.h"
#include "hidden.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <vector>

namespace voxrt::octree {
namespace {

constexpr std::int64_t kBrick = 8;
constexpr std::int64_t kHalo = kBrick + 2;

// A brick with one voxel around it, z fastest.
using Neighbourhood = std::array<std::uint8_t, kHalo * kHalo * kHalo>;

constexpr std::size_t at(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((x * kHalo + y) * kHalo + z);
}

bool exposed(const Neighbourhood& cells, std::size_t i) {
    return cells[i] != 0 && !(cells[i - 1] && cells[i + 1] && cells[i - kHalo] && cells[i + kHalo] &&
                              cells[i - kHalo * kHalo] && cells[i + kHalo * kHalo]);
}

class SurfaceComparison {
public:
    SurfaceComparison(const Memory& first, const Memory& hidden, const Memory& second)
        : first_(first), hidden_(hidden), second_(second) {}

    SurfaceChange result{0, 0};

    // `word` and `hidden` are the octants of `first` and of its hidden voxels at `corner`, or leaves that hold them.
    void visit(Word word, Word hidden, unsigned level, const std::array<std::int64_t, 3>& corner) {
        work_.count_step();
        if (word == kEmpty || (is_leaf(hidden) && hidden != kEmpty))
            return;
        if (level <= 3) {
            compare(corner, std::int64_t{1} << level);
            return;
        }
        const std::int64_t half = std::int64_t{1} << (level - 1);
        for (unsigned octant = 0; octant < 8; ++octant)
            visit(is_leaf(word) ? word : first_.child(word, octant, level),
                  is_leaf(hidden) ? hidden : hidden_.child(hidden, octant, level), level - 1,
                  child_corner(corner, octant, half));
    }

private:
    void compare(const std::array<std::int64_t, 3>& corner, std::int64_t side) {
        const Box around{{corner[0] - 1, corner[1] - 1, corner[2] - 1},
                         {corner[0] + kBrick + 1, corner[1] + kBrick + 1, corner[2] + kBrick + 1}};
        fill_region(first_, around, a_.data());
        fill_region(second_, around, b_.data());
        for (std::int64_t x = 1; x <= side; ++x)
            for (std::int64_t y = 1; y <= side; ++y)
                for (std::int64_t z = 1; z <= side; ++z) {
                    const std::size_t i = at(x, y, z);
                    if (!exposed(a_, i))
                        continue;
                    ++result.surface;
                    result.changed += a_[i] != b_[i] || !exposed(b_, i);
                }
    }

    Memory first_;
    Memory hidden_;
    Memory second_;
    Neighbourhood a_{};
    Neighbourhood b_{};
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

SurfaceChange surface_change(const Memory& first, const Memory& second) {
    if (first.depth != second.depth)
        throw std::invalid_argument("octrees of different depths cannot be compared voxel by voxel");
    const Words words = hidden_voxels(first);
    const Memory hidden{words.data(), words.size(), first.depth};
    SurfaceComparison comparison(first, hidden, second);
    comparison.visit(first.root(), hidden.root(), first.depth, {0, 0, 0});
    return comparison.result;
}

} // namespace voxrt::octree
