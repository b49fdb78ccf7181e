// How intervals of voxels lie in bricks: eight columns at a time.
#pragma once

#include <algorithm>
#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace voxrt::voxelize {

/// Eight columns beside each other, of a layer of bricks: byte i is column i, its bits are voxels along z.
using ColumnBytes = uint64_t;

namespace coverage {

// Four numbers at once, where the processor has instructions for them.
#if defined(__SSE2__)
#define VOXRT_FOUR_NUMBERS
using FourInts = __m128i;
using FourFloats = __m128;
inline FourInts load_four(const int32_t* from) { return _mm_load_si128(reinterpret_cast<const __m128i*>(from)); }
inline FourFloats less(FourInts a, int32_t b) { return _mm_cvtepi32_ps(_mm_sub_epi32(a, _mm_set1_epi32(b))); }
inline FourFloats clamped(FourFloats v, float low, float high) {
    return _mm_min_ps(_mm_max_ps(v, _mm_set1_ps(low)), _mm_set1_ps(high));
}
inline FourFloats difference(FourFloats a, FourFloats b) { return _mm_sub_ps(a, b); }
/// `yes` where low <= v < high, else 0.
inline FourFloats where(FourFloats v, float low, float high, FourFloats yes) {
    return _mm_and_ps(yes, _mm_and_ps(_mm_cmpge_ps(v, _mm_set1_ps(low)), _mm_cmplt_ps(v, _mm_set1_ps(high))));
}
inline FourFloats from_bits(FourInts v) { return _mm_castsi128_ps(v); }
inline FourInts whole(FourFloats v) { return _mm_cvttps_epi32(v); }
inline FourFloats scaled(FourFloats v, float offset, float scale) {
    return _mm_mul_ps(_mm_add_ps(v, _mm_set1_ps(offset)), _mm_set1_ps(scale));
}
/// Bits `shift` … `shift` + 7 of eight numbers.
inline ColumnBytes bytes_of(FourInts low, FourInts high, int shift) {
    const __m128i byte = _mm_set1_epi32(255), by = _mm_cvtsi32_si128(shift);
    const __m128i words =
        _mm_packs_epi32(_mm_and_si128(_mm_srl_epi32(low, by), byte), _mm_and_si128(_mm_srl_epi32(high, by), byte));
    return static_cast<ColumnBytes>(_mm_cvtsi128_si64(_mm_packus_epi16(words, words)));
}
#elif defined(__wasm_simd128__)
#define VOXRT_FOUR_NUMBERS
using FourInts = v128_t;
using FourFloats = v128_t;
inline FourInts load_four(const int32_t* from) { return wasm_v128_load(from); }
inline FourFloats less(FourInts a, int32_t b) {
    return wasm_f32x4_convert_i32x4(wasm_i32x4_sub(a, wasm_i32x4_splat(b)));
}
inline FourFloats clamped(FourFloats v, float low, float high) {
    return wasm_f32x4_pmin(wasm_f32x4_pmax(v, wasm_f32x4_splat(low)), wasm_f32x4_splat(high));
}
inline FourFloats difference(FourFloats a, FourFloats b) { return wasm_f32x4_sub(a, b); }
inline FourFloats where(FourFloats v, float low, float high, FourFloats yes) {
    return wasm_v128_and(
        yes, wasm_v128_and(wasm_f32x4_ge(v, wasm_f32x4_splat(low)), wasm_f32x4_lt(v, wasm_f32x4_splat(high))));
}
inline FourFloats from_bits(FourInts v) { return v; }
inline FourInts whole(FourFloats v) { return wasm_i32x4_trunc_sat_f32x4(v); }
inline FourFloats scaled(FourFloats v, float offset, float scale) {
    return wasm_f32x4_mul(wasm_f32x4_add(v, wasm_f32x4_splat(offset)), wasm_f32x4_splat(scale));
}
inline ColumnBytes bytes_of(FourInts low, FourInts high, int shift) {
    const v128_t byte = wasm_i32x4_splat(255);
    const v128_t words = wasm_i16x8_narrow_i32x4(wasm_v128_and(wasm_u32x4_shr(low, shift), byte),
                                                 wasm_v128_and(wasm_u32x4_shr(high, shift), byte));
    return static_cast<ColumnBytes>(wasm_i64x2_extract_lane(wasm_u8x16_narrow_i16x8(words, words), 0));
}
#endif

} // namespace coverage

