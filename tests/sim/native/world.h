// Random worlds for the exercises of this folder.
#pragma once

#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/words/verify.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace exercise {

using Random = std::mt19937_64;

inline void check(bool holds, const char* what) {
    if (holds)
        return;
    std::printf("%s\n", what);
    std::exit(1);
}

inline int upto(Random& random, int most) { return std::uniform_int_distribution<int>(0, most)(random); }

/// The words of boxes, some of them empty again, and a few stray voxels; seldom of an empty world or a full one.
inline voxrt::octree::Words world(Random& random, unsigned depth, int materials) {
    const int side = 1 << depth;
    std::vector<uint8_t> cells(size_t{1} << (3 * depth), static_cast<uint8_t>(upto(random, 19) == 0 ? 1 : 0));
    for (int boxes = upto(random, 6); boxes > 0; --boxes) {
        int low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            const int a = upto(random, side), b = upto(random, side);
            low[axis] = std::min(a, b);
            high[axis] = std::max(a, b);
        }
        const auto material = static_cast<uint8_t>(upto(random, materials - 1));
        for (int x = low[0]; x < high[0]; ++x)
            for (int y = low[1]; y < high[1]; ++y)
                std::fill_n(cells.begin() + (((x << depth) + y) << depth) + low[2], std::max(0, high[2] - low[2]),
                            material);
    }
    for (size_t stray = upto(random, 2) * cells.size() / 100; stray > 0; --stray)
        cells[random() % cells.size()] = static_cast<uint8_t>(upto(random, materials - 1));
    const auto size = static_cast<size_t>(side);
    return voxrt::octree::build_dense(cells.data(), size, size, size, depth);
}

} // namespace exercise
