#include "appearance.h"

#include <bit>
#include <cstring>
#include <vector>

namespace voxrt::octree {
namespace {

struct Step {
    std::uint16_t cell; // Morton order
    std::uint16_t face; // 256 * (axis + 1)
};

// The cells that a ray along (1, 1, 1) passes in the cube, nearest first.
using RayPath = std::vector<Step>;

constexpr unsigned kAxisBits[3] = {0x049, 0x092, 0x124};

unsigned cell_at(const std::array<unsigned, 3>& at) {
    unsigned code = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
        for (unsigned bit = 0; bit < 3; ++bit)
            code |= (at[axis] >> bit & 1) << (3 * bit + axis);
    return code;
}

const std::vector<RayPath>& ray_paths() {
    static const std::vector<RayPath> all = [] {
        std::vector<RayPath> result;
        for (unsigned entered = 0; entered < 3; ++entered)
            for (unsigned i = 0; i < 64; ++i) {
                std::array<unsigned, 3> at{};
                at[(entered + 1) % 3] = i % 8;
                at[(entered + 2) % 3] = i / 8;
                RayPath path;
                for (unsigned axis = entered; at[0] < 8 && at[1] < 8 && at[2] < 8; ++at[axis]) {
                    path.push_back(
                        {static_cast<std::uint16_t>(cell_at(at)), static_cast<std::uint16_t>(256 * (axis + 1))});
                    axis = (axis + 1) % 3;
                }
                result.push_back(std::move(path));
            }
        return result;
    }();
    return all;
}

// The neighbour of every cell in each of the six directions; the cell itself at the brick's sides.
const std::array<std::array<std::uint16_t, 6>, 512>& neighbours() {
    static const auto all = [] {
        std::array<std::array<std::uint16_t, 6>, 512> result{};
        for (unsigned x = 0; x < 8; ++x)
            for (unsigned y = 0; y < 8; ++y)
                for (unsigned z = 0; z < 8; ++z)
                    for (unsigned direction = 0; direction < 6; ++direction) {
                        std::array<unsigned, 3> at{x, y, z};
                        unsigned& moved = at[direction / 2];
                        if (direction % 2 == 0 ? moved > 0 : moved < 7)
                            moved += direction % 2 == 0 ? ~0u : 1u;
                        result[cell_at({x, y, z})][direction] = static_cast<std::uint16_t>(cell_at(at));
                    }
        return result;
    }();
    return all;
}

// In plain arithmetic: baseline x86-64 has no instruction for it, and std::popcount would call a function.
unsigned popcount(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555u;
    word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
    return static_cast<unsigned>(((word + (word >> 4)) & 0x0F0F0F0F0F0F0F0Fu) * 0x0101010101010101u >> 56);
}

} // namespace

BrickAppearance::BrickAppearance(const Cells512& materials) : cells(materials) {
    for (unsigned cell = 0; cell < 512; ++cell) {
        if (cells[cell] == 0)
            continue;
        ++solid;
        mask[cell / 64] |= std::uint64_t{1} << (cell % 64);
        bool covered = true;
        for (const std::uint16_t neighbour : neighbours()[cell])
            covered = covered && cells[neighbour] != 0;
        if (!covered)
            exposed[cell / 64] |= std::uint64_t{1} << (cell % 64);
    }
    std::uint16_t* ray = seen.data();
    for (unsigned corner = 0; corner < 8; ++corner) {
        unsigned flip = 0;
        for (unsigned axis = 0; axis < 3; ++axis)
            flip |= corner >> axis & 1 ? kAxisBits[axis] : 0;
        for (const RayPath& path : ray_paths()) {
            for (const Step& step : path)
                if (const std::uint8_t id = cells[step.cell ^ flip]; id != 0) {
                    *ray = static_cast<std::uint16_t>(step.face | id);
                    break;
                }
            ++ray;
        }
    }
}

std::uint64_t appearance_cost(const BrickAppearance& before, const BrickAppearance& after, const AppearanceCosts& costs,
                              std::uint64_t limit) {
    std::uint64_t cost = 0;
    for (unsigned word = 0; word < 8; ++word)
        cost += kExposedCellCost * popcount(before.exposed[word] & ~after.exposed[word]);
    if (cost >= limit)
        return cost;
    for (unsigned word = 0; word < 8; ++word)
        for (std::uint64_t both = before.exposed[word] & after.exposed[word]; both != 0; both &= both - 1) {
            const unsigned cell = 64 * word + static_cast<unsigned>(std::countr_zero(both));
            cost += before.cells[cell] != after.cells[cell] ? kExposedCellCost : 0;
        }
    // Most rays see no change: four are compared at once.
    for (unsigned first = 0; first < BrickAppearance::kRays && cost < limit; first += 4) {
        if (std::memcmp(&before.seen[first], &after.seen[first], 4 * sizeof before.seen[0]) == 0)
            continue;
        for (unsigned ray = first; ray < first + 4; ++ray) {
            const unsigned a = before.seen[ray];
            const unsigned b = after.seen[ray];
            if (a != b)
                cost += a == 0 ? costs.occlusion[b & 255]
                               : (a >> 8 == b >> 8 ? costs.same_axis : costs.other_axis)[a & 255][b & 255];
        }
    }
    return cost;
}

} // namespace voxrt::octree
