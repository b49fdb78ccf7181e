#include "exposed_bricks.h"

#include <voxrt/octree/query/query.h>
#include <voxrt/octree/sight/hidden.h>
#include <voxrt/voxelize/grid/morton.h>
#include <voxrt/voxelize/work/interrupt.h>
#include <voxrt/voxelize/work/workers.h>

#include <array>
#include <stdexcept>

namespace voxrt::sim {
namespace {

using octree::Word;
using voxelize::morton;
using Corner = std::array<std::int64_t, 3>;

constexpr unsigned kBrickLevel = 3;
constexpr std::int64_t kSide = 8, kHalo = kSide + 2; // a brick, and with one voxel around it
constexpr std::uint64_t kMostBricks = std::uint64_t{1} << 32;
constexpr std::uint32_t kBrickWork = 500;

std::uint64_t code_of(const Corner& corner, unsigned level) {
    return morton(static_cast<std::uint32_t>(corner[0] >> level), static_cast<std::uint32_t>(corner[1] >> level),
                  static_cast<std::uint32_t>(corner[2] >> level));
}

// Lists bricks and octants in Morton order.
class Lister {
public:
    Lister(const octree::Memory& memory, const octree::Memory& hidden, ExposedBricks& out, std::vector<Corner>& bricks)
        : memory_(memory), hidden_(hidden), out_(out), bricks_(bricks) {}

    // `word` and `hidden` are the octants of the memory and of its hidden voxels at `corner`, or leaves that hold them.
    void visit(Word word, Word hidden, unsigned level, const Corner& corner) {
        work_.count_step();
        if (word == octree::kEmpty)
            return;
        if (level >= kBrickLevel && octree::is_leaf(word) && octree::is_leaf(hidden) && hidden != octree::kEmpty) {
            out_.octant_codes.push_back(code_of(corner, level));
            out_.octant_levels.push_back(static_cast<std::uint8_t>(level));
            out_.octant_materials.push_back(octree::material(word));
            return;
        }
        if (level <= kBrickLevel) {
            if (bricks_.size() >= kMostBricks)
                throw std::invalid_argument("the surface takes more than 2**32 bricks of 8x8x8 voxels");
            bricks_.push_back(corner);
            out_.brick_codes.push_back(code_of(corner, kBrickLevel));
            return;
        }
        const std::int64_t half = std::int64_t{1} << (level - 1);
        for (unsigned octant = 0; octant < 8; ++octant)
            visit(octree::is_leaf(word) ? word : memory_.child(word, octant, level),
                  octree::is_leaf(hidden) ? hidden : hidden_.child(hidden, octant, level), level - 1,
                  octree::child_corner(corner, octant, half));
    }

private:
    octree::Memory memory_;
    octree::Memory hidden_;
    ExposedBricks& out_;
    std::vector<Corner>& bricks_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

void fill_brick(const octree::Memory& memory, const Corner& corner, std::uint8_t* cells, std::uint8_t* exposed) {
    std::array<std::uint8_t, kHalo * kHalo * kHalo> around;
    octree::fill_region(memory,
                        {{corner[0] - 1, corner[1] - 1, corner[2] - 1},
                         {corner[0] + kSide + 1, corner[1] + kSide + 1, corner[2] + kSide + 1}},
                        around.data());
    constexpr std::int64_t step[3] = {kHalo * kHalo, kHalo, 1};
    for (std::uint32_t x = 0; x < kSide; ++x)
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t z = 0; z < kSide; ++z) {
                const std::uint8_t* cell = &around[(x + 1) * step[0] + (y + 1) * step[1] + (z + 1) * step[2]];
                const std::uint64_t i = morton(x, y, z);
                cells[i] = *cell;
                exposed[i] = 0;
                if (*cell != 0)
                    for (unsigned axis = 0; axis < 3; ++axis)
                        exposed[i] |= static_cast<std::uint8_t>((cell[-step[axis]] == 0) << 2 * axis |
                                                                (cell[step[axis]] == 0) << (2 * axis + 1));
            }
}

} // namespace

ExposedBricks exposed_bricks(const octree::VerifiedMemory& verified, int threads) {
    const octree::Memory& memory = verified.memory();
    const octree::Words hidden = octree::hidden_voxels(memory);
    ExposedBricks out;
    std::vector<Corner> bricks;
    const octree::Memory hidden_memory{hidden.data(), hidden.size(), memory.depth};
    Lister(memory, hidden_memory, out, bricks).visit(memory.root(), hidden_memory.root(), memory.depth, {0, 0, 0});
    out.cells.resize(kBrickVoxels * bricks.size());
    out.exposed.resize(kBrickVoxels * bricks.size());
    voxelize::Workers(threads).run(bricks.size(), [&](std::size_t brick, int) {
        voxelize::count_work(kBrickWork);
        fill_brick(memory, bricks[brick], &out.cells[kBrickVoxels * brick], &out.exposed[kBrickVoxels * brick]);
    });
    return out;
}

} // namespace voxrt::sim
