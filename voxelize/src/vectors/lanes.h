// Eight doubles side by side, in registers as wide as the including file is compiled for.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace voxrt {
namespace { // internal: the same names are compiled for several instruction sets

constexpr int kLanes = 8;

// Masks are bytes: bit i stands for lane i.
using Mask = uint8_t;

// A byte of value 1 for each lane of the mask, 0 for the others, lane 0 lowest.
inline uint64_t bytes_of(Mask mask) {
    const uint64_t bits = mask * 0x0101010101010101u & 0x8040201008040201u;
    return (bits + 0x7F7F7F7F7F7F7F7Fu) >> 7 & 0x0101010101010101u;
}

// A register's worth of lanes, and what compilers have no operator for. choose() takes `yes` where the mask is set.
// larger() and smaller() take b where a is not a number.
#if defined(__AVX512F__)

constexpr int kPartLanes = 8;
typedef double Part __attribute__((vector_size(kPartLanes * sizeof(double))));
inline Part larger(Part a, Part b) { return _mm512_maskz_max_pd(0xFF, a, b); }
inline Part smaller(Part a, Part b) { return _mm512_maskz_min_pd(0xFF, a, b); }
inline uint32_t less(Part a, Part b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
inline uint32_t equal(Part a, Part b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
inline Part choose(uint32_t mask, Part yes, Part no) {
    return _mm512_mask_blend_pd(static_cast<__mmask8>(mask), no, yes);
}
inline Part if_less(Part a, Part b, Part yes, Part no) { return choose(less(a, b), yes, no); }

#elif defined(__AVX2__)

constexpr int kPartLanes = 4;
typedef double Part __attribute__((vector_size(kPartLanes * sizeof(double))));
inline Part larger(Part a, Part b) { return _mm256_max_pd(a, b); }
inline Part smaller(Part a, Part b) { return _mm256_min_pd(a, b); }
inline uint32_t less(Part a, Part b) {
    return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LT_OQ)));
}
inline uint32_t equal(Part a, Part b) {
    return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_EQ_OQ)));
}
inline Part choose(uint32_t mask, Part yes, Part no) {
    const __m256i bits = _mm256_setr_epi64x(1, 2, 4, 8);
    const __m256i set = _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(mask), bits), bits);
    return _mm256_blendv_pd(no, yes, _mm256_castsi256_pd(set));
}
inline Part if_less(Part a, Part b, Part yes, Part no) {
    return _mm256_blendv_pd(no, yes, _mm256_cmp_pd(a, b, _CMP_LT_OQ));
}

#else

constexpr int kPartLanes = 2;
typedef double Part __attribute__((vector_size(kPartLanes * sizeof(double))));
typedef int64_t PartTruth __attribute__((vector_size(kPartLanes * sizeof(int64_t))));
#if defined(__SSE2__)
inline Part larger(Part a, Part b) { return _mm_max_pd(a, b); }
inline Part smaller(Part a, Part b) { return _mm_min_pd(a, b); }
inline uint32_t mask_of(PartTruth truth) {
    return static_cast<uint32_t>(_mm_movemask_pd(_mm_castsi128_pd(reinterpret_cast<__m128i>(truth))));
}
#elif defined(__wasm_simd128__)
inline Part larger(Part a, Part b) {
    return reinterpret_cast<Part>(wasm_f64x2_pmax(reinterpret_cast<v128_t>(b), reinterpret_cast<v128_t>(a)));
}
inline Part smaller(Part a, Part b) {
    return reinterpret_cast<Part>(wasm_f64x2_pmin(reinterpret_cast<v128_t>(b), reinterpret_cast<v128_t>(a)));
}
inline uint32_t mask_of(PartTruth truth) { return wasm_i64x2_bitmask(reinterpret_cast<v128_t>(truth)); }
#else
inline Part larger(Part a, Part b) { return a > b ? a : b; }
inline Part smaller(Part a, Part b) { return a < b ? a : b; }
inline uint32_t mask_of(PartTruth truth) { return static_cast<uint32_t>((truth[0] & 1) | (truth[1] & 2)); }
#endif
inline uint32_t less(Part a, Part b) { return mask_of(a < b); }
inline uint32_t equal(Part a, Part b) { return mask_of(a == b); }
inline Part choose(uint32_t mask, Part yes, Part no) {
    const PartTruth set{-static_cast<int64_t>(mask & 1), -static_cast<int64_t>(mask >> 1 & 1)};
    return set ? yes : no;
}
inline Part if_less(Part a, Part b, Part yes, Part no) { return a < b ? yes : no; }

