#include "hidden.h"

#include "interrupt.h"
#include "query.h"

namespace voxrt::octree {
namespace {

constexpr std::size_t kWalkLimit = std::size_t{1} << 22;

bool solid(const Memory& memory, Word word, unsigned level, const std::array<std::int64_t, 3>& corner, const Box& box) {
    const std::int64_t side = std::int64_t{1} << level;
    for (unsigned axis = 0; axis < 3; ++axis)
        if (corner[axis] >= box.high[axis] || corner[axis] + side <= box.low[axis])
            return true;
    if (is_leaf(word))
        return material(word) != 0;
    for (unsigned octant = 0; octant < 8; ++octant)
        if (!solid(memory, memory.child(word, octant, level), level - 1, child_corner(corner, octant, side / 2), box))
            return false;
    return true;
}

class HiddenWalk {
public:
    HiddenWalk(const Memory& memory, unsigned target) : memory_(memory), target_(target) {}

    std::unordered_map<Word, std::uint64_t> hidden;

    // False where the walk grew too long.
    bool visit(Word word, unsigned level, const std::array<std::int64_t, 3>& corner) {
        if (is_leaf(word) || level < target_ || !worth_a_visit(word, level))
            return true;
        interrupt_.poll();
        if (++visited_ > kWalkLimit)
            return false;
        if (level == target_) {
            hidden[word] += enclosed(memory_, corner, level);
            return true;
        }
        const std::int64_t half = std::int64_t{1} << (level - 1);
        for (unsigned octant = 0; octant < 8; ++octant)
            if (!visit(memory_.child(word, octant, level), level - 1, child_corner(corner, octant, half)))
                return false;
        return true;
    }

private:
    // Whether a block of the target level that is solid throughout lies in this one.
    bool worth_a_visit(Word word, unsigned level) {
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto known = worth_.find(key); known != worth_.end())
            return known->second;
        bool worth = level == target_;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child = memory_.child(word, octant, level);
            if (level == target_)
                worth = worth && full(child, level - 1);
            else
                worth = worth || (!is_leaf(child) && worth_a_visit(child, level - 1));
        }
        worth_.emplace(key, worth);
        return worth;
    }

    // Target levels lie two or three above the leaves, so this needs no memo.
    bool full(Word word, unsigned level) const {
        if (is_leaf(word))
            return word != kEmpty;
        for (unsigned octant = 0; octant < 8; ++octant)
            if (!full(memory_.child(word, octant, level), level - 1))
                return false;
        return true;
    }

    Memory memory_;
    unsigned target_;
    std::unordered_map<std::uint64_t, bool> worth_;
    std::size_t visited_ = 0;
    Interrupt interrupt_;
};

} // namespace

bool enclosed(const Memory& memory, const std::array<std::int64_t, 3>& corner, unsigned level) {
    const std::int64_t side = std::int64_t{1} << level;
    const std::int64_t world = std::int64_t{1} << memory.depth;
    const auto is_solid = [&](const Box& box) { return solid(memory, memory.root(), memory.depth, {0, 0, 0}, box); };
    const Box octant{corner, {corner[0] + side, corner[1] + side, corner[2] + side}};
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (corner[axis] == 0 || corner[axis] + side == world)
            return false;
        Box layer = octant;
        layer.high[axis] = layer.low[axis]--;
        if (!is_solid(layer))
            return false;
        layer.low[axis] += side + 1;
        layer.high[axis] += side + 1;
        if (!is_solid(layer))
            return false;
    }
    return is_solid(octant);
}

std::unordered_map<Word, std::uint64_t> hidden_octants(const Memory& memory, unsigned level) {
    HiddenWalk walk(memory, level);
    if (!walk.visit(memory.root(), memory.depth, {0, 0, 0}))
        walk.hidden.clear();
    return std::move(walk.hidden);
}

} // namespace voxrt::octree
