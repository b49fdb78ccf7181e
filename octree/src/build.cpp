#include "build.h"

#include <stdexcept>
#include <string>

#include "ascent.h"
#include "breadth_first.h"
#include "brick.h"
#include "interrupt.h"

namespace voxrt::octree {
namespace {

constexpr unsigned kBrickLevel = 3;

[[noreturn]] void refuse(const char* row, std::size_t index, const char* problem) {
    throw std::invalid_argument(std::string(row) + " " + std::to_string(index) + ": " + problem);
}

// Bit i of the result says whether byte i of `eight` is not zero.
std::uint8_t solid_bits(std::uint64_t eight) {
    constexpr std::uint64_t low7 = 0x7F7F7F7F7F7F7F7Fu;
    const std::uint64_t high = (((eight & low7) + low7) | eight) & ~low7;
    return static_cast<std::uint8_t>((high >> 7) * 0x0102040810204080u >> 56);
}

bool cells_match_mask(const std::uint8_t* cells, const std::uint64_t* mask) {
    std::uint64_t difference = 0;
    for (unsigned word = 0; word < 8; ++word) {
        std::uint64_t solid = 0;
        for (unsigned group = 0; group < 8; ++group) {
            std::uint64_t eight;
            std::memcpy(&eight, cells + 64 * word + 8 * group, 8);
            solid |= std::uint64_t{solid_bits(eight)} << (8 * group);
        }
        difference |= solid ^ mask[word];
    }
    return difference == 0;
}

// The node of a brick in a world of at least 8 voxels a side, or the whole of a smaller world.
Node brick_node(const VoxelsView& voxels, std::size_t i, BrickBuilder& builder) {
    const std::uint64_t* mask = voxels.brick_masks + 8 * i;
    const std::int32_t row = voxels.brick_rows[i];
    const std::uint8_t material = voxels.brick_materials[i];
    std::uint64_t any = 0;
    for (unsigned word = 0; word < 8; ++word)
        any |= mask[word];
    if (any == 0)
        refuse("brick", i, "is empty");
    if (voxels.depth < kBrickLevel) {
        std::uint64_t beyond = voxels.depth == 1 ? mask[0] >> 8 : 0;
        for (unsigned word = 1; word < 8; ++word)
            beyond |= mask[word];
        if (beyond != 0)
            refuse("brick", i, "has voxels outside the grid");
    }
    if (row < 0) {
        if (material == 0)
            refuse("brick", i, "has neither a material nor a row of cells");
        switch (voxels.depth) {
        case 1:
            return builder.from_mask8(static_cast<std::uint8_t>(mask[0]), material);
        case 2:
            return builder.from_mask64(mask[0], material);
        default:
            return builder.from_mask(mask, material);
        }
    }
    if (static_cast<std::size_t>(row) >= voxels.rows)
        refuse("brick", i, "points behind the last row of cells");
    const std::uint8_t* cells = voxels.cells + 512 * static_cast<std::size_t>(row);
    if (!cells_match_mask(cells, mask))
        refuse("brick", i, "has cells that contradict its mask");
    switch (voxels.depth) {
    case 1:
        return builder.from_cells8(cells);
    case 2:
        return builder.from_cells64(cells);
    default:
        return builder.from_cells(cells);
    }
}

} // namespace

std::vector<Word> build(const VoxelsView& voxels) {
    const unsigned depth = voxels.depth;
    const unsigned brick_level = depth < kBrickLevel ? depth : kBrickLevel;
    const std::uint64_t brick_limit = std::uint64_t{1} << (3 * (depth - brick_level));
    BlockPool pool(voxels.bricks / 2);
    BrickBuilder builder(pool);
    Ascent ascent(pool, depth);
    Interrupt interrupt;

    std::uint64_t covered = 0; // Morton code, in bricks, behind the last item
    std::size_t brick = 0;
    std::size_t octant = 0;
    while (brick < voxels.bricks || octant < voxels.octants) {
        interrupt.poll();
        unsigned level = 0;
        std::uint64_t begin = 0;
        if (octant < voxels.octants) {
            level = voxels.octant_levels[octant];
            if (level < kBrickLevel || level > depth)
                refuse("octant", octant, "has a level outside 3 ... depth");
            if (voxels.octant_codes[octant] >= std::uint64_t{1} << (3 * (depth - level)))
                refuse("octant", octant, "lies outside the grid");
            begin = voxels.octant_codes[octant] << (3 * (level - kBrickLevel));
        }
        if (brick < voxels.bricks && (octant == voxels.octants || voxels.brick_codes[brick] < begin)) {
            const std::uint64_t code = voxels.brick_codes[brick];
            if (code >= brick_limit)
                refuse("brick", brick, "lies outside the grid");
            if (code < covered)
                refuse("brick", brick, "is out of Morton order or overlaps what came before");
            ascent.add(brick_level, code, brick_node(voxels, brick, builder));
            covered = code + 1;
            ++brick;
        } else {
            if (begin < covered)
                refuse("octant", octant, "is out of Morton order or overlaps what came before");
            if (voxels.octant_materials[octant] == 0)
                refuse("octant", octant, "has no material");
            ascent.add(level, voxels.octant_codes[octant], leaf(voxels.octant_materials[octant]));
            covered = begin + (std::uint64_t{1} << (3 * (level - kBrickLevel)));
            ++octant;
        }
    }
    return breadth_first_words(pool, ascent.finish());
}

} // namespace voxrt::octree