/// Eight intervals and eight marks, brick by brick from voxel `base` on: the voxels inside, and those with a mark.
struct IntervalBytes {
#if defined(__AVX2__)
    static constexpr int kBricks = 4;
#else
    static constexpr int kBricks = 3;
#endif
    ColumnBytes inside[kBricks], marked[kBricks];

    /// `lo`, `hi` and `marks` stand at multiples of 32 bytes. An interval with hi < lo is empty.
    [[gnu::always_inline]] IntervalBytes(const int32_t* lo, const int32_t* hi, const int32_t* marks, int base) {
#if defined(__AVX2__)
        // Shifted by 32 and more, a one is lost. Shifts are without sign.
        const __m256i bases = _mm256_set1_epi32(base), none = _mm256_setzero_si256(), ones = _mm256_set1_epi32(1);
        const auto from_base = [&](const int32_t* voxels) {
            return _mm256_sub_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(voxels)), bases);
        };
        const __m256i first = _mm256_max_epi32(from_base(lo), none), last = from_base(hi);
        const __m256i end = _mm256_max_epi32(_mm256_sub_epi32(last, _mm256_set1_epi32(-1)), first);
        store(inside, _mm256_sub_epi32(_mm256_sllv_epi32(ones, end), _mm256_sllv_epi32(ones, first)));
        store(marked, _mm256_sllv_epi32(ones, from_base(marks)));
#elif defined(VOXRT_FOUR_NUMBERS)
        using namespace coverage;
        // 2^x of whole numbers: x is the exponent of a float32.
        auto power_of_two = [](FourFloats x) { return from_bits(whole(scaled(x, 127, 1 << 23))); };
        constexpr float height = 8 * kBricks;
        FourInts within[2], marks_within[2];
        for (int half = 0; half < 2; ++half) {
            const FourFloats from = less(load_four(lo + 4 * half), base),
                             mark = less(load_four(marks + 4 * half), base);
            const FourFloats end = less(load_four(hi + 4 * half), base - 1);
            const FourFloats lowest = power_of_two(clamped(from, 0, height));
            within[half] = whole(clamped(difference(power_of_two(clamped(end, 0, height)), lowest), 0, 1 << 24));
            marks_within[half] = whole(where(mark, 0, height, power_of_two(clamped(mark, 0, height))));
        }
        for (int i = 0; i < kBricks; ++i) {
            inside[i] = bytes_of(within[0], within[1], 8 * i);
            marked[i] = bytes_of(marks_within[0], marks_within[1], 8 * i);
        }
#else
        for (int brick = 0; brick < kBricks; ++brick, base += 8) {
            inside[brick] = marked[brick] = 0;
            for (int i = 0; i < 8; ++i) {
                const int from = std::clamp(lo[i] - base, 0, 8), end = std::clamp(hi[i] - base + 1, from, 8);
                inside[brick] |= static_cast<ColumnBytes>((1u << end) - (1u << from)) << 8 * i;
                if (marks[i] >= base && marks[i] < base + 8)
                    marked[brick] |= ColumnBytes{1} << (8 * i + marks[i] - base);
            }
        }
#endif
    }

#if defined(__AVX2__)
private:
    /// Stores bytes 0, 1, 2 and 3 of eight numbers, each as eight bytes.
    [[gnu::always_inline]] static void store(ColumnBytes* to, __m256i numbers) {
        const __m256i by_byte =
            _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15));
        const __m256i halves = _mm256_shuffle_epi8(numbers, by_byte);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_permutevar8x32_epi32(halves, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7)));
    }
#endif
};

} // namespace voxrt::voxelize
