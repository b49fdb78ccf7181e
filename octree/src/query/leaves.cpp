#include "leaves.h"

#include <voxrt/voxelize/work/interrupt.h>

namespace voxrt::octree {

LeafWalk::LeafWalk(const Memory& memory, const Box& box, bool solid_only)
    : memory_(memory), box_(box), solid_only_(solid_only),
      stack_{{memory.root(), static_cast<std::uint8_t>(memory.depth), {0, 0, 0}}} {}

std::vector<Leaf> LeafWalk::next(std::size_t limit) {
    std::vector<Leaf> leaves;
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    while (!stack_.empty() && leaves.size() < limit) {
        work.count_step();
        const Step step = stack_.back();
        stack_.pop_back();
        const std::int64_t side = std::int64_t{1} << step.level;
        bool apart = false;
        for (unsigned axis = 0; axis < 3; ++axis)
            apart |= step.corner[axis] >= box_.high[axis] || step.corner[axis] + side <= box_.low[axis];
        if (apart || (solid_only_ && step.word == kEmpty))
            continue;
        if (is_leaf(step.word)) {
            leaves.push_back({{static_cast<std::int32_t>(step.corner[0]), static_cast<std::int32_t>(step.corner[1]),
                               static_cast<std::int32_t>(step.corner[2])},
                              step.level,
                              material(step.word)});
            continue;
        }
        for (unsigned octant = 8; octant-- > 0;)
            stack_.push_back({memory_.child(step.word, octant, step.level), static_cast<std::uint8_t>(step.level - 1),
                              child_corner(step.corner, octant, side / 2)});
    }
    return leaves;
}

} // namespace voxrt::octree
