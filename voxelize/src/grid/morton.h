// Morton codes (Z-order): bit 3k of the code is bit k of x, bit 3k+1 of y, bit 3k+2 of z. The lowest three bits are an
// octant's index in its block, {z, y, x}.
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

/// Moves bit k of the low 16 bits to bit 3k.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
    v &= 0xFFFF;
    v = (v | v << 16) & 0x0000'0000'FF00'00FF;
    v = (v | v << 8) & 0x0000'00F0'0F00'F00F;
    v = (v | v << 4) & 0x0000'0C30'C30C'30C3;
    v = (v | v << 2) & 0x0000'2492'4924'9249;
    return v;
}
static_assert([] {
    for (int k = 0; k < 16; ++k)
        if (spread_bits(std::uint64_t{1} << k) != std::uint64_t{1} << 3 * k)
            return false;
    return spread_bits(0xFFFF) == 0x0000'2492'4924'9249;
}());

/// The code of a position of 16 bits per axis.
constexpr std::uint64_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// Moves bit 3k to bit k, for 16 bits; others are lost.
constexpr std::uint32_t gather_bits(std::uint64_t v) {
    v &= 0x0000'2492'4924'9249;
    v = (v | v >> 2) & 0x0000'0C30'C30C'30C3;
    v = (v | v >> 4) & 0x0000'00F0'0F00'F00F;
    v = (v | v >> 8) & 0x0000'0000'FF00'00FF;
    v = (v | v >> 16) & 0xFFFF;
    return static_cast<std::uint32_t>(v);
}
static_assert([] {
    for (int k = 0; k < 16; ++k)
        if (gather_bits(std::uint64_t{1} << 3 * k) != std::uint32_t{1} << k)
            return false;
    return gather_bits(~std::uint64_t{0}) == 0xFFFF;
}());

} // namespace voxrt::voxelize
