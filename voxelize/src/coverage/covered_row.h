// The covered voxels of a row of columns, and how they lie in bricks: eight columns at a time.
#pragma once

#include <algorithm>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace voxrt::voxelize {

inline constexpr int kTileSide = 64;

/// What a triangle covers in row `y` of a window: an interval per column, by the column's number in the window. Columns
/// beside from … to that share eight columns with them are empty.
struct CoveredRow {
    int y;
    int from, to;
    int crossed_from, crossed_to; // the columns whose rays cross the triangle; crossings are marked at lo
    bool enters;                  // how they cross
    alignas(16) int32_t lo[kTileSide], hi[kTileSide]; // inclusive

    /// Starts row `row` of the columns first … last; those beside them are made empty.
    void begin(int row, int first, int last) {
        y = row;
        from = first;
        to = last;
        for (int i = first & ~7; i < first; ++i)
            set_empty(i);
        for (int i = last + 1; i <= (last | 7); ++i)
            set_empty(i);
    }
    void set(int column, int low, int high) {
        lo[column] = low;
        hi[column] = high;
    }
    void set_empty(int column) { set(column, kNowhere, -1); }
    bool is_empty(int column) const { return hi[column] < lo[column]; }

    static constexpr int32_t kNowhere = 1 << 30; // above all voxels
};

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
inline ColumnBytes bytes_of(FourInts low, FourInts high) {
    const __m128i words = _mm_packs_epi32(low, high);
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
inline ColumnBytes bytes_of(FourInts low, FourInts high) {
    const v128_t words = wasm_i16x8_narrow_i32x4(low, high);
    return static_cast<ColumnBytes>(wasm_i64x2_extract_lane(wasm_u8x16_narrow_i16x8(words, words), 0));
}
#endif

} // namespace coverage

/// The voxels base … base + 7 of eight intervals: those inside, and those that an interval begins with.
struct IntervalBytes {
    ColumnBytes inside = 0, begins = 0;

    /// `lo` and `hi` stand at multiples of 16 bytes. Without `wants_begins`, none is given.
    IntervalBytes(const int32_t* lo, const int32_t* hi, int base, bool wants_begins) {
#if defined(VOXRT_FOUR_NUMBERS)
        using namespace coverage;
        // 2^x of whole numbers: x is the exponent of a float32.
        auto power_of_two = [](FourFloats x) { return from_bits(whole(scaled(x, 127, 1 << 23))); };
        FourInts within[2], first[2];
        for (int half = 0; half < 2; ++half) {
            const FourFloats from = less(load_four(lo + 4 * half), base);
            const FourFloats end = less(load_four(hi + 4 * half), base - 1);
            const FourFloats lowest = power_of_two(clamped(from, 0, 8));
            within[half] = whole(clamped(difference(power_of_two(clamped(end, 0, 8)), lowest), 0, 255));
            first[half] = whole(where(from, 0, 8, lowest));
        }
        inside = bytes_of(within[0], within[1]);
        if (wants_begins)
            begins = bytes_of(first[0], first[1]);
#else
        for (int i = 0; i < 8; ++i) {
            const int from = std::clamp(lo[i] - base, 0, 8), end = std::clamp(hi[i] - base + 1, from, 8);
            inside |= static_cast<ColumnBytes>((1u << end) - (1u << from)) << 8 * i;
            if (wants_begins && lo[i] >= base && lo[i] < base + 8)
                begins |= ColumnBytes{1} << (8 * i + from);
        }
#endif
    }
};

} // namespace voxrt::voxelize
