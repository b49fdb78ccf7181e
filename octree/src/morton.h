// Morton codes: bit 3k of the code is bit k of x, bit 3k+1 of y, bit 3k+2 of z.
#pragma once

#include <cstdint>

namespace voxrt::octree {

/// Bits 0, 3, 6 ... of `code`, packed.
constexpr std::uint32_t compact_bits(std::uint64_t code) {
    code &= 0x1249249249249249u;
    code = (code | code >> 2) & 0x10C30C30C30C30C3u;
    code = (code | code >> 4) & 0x100F00F00F00F00Fu;
    code = (code | code >> 8) & 0x001F0000FF0000FFu;
    code = (code | code >> 16) & 0x001F00000000FFFFu;
    code = (code | code >> 32) & 0x00000000001FFFFFu;
    return static_cast<std::uint32_t>(code);
}

/// Bit k of `value` (16 bits) at bit 3k.
constexpr std::uint64_t spread_bits(std::uint32_t value) {
    std::uint64_t code = value & 0xFFFFu;
    code = (code | code << 16) & 0x00FF0000FF0000FFu;
    code = (code | code << 8) & 0xF00F00F00F00F00Fu;
    code = (code | code << 4) & 0x30C30C30C30C30C3u;
    code = (code | code << 2) & 0x9249249249249249u;
    return code;
}

} // namespace voxrt::octree
