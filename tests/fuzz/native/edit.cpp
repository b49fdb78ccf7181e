// Sequences of edits that a fuzzer makes, held against an array of the voxels: see editing.h.
#include "driver.h"

#include "../../octree/native/editing.h"

using namespace editing;

std::vector<uint8_t> fuzz_seed() {
    std::vector<uint8_t> seed = {2, 30};
    for (int i = 0; i < 300; ++i)
        seed.push_back(uint8_t(i * 37 ^ i >> 3));
    return seed;
}

void fuzz_one(std::span<const uint8_t> data) {
    FuzzBytes bytes(data);
    const unsigned depth = 1 + bytes.upto(2);
    const WorldLimits limits{memory_size(1 + bytes.upto(255)), bytes.upto(7)};
    Editing editing([&](uint64_t count) { return bytes.take<uint16_t>() % count; }, fuzz_fail, depth, limits);
    while (!bytes.empty())
        editing.step();
    editing.finish();
}
