#include "occupancy.h"

#include <voxrt/octree/query/query.h>
#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <array>

namespace voxrt::sim {
namespace {

using Corner = std::array<std::int64_t, 3>;

class Filler {
public:
    Filler(const octree::Memory& memory, Occupancy& out) : memory_(memory), out_(out) {}

    void fill(octree::Word word, unsigned level, const Corner& corner) {
        if (word == octree::kEmpty)
            return;
        work_.count_step();
        const std::int64_t side = std::int64_t{1} << level;
        if (!octree::is_leaf(word)) {
            for (unsigned octant = 0; octant < 8; ++octant)
                fill(memory_.child(word, octant, level), level - 1, octree::child_corner(corner, octant, side / 2));
            return;
        }
        const std::size_t x = static_cast<std::size_t>(corner[0] - out_.low[0]);
        for (std::int64_t z = 0; z < side; ++z)
            for (std::int64_t y = 0; y < side; ++y) {
                const std::size_t row_y = static_cast<std::size_t>(corner[1] - out_.low[1] + y);
                const std::size_t row_z = static_cast<std::size_t>(corner[2] - out_.low[2] + z);
                set(&out_.words[out_.row(row_y, row_z)], x, x + static_cast<std::size_t>(side));
            }
    }

private:
    static void set(std::uint64_t* row, std::size_t begin, std::size_t end) {
        for (std::size_t word = begin / 64; 64 * word < end; ++word) {
            const std::size_t from = std::max(begin, 64 * word) % 64,
                              count = std::min(end - 64 * word, std::size_t{64}) - from;
            row[word] |= (count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1) << from;
        }
    }

    octree::Memory memory_;
    Occupancy& out_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

// The box without voxels, or with no size where nothing is solid.
Occupancy outline(const octree::Memory& memory, std::int64_t margin) {
    Occupancy out{};
    if (const auto bounds = octree::solid_bounds(memory)) {
        for (int axis = 0; axis < 3; ++axis) {
            out.low[axis] = bounds->low[axis] - margin;
            out.size[axis] = static_cast<std::size_t>(bounds->high[axis] + margin - out.low[axis]);
        }
        out.size[0] = (out.size[0] + Occupancy::kChunkBits - 1) / Occupancy::kChunkBits * Occupancy::kChunkBits;
        out.stride = out.size[0] / 64 + 2;
    }
    return out;
}

} // namespace

std::uint64_t occupancy_bits(const octree::Memory& memory, std::int64_t margin) {
    const Occupancy box = outline(memory, margin);
    return std::uint64_t{box.stride} * 64 * box.size[1] * box.size[2];
}

Occupancy occupancy_of(const octree::Memory& memory, std::int64_t margin, std::size_t frame) {
    Occupancy out = outline(memory, margin);
    out.frame = frame;
    out.words.assign(out.plane() * (out.size[2] + 2 * frame) + 1, 0);
    if (out.stride != 0)
        Filler(memory, out).fill(memory.root(), memory.depth, {0, 0, 0});
    return out;
}

} // namespace voxrt::sim
