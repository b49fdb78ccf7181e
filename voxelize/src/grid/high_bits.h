// The highest bit of each of 16 bytes, as a number: one instruction where the processor has it.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace voxrt::voxelize {

/// 16 bytes, the lowest first. high_bits(): bit i is the highest bit of byte i. doubled(): each byte times 2, modulo
/// 256.
#if defined(__SSE2__)
using Bytes16 = __m128i;
inline Bytes16 bytes_of(uint64_t low, uint64_t high) {
    return _mm_set_epi64x(static_cast<int64_t>(high), static_cast<int64_t>(low));
}
inline uint32_t high_bits(Bytes16 v) { return static_cast<uint32_t>(_mm_movemask_epi8(v)); }
inline Bytes16 doubled(Bytes16 v) { return _mm_add_epi8(v, v); }
#elif defined(__wasm_simd128__)
using Bytes16 = v128_t;
inline Bytes16 bytes_of(uint64_t low, uint64_t high) { return wasm_u64x2_make(low, high); }
inline uint32_t high_bits(Bytes16 v) { return wasm_i8x16_bitmask(v); }
inline Bytes16 doubled(Bytes16 v) { return wasm_i8x16_add(v, v); }
#else
struct Bytes16 {
    uint64_t low, high;
};
inline Bytes16 bytes_of(uint64_t low, uint64_t high) { return {low, high}; }
inline uint32_t high_bits(Bytes16 v) {
    // The product gathers the highest bits of eight bytes in the highest byte.
    constexpr uint64_t highest = 0x8080'8080'8080'8080, gather = 0x0002'0408'1020'4081;
    auto bits = [](uint64_t half) { return static_cast<uint32_t>((half & highest) * gather >> 56); };
    return bits(v.low) | bits(v.high) << 8;
}
inline Bytes16 doubled(Bytes16 v) {
    constexpr uint64_t lower = 0x7F7F'7F7F'7F7F'7F7F;
    return {(v.low & lower) << 1, (v.high & lower) << 1};
}
#endif

} // namespace voxrt::voxelize
