// One ray through the octree, exactly: the first solid cell on the real ray and the face crossed into it.
//
// The ray is mirrored so that no direction component is negative. Multiplying the ray's parameter by the product of
// the direction's components (a zero one counts as 1) makes the crossing of every plane p an integer,
//     T = (p - origin) * w,   w_x = |d_y| |d_z| and so on,   p and origin in 1/16 voxel,
// so planes are ordered by the pair (T, axis) without division, rounding or ties. `Key` is int64_t where all T fit
// (key_fits_64) and __int128 otherwise; both give the same hit.
#pragma once

#include "memory.h"

#include <bit>
#include <cstdint>

namespace voxrt::model {

inline constexpr int32_t kDirectionLimit = 1 << 20;

using WideKey = __int128;

// What a ray met. Miss: material 0, face kFaceNone, cell (-1, -1, -1). Origin in a solid: face kFaceNone.
struct Hit {
    uint8_t material = 0;
    uint8_t face = kFaceNone;
    int32_t cell[3] = {-1, -1, -1};
    uint32_t words_read = 0;
};

// Whether every T of rays from `origin` (1/16 voxel) fits in 63 bits, whatever their direction.
inline bool key_fits_64(const int32_t origin[3]) {
    constexpr int32_t kLimit = 1 << 22; // |p - origin| < 2^20 + 2^22 < 2^23 on either side of the mirror, w < 2^40
    for (int axis = 0; axis < 3; ++axis)
        if (origin[axis] <= -kLimit || origin[axis] >= kLimit)
            return false;
    return true;
}

// Traces one ray through a verified memory. Each |direction| component is below kDirectionLimit.
template <class Key> Hit trace(const Memory& memory, const int32_t origin[3], const int32_t direction[3]) {
    const int32_t side = 1 << memory.depth;
    const uint32_t* const words = memory.words;

    Key start[3], weight[3];
    int32_t corner[3] = {0, 0, 0}; // lowest cell of the node at hand, mirrored frame
    uint32_t mirror = 0;           // bit a: axis a is mirrored; turns an octant's index between the frames
    bool alive[3];
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t d = direction[axis];
        alive[axis] = d != 0;
        mirror |= static_cast<uint32_t>(d < 0) << axis;
        start[axis] = d < 0 ? Key{16} * side - origin[axis] : Key{origin[axis]};
        weight[axis] = 1;
        for (int other = 0; other < 3; ++other)
            if (other != axis && direction[other] != 0)
                weight[axis] *= direction[other] < 0 ? -direction[other] : direction[other];
    }
    const auto crossing = [&](int axis, int32_t plane) { return (Key{16} * plane - start[axis]) * weight[axis]; };

    // The entry, as one bound an axis: planes of axis a with T < passed[a] are behind the ray. Rays that start outside
    // enter with the last of the near sides; the others start with T = 0, planes through the origin behind them.
    Key passed[3] = {1, 1, 1};
    uint8_t face = kFaceNone;
    const auto pass = [&](Key key, int axis) {
        for (int other = 0; other < 3; ++other)
            passed[other] = key + (other <= axis ? 1 : 0);
        face = static_cast<uint8_t>(axis);
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (start[axis] >= 0)
            continue;
        if (!alive[axis])
            return {};
        if (const Key key = crossing(axis, 0); key >= passed[axis])
            pass(key, axis);
    }
    for (int axis = 0; axis < 3; ++axis)
        if (alive[axis] ? crossing(axis, side) < passed[axis] : start[axis] >= Key{16} * side)
            return {};

    Hit hit;
    uint32_t block_at[kMaxDepth + 1]; // block whose octants are 2^level a side
    int level = memory.depth;         // the node at hand is 2^level voxels a side
    hit.words_read = 1;
    uint32_t word = words[0];
    for (;;) {
        while (!is_leaf(word)) {
            const int32_t half = 1 << --level;
            block_at[level] = word;
            uint32_t octant = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int32_t middle = corner[axis] + half;
                const bool upper =
                    alive[axis] ? crossing(axis, middle) < passed[axis] : start[axis] >= Key{16} * middle;
                corner[axis] += upper ? half : 0;
                octant |= static_cast<uint32_t>(upper) << axis;
            }
            word = words[word + (octant ^ mirror)];
            ++hit.words_read;
        }
        if (material_of(word) != 0) {
            hit.material = material_of(word);
            hit.face = face;
            // A leaf larger than a voxel: the cell is where the ray stands in it.
            while (level > 0) {
                const int32_t half = 1 << --level;
                for (int axis = 0; axis < 3; ++axis) {
                    const int32_t middle = corner[axis] + half;
                    if (alive[axis] ? crossing(axis, middle) < passed[axis] : start[axis] >= Key{16} * middle)
                        corner[axis] = middle;
                }
            }
            for (int axis = 0; axis < 3; ++axis)
                hit.cell[axis] = mirror >> axis & 1 ? side - 1 - corner[axis] : corner[axis];
            return hit;
        }
        // Leave the leaf by its first far plane.
        int out = -1;
        Key first = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!alive[axis])
                continue;
            const Key key = crossing(axis, corner[axis] + (1 << level));
            if (out < 0 || key < first) {
                out = axis;
                first = key;
            }
        }
        if (out < 0)
            return {.words_read = hit.words_read};
        pass(first, out);
        const int32_t left = corner[out];
        corner[out] += 1 << level;
        if (corner[out] == side)
            return {.words_read = hit.words_read};
        // The smallest ancestor that holds both cells: the highest bit that the step changed.
        level = std::bit_width(static_cast<uint32_t>(left ^ corner[out])) - 1;
        uint32_t octant = 0;
        for (int axis = 0; axis < 3; ++axis) {
            corner[axis] &= -(1 << level);
            octant |= static_cast<uint32_t>(corner[axis] >> level & 1) << axis;
        }
        word = words[block_at[level] + (octant ^ mirror)];
        ++hit.words_read;
    }
}

} // namespace voxrt::model
