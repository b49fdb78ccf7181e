// Bricks of 8x8x8 voxels as the voxelizer works on them: eight slices along z; each bit of a slice is a column.
//
// With slices, a sweep along z takes eight steps of 64 columns. A row of eight columns is a byte of each slice.
#pragma once

#include "high_bits.h"
#include "morton.h"

#include <array>
#include <bit>
#include <cstdint>

namespace voxrt::voxelize {

using Slices = std::array<uint64_t, 8>;

inline constexpr int kBrickBits = 3;
inline constexpr int kBrickSide = 8;
inline constexpr int kBrickVoxels = 512;
inline constexpr int kTileSide = 64; // columns per side of a tile

inline bool is_full(const Slices& s) { return (s[0] & s[1] & s[2] & s[3] & s[4] & s[5] & s[6] & s[7]) == ~uint64_t{0}; }
/// The columns with a voxel.
inline uint64_t any_of(const Slices& s) { return s[0] | s[1] | s[2] | s[3] | s[4] | s[5] | s[6] | s[7]; }
inline bool is_empty(const Slices& s) { return any_of(s) == 0; }

/// The voxels of `a` that are not in `b`.
inline Slices without(const Slices& a, const Slices& b) {
    Slices found;
    for (int z = 0; z < kBrickSide; ++z)
        found[size_t(z)] = a[size_t(z)] & ~b[size_t(z)];
    return found;
}

/// The only material of a brick's voxels, 0 of which are empty; 0 where there are several, or none.
inline uint8_t only_material(const std::array<uint8_t, kBrickVoxels>& materials) {
    uint8_t only = 0;
    for (const uint8_t material : materials) {
        if (material != 0 && only != 0 && material != only)
            return 0;
        only = material != 0 ? material : only;
    }
    return only;
}

/// Solid voxels. In plain arithmetic, since baseline x86-64 has no instruction for it.
inline int count(const Slices& s) {
    constexpr uint64_t ones = 0x5555'5555'5555'5555, pairs = 0x3333'3333'3333'3333, nibbles = 0x0F0F'0F0F'0F0F'0F0F;
    uint64_t bytes = 0;
    for (uint64_t v : s) {
        v -= v >> 1 & ones;
        v = (v & pairs) + (v >> 2 & pairs);
        bytes += (v + (v >> 4)) & nibbles; // at most 64 per byte
    }
    bytes = (bytes & 0x00FF'00FF'00FF'00FF) + (bytes >> 8 & 0x00FF'00FF'00FF'00FF);
    return int(bytes * 0x0001'0001'0001'0001 >> 48);
}

/// The bit of a slice that stands for column (x, y) of a brick, and back.
constexpr int column_bit(int x, int y) { return (y & 7) << 3 | (x & 7); }
constexpr int column_x(int bit) { return bit & 7; }
constexpr int column_y(int bit) { return bit >> 3; }

/// The other way to hold 512 voxels: by row y, a byte per column, its bits along z. What a triangle covers of a row is
/// one word.
using Columns = std::array<uint64_t, 8>;

inline Slices slices_of(const Columns& columns) {
    Slices s{};
    if (is_empty(columns))
        return s;
    for (int y = 0; y < kBrickSide; y += 2) {
        Bytes16 v = bytes_of(columns[y], columns[y + 1]);
        for (int z = kBrickSide - 1; z >= 0; --z) {
            s[z] |= uint64_t{high_bits(v)} << 8 * y;
            v = doubled(v);
        }
    }
    return s;
}

/// Exchanges bits `low` and `high` of the number of each bit.
template <int low, int high> constexpr uint64_t exchange_index_bits(uint64_t v) {
    // with[i]: the bits whose number has bit i.
    constexpr uint64_t with[6] = {0xAAAA'AAAA'AAAA'AAAA, 0xCCCC'CCCC'CCCC'CCCC, 0xF0F0'F0F0'F0F0'F0F0,
                                  0xFF00'FF00'FF00'FF00, 0xFFFF'0000'FFFF'0000, 0xFFFF'FFFF'0000'0000};
    constexpr uint64_t mask = with[low] & ~with[high];
    constexpr int distance = (1 << high) - (1 << low);
    const uint64_t t = (v ^ v >> distance) & mask;
    return v ^ t ^ t << distance;
}

/// A slice with its columns in Morton order: bit {y2,x2,y1,x1,y0,x0}, from {y2,y1,y0,x2,x1,x0}.
constexpr uint64_t morton_columns(uint64_t slice) {
    return exchange_index_bits<3, 4>(exchange_index_bits<2, 3>(exchange_index_bits<1, 3>(slice)));
}
static_assert([] {
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) {
            const uint64_t code = morton(uint32_t(x), uint32_t(y), 0); // three bits per level, the third is 0
            const int bit = int(code & 3) | int(code >> 3 & 3) << 2 | int(code >> 6 & 3) << 4;
            if (morton_columns(uint64_t{1} << column_bit(x, y)) != uint64_t{1} << bit)
                return false;
        }
    return true;
}());

/// Slice order to Morton order: word {z2,y2,x2}, bit {z1,y1,x1,z0,y0,x0}.
///
/// A nibble of a slice in Morton order is a square of 2x2 columns. The nibbles of slices z0 = 0 and 1 alternate; 16
/// bits of a slice, spread so to 32, are the half z1 of a word.
inline Slices morton_order(const Slices& slices) {
    constexpr uint64_t nibbles = 0x0F0F'0F0F'0F0F'0F0F;
    auto spread_bytes = [](uint64_t v) {
        v = (v | v << 16) & 0x0000'FFFF'0000'FFFF;
        return (v | v << 8) & 0x00FF'00FF'00FF'00FF;
    };
    Slices words{};
    for (int z = 0; z < kBrickSide; z += 2) {
        const uint64_t below = morton_columns(slices[z]), above = morton_columns(slices[z + 1]);
        const uint64_t even = (below & nibbles) | (above & nibbles) << 4;
        const uint64_t odd = (below >> 4 & nibbles) | (above & ~nibbles);
        const uint64_t low = spread_bytes(even & 0xFFFF'FFFF) | spread_bytes(odd & 0xFFFF'FFFF) << 8;
        const uint64_t high = spread_bytes(even >> 32) | spread_bytes(odd >> 32) << 8;
        uint64_t* out = &words[(z >> 2) * 4];
        const int half = 32 * (z >> 1 & 1);
        out[0] |= (low & 0xFFFF'FFFF) << half;
        out[1] |= (low >> 32) << half;
        out[2] |= (high & 0xFFFF'FFFF) << half;
        out[3] |= (high >> 32) << half;
    }
    return words;
}

} // namespace voxrt::voxelize