#endif

constexpr int kParts = kLanes / kPartLanes;

struct Lanes {
    Part part[kParts];
};

inline Lanes load(const double* from) {
    Lanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
inline void store(double* to, const Lanes& a) { std::memcpy(to, &a, sizeof a); }

// Eight integers.
typedef int64_t LongPart __attribute__((vector_size(kPartLanes * sizeof(int64_t))));
struct LongLanes {
    LongPart part[kParts];
};

template <class Operation> inline Lanes each(const Operation& operation) {
    Lanes out;
    for (int i = 0; i < kParts; ++i)
        out.part[i] = operation(i);
    return out;
}
template <class Relation> inline Mask joined(const Relation& relation) {
    uint32_t mask = 0;
    for (int i = 0; i < kParts; ++i)
        mask |= relation(i) << i * kPartLanes;
    return static_cast<Mask>(mask);
}

inline Lanes all(double x) {
    return each([&](int) { return x - Part{}; });
}
// x, x + step, x + 2 step ...
inline Lanes ramp(double x, double step) {
    alignas(64) double values[kLanes];
    for (int lane = 0; lane < kLanes; ++lane)
        values[lane] = x + step * lane;
    return load(values);
}
inline Lanes operator+(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.part[i] + b.part[i]; });
}
inline Lanes operator-(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.part[i] - b.part[i]; });
}
inline Lanes operator*(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.part[i] * b.part[i]; });
}
inline Lanes operator/(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.part[i] / b.part[i]; });
}
inline Lanes larger(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return larger(a.part[i], b.part[i]); });
}
inline Lanes smaller(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return smaller(a.part[i], b.part[i]); });
}
inline Mask less(const Lanes& a, const Lanes& b) {
    return joined([&](int i) { return less(a.part[i], b.part[i]); });
}
inline Mask equal(const Lanes& a, const Lanes& b) {
    return joined([&](int i) { return equal(a.part[i], b.part[i]); });
}
inline Lanes choose(Mask mask, const Lanes& yes, const Lanes& no) {
    return each([&](int i) { return choose(mask >> i * kPartLanes, yes.part[i], no.part[i]); });
}
// `yes` where a < b.
inline Lanes if_less(const Lanes& a, const Lanes& b, const Lanes& yes, const Lanes& no) {
    return each([&](int i) { return if_less(a.part[i], b.part[i], yes.part[i], no.part[i]); });
}
inline Lanes load_ints(const int32_t* from) {
    return each([&](int i) {
        typedef int32_t IntPart __attribute__((vector_size(kPartLanes * sizeof(int32_t))));
        IntPart part;
        std::memcpy(&part, from + i * kPartLanes, sizeof part);
        return __builtin_convertvector(part, Part);
    });
}
// Rounds toward zero; values must fit.
inline void store_as_int(int32_t* out, const Lanes& a) {
#if defined(__AVX2__) && !defined(__AVX512F__)
    // At once, so that a load of all lanes need not wait.
    const __m256i rounded = _mm256_set_m128i(_mm256_cvttpd_epi32(a.part[1]), _mm256_cvttpd_epi32(a.part[0]));
    std::memcpy(out, &rounded, sizeof rounded);
#else
    typedef int32_t IntPart __attribute__((vector_size(kPartLanes * sizeof(int32_t))));
    for (int i = 0; i < kParts; ++i) {
        const IntPart rounded = __builtin_convertvector(a.part[i], IntPart);
        std::memcpy(out + i * kPartLanes, &rounded, sizeof rounded);
    }
#endif
}

} // namespace
} // namespace voxrt
