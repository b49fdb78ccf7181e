// Bricks of 8x8x8 voxels as the voxelizer works on them: eight slices along z, bit x + 8 y of a slice is a column.
//
// The slice order makes a column sweep eight steps of 64 columns; the result's Morton order is made once, at the end.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace voxrt {

using Slices = std::array<uint64_t, 8>;

inline constexpr int kBrickBits = 3;
inline constexpr int kBrickSide = 8;
inline constexpr int kBrickVoxels = 512;

inline bool is_full(const Slices& s) { return (s[0] & s[1] & s[2] & s[3] & s[4] & s[5] & s[6] & s[7]) == ~uint64_t{0}; }
inline bool is_empty(const Slices& s) { return (s[0] | s[1] | s[2] | s[3] | s[4] | s[5] | s[6] | s[7]) == 0; }

inline int count(const Slices& s) {
    int sum = 0;
    for (uint64_t slice : s)
        sum += std::popcount(slice);
    return sum;
}

/// Spreads the low 16 bits so that bit k goes to bit 3k.
constexpr uint64_t spread3(uint64_t v) {
    v &= 0xFFFF;
    v = (v | v << 16) & 0x0000'00FF'0000'00FF;
    v = (v | v << 8) & 0x0000'F00F'0000'F00F;
    v = (v | v << 4) & 0x000C'30C3'000C'30C3;
    v = (v | v << 2) & 0x0000'2492'4924'9249;
    return v;
}

constexpr uint64_t morton(uint32_t x, uint32_t y, uint32_t z) { return spread3(x) | spread3(y) << 1 | spread3(z) << 2; }

/// Exchanges bits `high` and `low` of the index of every bit of v.
template <int high, int low> constexpr uint64_t exchange_index_bits(uint64_t v) {
    uint64_t mask = 0;
    for (int i = 0; i < 64; ++i)
        if (!(i >> high & 1) && (i >> low & 1))
            mask |= uint64_t{1} << i;
    constexpr int distance = (1 << high) - (1 << low);
    const uint64_t t = (v ^ v >> distance) & mask;
    return v ^ t ^ t << distance;
}

/// Slice order to Morton order: word {z2,y2,x2}, bit {z1,y1,x1,z0,y0,x0}.
inline Slices morton_order(const Slices& slices) {
    Slices words{};
    for (int z = 0; z < kBrickSide; ++z) {
        // y2 y1 y0 x2 x1 x0 -> y2 x2 y1 x1 y0 x0: four groups of 16 bits, one an octant {y2,x2}.
        uint64_t v = exchange_index_bits<3, 2>(slices[z]);
        v = exchange_index_bits<4, 3>(v);
        v = exchange_index_bits<2, 1>(v);
        const int shift = 4 * (z & 1) + 32 * (z >> 1 & 1);
        for (int octant = 0; octant < 4; ++octant) {
            uint64_t group = v >> (16 * octant) & 0xFFFF;
            group = (group | group << 8) & 0x00FF'00FF;
            group = (group | group << 4) & 0x0F0F'0F0F;
            words[(z >> 2) * 4 + octant] |= group << shift;
        }
    }
    return words;
}

} // namespace voxrt
