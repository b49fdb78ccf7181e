// Bricks of 8x8x8 voxels as the voxelizer works on them: eight slices along z; each bit of a slice is a column.
//
// With slices, a sweep along z takes eight steps of 64 columns. Columns are in Morton order within a slice, so that
// little is left to do for the Morton order of the result.
#pragma once

#include "morton.h"

#include <array>
#include <bit>
#include <cstdint>

namespace voxrt::voxelize {

using Slices = std::array<uint64_t, 8>;

inline constexpr int kBrickBits = 3;
inline constexpr int kBrickSide = 8;
inline constexpr int kBrickVoxels = 512;

inline bool is_full(const Slices& s) { return (s[0] & s[1] & s[2] & s[3] & s[4] & s[5] & s[6] & s[7]) == ~uint64_t{0}; }
inline bool is_empty(const Slices& s) { return (s[0] | s[1] | s[2] | s[3] | s[4] | s[5] | s[6] | s[7]) == 0; }

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
inline constexpr std::array<uint8_t, 8> kSpread2 = {0, 1, 4, 5, 16, 17, 20, 21};
constexpr int column_bit(int x, int y) { return kSpread2[x & 7] | kSpread2[y & 7] << 1; }
constexpr int column_x(int bit) { return (bit & 1) | (bit >> 1 & 2) | (bit >> 2 & 4); }
constexpr int column_y(int bit) { return column_x(bit >> 1); }

/// The other way to hold 512 voxels: a byte per column, its bits along z. An interval of a column is one operation.
using Columns = std::array<uint8_t, 64>;

/// The voxels from … to of a column.
constexpr uint8_t column_interval(int from, int to) { return uint8_t(0xFF << from & 0xFF >> (7 - to)); }

/// Exchanges the blocks of `size` bits off the diagonal, in 8x8 bits: one step of a transposition (Warren, "Hacker's
/// Delight", 7-3).
constexpr uint64_t exchange_blocks(uint64_t v, int distance, uint64_t mask) {
    const uint64_t t = (v ^ v >> distance) & mask;
    return v ^ t ^ t << distance;
}

inline Slices slices_of(const Columns& columns) {
    // Eight columns make 8x8 bits, transposed to eight columns of each slice; then 8x8 bytes are transposed likewise.
    Slices s;
    for (int group = 0; group < 8; ++group) {
        uint64_t v = 0;
        for (int i = 0; i < 8; ++i)
            v |= uint64_t{columns[8 * group + i]} << 8 * i;
        v = exchange_blocks(v, 7, 0x00AA'00AA'00AA'00AA);
        v = exchange_blocks(v, 14, 0x0000'CCCC'0000'CCCC);
        s[group] = exchange_blocks(v, 28, 0x0000'0000'F0F0'F0F0);
    }
    auto exchange = [&s](int a, int b, int distance, uint64_t mask) {
        const uint64_t t = (s[a] >> distance ^ s[b]) & mask;
        s[a] ^= t << distance;
        s[b] ^= t;
    };
    for (int i = 0; i < 4; ++i)
        exchange(i, i + 4, 32, 0x0000'0000'FFFF'FFFF);
    for (int i : {0, 1, 4, 5})
        exchange(i, i + 2, 16, 0x0000'FFFF'0000'FFFF);
    for (int i : {0, 2, 4, 6})
        exchange(i, i + 1, 8, 0x00FF'00FF'00FF'00FF);
    return s;
}

/// Slice order to Morton order: word {z2,y2,x2}, bit {z1,y1,x1,z0,y0,x0}.
///
/// A nibble of a slice is a square of 2x2 columns. The nibbles of slices z0 = 0 and 1 alternate; 16 bits of a slice,
/// spread so to 32, are the half z1 of a word.
inline Slices morton_order(const Slices& slices) {
    constexpr uint64_t nibbles = 0x0F0F'0F0F'0F0F'0F0F;
    auto spread_bytes = [](uint64_t v) {
        v = (v | v << 16) & 0x0000'FFFF'0000'FFFF;
        return (v | v << 8) & 0x00FF'00FF'00FF'00FF;
    };
    Slices words{};
    for (int z = 0; z < kBrickSide; z += 2) {
        const uint64_t below = slices[z], above = slices[z + 1];
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
