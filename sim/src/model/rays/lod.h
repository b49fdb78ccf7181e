// Level of detail: cells not wider than a pixel are hit as they stand. docs/lod.md defines the rule.
#pragma once

#include <voxrt/octree/words/words.h>

#include <algorithm>
#include <cstdint>

namespace voxrt::sim {

// What a frame's rays stop at. `scale` is the register of that name; 0: they go down to the leaves.
struct Lod {
    const uint8_t* means = nullptr; // a material per block; 0: not to be stopped at
    uint32_t scale = 0;

    bool on() const { return scale != 0; }
    // The mean material of the block that a word points to.
    uint8_t mean(uint32_t pointer) const { return means[octree::block_number(pointer)]; }
};

constexpr uint32_t kLodScaleLimit = 1 << 20;

// The distance, in voxels, from which on a ray of that direction stops at a voxel; at a cell of 2^level voxels per
// side, 2^level times as far. Distances are along the axis on which they are greatest.
inline int64_t lod_reach(const Lod& lod, const int64_t direction[3]) {
    int64_t largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max(largest, direction[axis] < 0 ? -direction[axis] : direction[axis]);
    return (largest * lod.scale >> 20) + 1;
}

} // namespace voxrt::sim
