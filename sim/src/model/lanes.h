// Eight doubles side by side, in the widest registers that the including file is compiled for.
#pragma once

#include <cstdint>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

// Internal linkage: the same names are compiled for several instruction sets in one module.
namespace voxrt::model {
namespace {

constexpr int kLanes = 8;

#if defined(__AVX512F__)

struct Lanes {
    __m512d v;
};
inline Lanes load(const double* p) { return {_mm512_load_pd(p)}; }
inline Lanes all(double x) { return {_mm512_set1_pd(x)}; }
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return {_mm512_fmadd_pd(a.v, b.v, c.v)}; }
inline Lanes larger(Lanes a, Lanes b) { return {_mm512_max_pd(a.v, b.v)}; }
inline Lanes smaller(Lanes a, Lanes b) { return {_mm512_min_pd(a.v, b.v)}; }
inline uint8_t less(Lanes a, Lanes b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ); }
inline void store(double* p, Lanes a, uint8_t mask) { _mm512_mask_store_pd(p, mask, a.v); }

#elif defined(__AVX2__)

struct Lanes {
    __m256d low, high;
};
inline Lanes load(const double* p) { return {_mm256_load_pd(p), _mm256_load_pd(p + 4)}; }
inline Lanes all(double x) { return {_mm256_set1_pd(x), _mm256_set1_pd(x)}; }
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return {_mm256_fmadd_pd(a.low, b.low, c.low), _mm256_fmadd_pd(a.high, b.high, c.high)};
}
inline Lanes larger(Lanes a, Lanes b) { return {_mm256_max_pd(a.low, b.low), _mm256_max_pd(a.high, b.high)}; }
inline Lanes smaller(Lanes a, Lanes b) { return {_mm256_min_pd(a.low, b.low), _mm256_min_pd(a.high, b.high)}; }
inline uint8_t less(Lanes a, Lanes b) {
    const int low = _mm256_movemask_pd(_mm256_cmp_pd(a.low, b.low, _CMP_LT_OQ));
    const int high = _mm256_movemask_pd(_mm256_cmp_pd(a.high, b.high, _CMP_LT_OQ));
    return static_cast<uint8_t>(low | high << 4);
}
inline void store(double* p, Lanes a, uint8_t mask) {
    const __m256i bits = _mm256_setr_epi64x(1, 2, 4, 8);
    const __m256i low = _mm256_and_si256(_mm256_set1_epi64x(mask), bits);
    const __m256i high = _mm256_and_si256(_mm256_set1_epi64x(mask >> 4), bits);
    _mm256_maskstore_pd(p, _mm256_cmpeq_epi64(low, bits), a.low);
    _mm256_maskstore_pd(p + 4, _mm256_cmpeq_epi64(high, bits), a.high);
}

#else

struct Lanes {
    double v[kLanes];
};
template <class Operation> inline Lanes each(Operation operation) {
    Lanes out;
    for (int i = 0; i < kLanes; ++i)
        out.v[i] = operation(i);
    return out;
}
inline Lanes load(const double* p) {
    return each([&](int i) { return p[i]; });
}
inline Lanes all(double x) {
    return each([&](int) { return x; });
}
inline Lanes multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
    return each([&](int i) { return a.v[i] * b.v[i] + c.v[i]; });
}
inline Lanes larger(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline Lanes smaller(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline uint8_t less(const Lanes& a, const Lanes& b) {
    int mask = 0;
    for (int i = 0; i < kLanes; ++i)
        mask |= (a.v[i] < b.v[i]) << i;
    return static_cast<uint8_t>(mask);
}
inline void store(double* p, const Lanes& a, uint8_t mask) {
    for (int i = 0; i < kLanes; ++i)
        if (mask >> i & 1)
            p[i] = a.v[i];
}

#endif

} // namespace
} // namespace voxrt::model
