// Runs the native octree without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random grids of every small depth go through each function and are held against the voxels themselves; random bricks
// and octants are built on one thread and on three; memories of random words are refused and never read beyond their
// end. Prints a line and exits with 1 where something is wrong.
#include <voxrt/octree/budget/budget.h>
#include <voxrt/octree/build/build.h>
#include <voxrt/octree/build/coarsen.h>
#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/pool/breadth_first.h>
#include <voxrt/octree/pool/shared_size.h>
#include <voxrt/octree/query/diff.h>
#include <voxrt/octree/query/leaves.h>
#include <voxrt/octree/query/query.h>
#include <voxrt/octree/query/regions.h>
#include <voxrt/octree/sight/hidden.h>
#include <voxrt/octree/sight/interior.h>
#include <voxrt/octree/sight/surface.h>
#include <voxrt/octree/words/validate.h>
#include <voxrt/octree/words/verify.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>
#include <set>

using namespace voxrt::octree;

namespace {

using Random = std::mt19937_64;
using Cells = std::vector<std::uint8_t>; // z fastest, then y, then x

bool good = true;

void expect(bool condition, const char* what, unsigned depth) {
    if (!condition)
        std::printf("depth %u: %s\n", depth, what);
    good = good && condition;
}

std::size_t at(std::int64_t x, std::int64_t y, std::int64_t z, unsigned depth) {
    return static_cast<std::size_t>(((x << depth) + y) << depth) + static_cast<std::size_t>(z);
}

/// Boxes, some of them empty again, and a few stray voxels.
Cells random_cells(Random& random, unsigned depth) {
    const std::int64_t side = std::int64_t{1} << depth;
    Cells cells(static_cast<std::size_t>(side * side * side));
    std::uniform_int_distribution<std::int64_t> place(0, side);
    std::uniform_int_distribution<int> kind(0, 3);
    for (int box = 0; box < 6; ++box) {
        std::int64_t low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t a = place(random), b = place(random);
            low[axis] = std::min(a, b);
            high[axis] = std::max(a, b);
        }
        const auto material = static_cast<std::uint8_t>(kind(random));
        for (std::int64_t x = low[0]; x < high[0]; ++x)
            for (std::int64_t y = low[1]; y < high[1]; ++y)
                for (std::int64_t z = low[2]; z < high[2]; ++z)
                    cells[at(x, y, z, depth)] = material;
    }
    for (std::size_t stray = 0; stray < cells.size() / 50; ++stray)
        cells[random() % cells.size()] = static_cast<std::uint8_t>(random());
    return cells;
}

Memory memory_of(const Words& words, unsigned depth) { return {words.data(), words.size(), depth}; }

Cells cells_of(const Words& words, unsigned depth) {
    const std::int64_t side = std::int64_t{1} << depth;
    Cells cells(std::size_t{1} << (3 * depth));
    fill_region(memory_of(words, depth), {{0, 0, 0}, {side, side, side}}, cells.data());
    return cells;
}

bool enclosed(const Cells& cells, std::int64_t x, std::int64_t y, std::int64_t z, unsigned depth) {
    const std::int64_t side = std::int64_t{1} << depth;
    for (int i = 0; i < 27; ++i) {
        const std::int64_t u = x + i % 3 - 1, v = y + i / 3 % 3 - 1, w = z + i / 9 - 1;
        if (std::min({u, v, w}) < 0 || std::max({u, v, w}) >= side || cells[at(u, v, w, depth)] == 0)
            return false;
    }
    return true;
}

void exercise_interior(const Cells& cells, const Memory& memory, const Words& hidden) {
    const unsigned depth = memory.depth;
    const std::int64_t side = std::int64_t{1} << depth;
    const Cells found = cells_of(hidden, depth);
    const Cells filled = cells_of(fill_hidden(memory, memory_of(hidden, depth), 9), depth);
    const Words words = share_hidden(memory, memory_of(hidden, depth));
    const Cells shared = cells_of(words, depth);
    bool right = words.size() <= memory.size;
    for (std::int64_t x = 0; x < side; ++x)
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t z = 0; z < side; ++z) {
                const std::size_t i = at(x, y, z, depth);
                const bool expected = enclosed(cells, x, y, z, depth);
                right = right && found[i] == expected && filled[i] == (expected ? 9 : cells[i]) &&
                        (expected ? shared[i] != 0 : shared[i] == cells[i]);
            }
    expect(right, "hidden voxels", depth);
}

