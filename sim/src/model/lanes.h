// Eight doubles side by side, in the widest registers that the including file is compiled for.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace voxrt::model {
namespace { // internal: the same names are compiled for several instruction sets

constexpr int kLanes = 8;

typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));
typedef int32_t IntLanes __attribute__((vector_size(kLanes * sizeof(int32_t))));

inline Lanes all(double x) { return Lanes{x, x, x, x, x, x, x, x}; }

// Masks are bytes: bit i stands for lane i.
using Mask = uint8_t;

// A byte of value 1 for each lane of the mask, 0 for the others, lane 0 lowest.
inline uint64_t bytes_of(Mask mask) {
    const uint64_t bits = mask * 0x0101010101010101u & 0x8040201008040201u;
    return (bits + 0x7F7F7F7F7F7F7F7Fu) >> 7 & 0x0101010101010101u;
}

#if defined(__AVX512F__)

inline Lanes larger(Lanes a, Lanes b) { return _mm512_maskz_max_pd(0xFF, a, b); }
inline Lanes smaller(Lanes a, Lanes b) { return _mm512_maskz_min_pd(0xFF, a, b); }
inline Mask less(Lanes a, Lanes b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
inline Mask equal(Lanes a, Lanes b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
inline Lanes choose(Mask mask, Lanes yes, Lanes no) { return _mm512_mask_blend_pd(mask, no, yes); }

#else

// Halves of the width of an AVX register; two of them, or four of SSE2 or NEON, are as fast as the compiler makes them.
typedef double Half __attribute__((vector_size(kLanes * sizeof(double) / 2)));
struct Halves {
    Half low, high;
};
inline Halves halves(Lanes a) {
    Halves out;
    std::memcpy(&out, &a, sizeof out);
    return out;
}
inline Lanes joined(Half low, Half high) {
    const Halves both{low, high};
    Lanes out;
    std::memcpy(&out, &both, sizeof out);
    return out;
}

#if defined(__AVX2__)

inline Lanes larger(Lanes a, Lanes b) {
    return joined(_mm256_max_pd(halves(a).low, halves(b).low), _mm256_max_pd(halves(a).high, halves(b).high));
}
inline Lanes smaller(Lanes a, Lanes b) {
    return joined(_mm256_min_pd(halves(a).low, halves(b).low), _mm256_min_pd(halves(a).high, halves(b).high));
}
template <int Relation> inline Mask compared(Lanes a, Lanes b) {
    const int low = _mm256_movemask_pd(_mm256_cmp_pd(halves(a).low, halves(b).low, Relation));
    const int high = _mm256_movemask_pd(_mm256_cmp_pd(halves(a).high, halves(b).high, Relation));
    return static_cast<Mask>(low | high << 4);
}
inline Mask less(Lanes a, Lanes b) { return compared<_CMP_LT_OQ>(a, b); }
inline Mask equal(Lanes a, Lanes b) { return compared<_CMP_EQ_OQ>(a, b); }
inline Lanes choose(Mask mask, Lanes yes, Lanes no) {
    const __m256i bits = _mm256_setr_epi64x(1, 2, 4, 8);
    const auto blended = [&](int four, Half if_set, Half if_not) -> Half {
        const __m256i set = _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(four), bits), bits);
        return _mm256_blendv_pd(if_not, if_set, _mm256_castsi256_pd(set));
    };
    return joined(blended(mask, halves(yes).low, halves(no).low),
                  blended(mask >> 4, halves(yes).high, halves(no).high));
}

#else

inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
template <class Truth> inline Mask mask_of(Truth truth) {
    int mask = 0;
    for (int lane = 0; lane < kLanes; ++lane)
        mask |= static_cast<int>(truth[lane] & 1) << lane;
    return static_cast<Mask>(mask);
}
inline Mask less(Lanes a, Lanes b) { return mask_of(a < b); }
inline Mask equal(Lanes a, Lanes b) { return mask_of(a == b); }
inline Lanes choose(Mask mask, Lanes yes, Lanes no) {
    for (int lane = 0; lane < kLanes; ++lane)
        no[lane] = mask >> lane & 1 ? yes[lane] : no[lane];
    return no;
}

#endif
#endif

} // namespace
} // namespace voxrt::model
