// The readers of octree memories on words that a fuzzer makes: what is no octree is refused, never read beyond its
// end; what is one is read without an error, and a grid made of it gives it again.
#include "driver.h"

#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/pool/shared_size.h>
#include <voxrt/octree/query/diff.h>
#include <voxrt/octree/query/query.h>
#include <voxrt/octree/query/regions.h>
#include <voxrt/octree/sight/hidden.h>
#include <voxrt/octree/sight/interior.h>
#include <voxrt/octree/sight/surface.h>
#include <voxrt/octree/words/validate.h>
#include <voxrt/octree/words/verify.h>

using namespace voxrt::octree;

namespace {

Words words_of(FuzzBytes& bytes) {
    Words words;
    const unsigned blocks = bytes.upto(24);
    for (unsigned i = 0; i < 1 + 8 * blocks; ++i) {
        const unsigned kind = bytes.upto(15);
        if (kind == 0)
            words.push_back(bytes.take<Word>());
        else if (kind < 9)
            words.push_back(leaf(uint8_t(bytes.upto(3))));
        else
            words.push_back(Word(1 + 8 * bytes.upto(blocks)));
    }
    return words;
}

std::vector<uint8_t> cells_of(const Memory& memory) {
    const int64_t side = int64_t{1} << memory.depth;
    std::vector<uint8_t> cells(size_t(side * side * side));
    fill_region(memory, Box{{0, 0, 0}, {side, side, side}}, cells.data());
    return cells;
}

void read_all(const Memory& memory, const Memory& other) {
    leaf_counts(memory);
    solid_bounds(memory);
    shared_words(memory);
    count_in_box(memory, Box{{0, 0, 0}, {1, 2, 3}});
    const int64_t points[] = {0, 0, 0, 1, 1, 1};
    uint8_t materials[2];
    materials_at(memory, points, 2, materials);
    diff(memory, other);
    surface_change(memory, other);
    differing_regions(memory, other);
    const Words hidden = hidden_voxels(memory);
    const Memory unseen{hidden.data(), hidden.size(), memory.depth};
    fill_hidden(memory, unseen, 2);
    share_hidden(memory, unseen);
}

} // namespace

std::vector<uint8_t> fuzz_seed() {
    std::vector<uint8_t> seed = {2, 3};
    for (int i = 0; i < 400; ++i)
        seed.push_back(uint8_t(i * 29 ^ i >> 2));
    return seed;
}

void fuzz_one(std::span<const uint8_t> data) {
    FuzzBytes bytes(data);
    const unsigned kind = bytes.upto(31), depth = kind == 0 ? 5 : 1 + kind % 4; // most grids are small, for speed
    const Words first = words_of(bytes), second = words_of(bytes);
    const Memory memory{first.data(), first.size(), depth}, other{second.data(), second.size(), depth};
    const bool sound = validate(first.data(), first.size(), depth).fault == Fault::none;
    const bool both = sound && validate(second.data(), second.size(), depth).fault == Fault::none;
    try {
        read_all(memory, both ? other : memory);
        const std::vector<uint8_t> cells = cells_of(memory);
        const size_t side = size_t{1} << depth;
        const Words built = build_dense(cells.data(), side, side, side, depth);
        if (validate(built.data(), built.size(), depth).fault != Fault::none)
            fuzz_fail("a memory that was built is no octree");
        if (cells_of(Memory{built.data(), built.size(), depth}) != cells)
            fuzz_fail("a grid does not come back from its memory");
        if (!both)
            read_all(memory, other);
    } catch (const std::invalid_argument&) {
        if (both)
            fuzz_fail("a sound memory was refused");
    }
}