void exercise_grid(Random& random, unsigned depth) {
    const Cells cells = random_cells(random, depth), others = random_cells(random, depth);
    const std::size_t side = std::size_t{1} << depth;
    const auto end = static_cast<std::int64_t>(side);
    const Words words = build_dense(cells.data(), side, side, side, depth);
    const Words other_words = build_dense(others.data(), side, side, side, depth);
    const Memory memory = memory_of(words, depth), other = memory_of(other_words, depth);
    expect(validate(words.data(), words.size(), depth).fault == Fault::none, "validation", depth);
    expect(cells_of(words, depth) == cells, "a region", depth);

    std::uint64_t differ = 0, in_regions = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
        differ += cells[i] != others[i];
    const Difference difference = diff(memory, other);
    expect(difference.appeared + difference.vanished + difference.recoloured == differ, "a difference", depth);
    for (const Region& region : differing_regions(memory, other))
        in_regions += region.voxels();
    expect(in_regions == differ, "regions", depth);

    std::array<std::uint64_t, 256> counts{};
    for (const std::uint8_t cell : cells)
        ++counts[cell];
    expect(count_in_box(memory, {{0, 0, 0}, {end, end, end}}) == counts, "counts in a box", depth);
    count_in_box(memory, {{-3, 1, 0}, {end / 2, end + 2, 1}});
    std::vector<std::int64_t> points;
    for (int i = 0; i < 300; ++i)
        points.push_back(static_cast<std::int64_t>(random() % (2 * side)) - end / 2);
    Cells materials(100);
    materials_at(memory, points.data(), 100, materials.data());

    LeafWalk walk(memory, {{0, 0, 0}, {end, end, end}}, false);
    std::uint64_t volume = 0;
    for (std::vector<Leaf> part; !(part = walk.next(100)).empty();)
        for (const Leaf& leaf : part)
            volume += voxels_at(leaf.level);
    expect(volume == cells.size(), "leaves", depth);

    const Words hidden = hidden_voxels(memory);
    exercise_interior(cells, memory, hidden);
    expect(surface_change(memory, memory).changed == 0, "a surface", depth);
    surface_change(memory, other);
    leaf_counts(memory);
    solid_bounds(memory);
    shared_words(memory);
    BlockPool pool;
    coarsen(memory, 1, pool);
    const auto costs = std::make_unique<AppearanceCosts>();
    for (auto& row : costs->same_axis)
        row.fill(128);
    for (auto& row : costs->other_axis)
        row.fill(256);
    costs->occlusion.fill(128);
    for (const Words& fit : fit_bricks(memory, memory_of(hidden, depth), 0, *costs, memory.size / 2))
        expect(validate(fit.data(), fit.size(), depth).fault == Fault::none, "fitted bricks", depth);
}

/// Bricks of one material and of many, and octants among them, on one thread and on three.
void exercise_threads(Random& random, unsigned depth) {
    std::set<std::uint64_t> codes;
    while (codes.size() < 6000)
        codes.insert(random() >> (64 - 3 * (depth - 3)));
    std::vector<std::uint64_t> brick_codes, brick_masks, octant_codes;
    Cells brick_materials, cells, octant_levels, octant_materials;
    std::vector<std::int32_t> rows;
    std::int32_t row = 0;
    for (const std::uint64_t code : codes) {
        const auto material = static_cast<std::uint8_t>(1 + code % 5);
        if (code % 4 == 0) {
            octant_codes.push_back(code);
            octant_levels.push_back(3);
            octant_materials.push_back(material);
            continue;
        }
        brick_codes.push_back(code);
        const bool many = code % 4 == 1;
        brick_materials.push_back(many ? 0 : material);
        rows.push_back(many ? row++ : -1);
        for (int word = 0; word < 8; ++word) {
            brick_masks.push_back((random() & random()) | 1);
            for (int bit = 0; bit < 64 && many; ++bit)
                cells.push_back(static_cast<std::uint8_t>((brick_masks.back() >> bit & 1) * (1 + random() % 255)));
        }
    }
    const voxrt::voxelize::VoxelsView view{depth,
                                           brick_codes.size(),
                                           brick_codes.data(),
                                           brick_masks.data(),
                                           brick_materials.data(),
                                           rows.data(),
                                           static_cast<std::size_t>(row),
                                           cells.data(),
                                           octant_codes.size(),
                                           octant_codes.data(),
                                           octant_levels.data(),
                                           octant_materials.data()};
    expect(build(view, 1) == build(view, 3), "the result depends on the number of threads", depth);
}

/// Words of any kind: most are no octree, and no read may leave the memory.
void exercise_words(Random& random) {
    for (int i = 0; i < 2000; ++i) {
        Words words(1 + 8 * (random() % 6));
        for (Word& word : words)
            word = random() % 3 == 0   ? leaf(static_cast<std::uint8_t>(random()))
                   : random() % 9 == 0 ? static_cast<Word>(random())
                                       : static_cast<Word>(1 + 8 * (random() % 7));
        const unsigned depth = 1 + i % 4;
        const bool sound = validate(words.data(), words.size(), depth).fault == Fault::none;
        try {
            const Words hidden = hidden_voxels(memory_of(words, depth));
            share_hidden(memory_of(words, depth), memory_of(hidden, depth));
            cells_of(words, depth);
            VerifiedMemory(memory_of(words, depth));
        } catch (const std::invalid_argument&) {
            expect(!sound, "a sound memory is refused", depth);
        }
    }
}

} // namespace

int main() {
    Random random(1);
    for (unsigned depth = 1; depth <= 5; ++depth)
        for (int grid = 0; grid < 4; ++grid)
            exercise_grid(random, depth);
    exercise_threads(random, 8);
    exercise_words(random);
    return good ? 0 : 1;
}
