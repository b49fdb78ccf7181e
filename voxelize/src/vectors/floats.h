// Eight floats side by side, for what need not be exact (lanes.h).
#pragma once

#include "lanes.h"

namespace voxrt {
namespace { // internal: the same names are compiled for several instruction sets

constexpr int kFloatPartLanes = kPartLanes < 4 ? 4 : 8;
typedef float FloatPart __attribute__((vector_size(kFloatPartLanes * sizeof(float))));
struct Floats {
    FloatPart part[kLanes / kFloatPartLanes];
};
template <class Operation> inline Floats each_float(const Operation& operation) {
    Floats out;
    for (int i = 0; i < kLanes / kFloatPartLanes; ++i)
        out.part[i] = operation(i);
    return out;
}
inline Floats load_floats(const float* from) {
    Floats out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
inline Lanes load(const float* from) {
    typedef float Some __attribute__((vector_size(kPartLanes * sizeof(float))));
    return each([&](int i) {
        Some part;
        std::memcpy(&part, from + i * kPartLanes, sizeof part);
        return __builtin_convertvector(part, Part);
    });
}
inline void store(float* to, const Floats& a) { std::memcpy(to, &a, sizeof a); }
inline Floats floats(const Lanes& a) {
    return each_float([&](int i) {
#if defined(__AVX512F__)
        return __builtin_convertvector(a.part[i], FloatPart);
#elif defined(__AVX2__)
        return FloatPart(_mm256_set_m128(_mm256_cvtpd_ps(a.part[2 * i + 1]), _mm256_cvtpd_ps(a.part[2 * i])));
#elif defined(__SSE2__)
        return FloatPart(_mm_movelh_ps(_mm_cvtpd_ps(a.part[2 * i]), _mm_cvtpd_ps(a.part[2 * i + 1])));
#else
        FloatPart out;
        for (int lane = 0; lane < kFloatPartLanes; ++lane) {
            const int from = i * kFloatPartLanes + lane;
            out[lane] = static_cast<float>(a.part[from / kPartLanes][from % kPartLanes]);
        }
        return out;
#endif
    });
}
inline Floats all_floats(float x) {
    return each_float([&](int) { return x - FloatPart{}; });
}
inline Floats operator+(const Floats& a, const Floats& b) {
    return each_float([&](int i) { return a.part[i] + b.part[i]; });
}
inline Floats larger(const Floats& a, const Floats& b) {
    return each_float([&](int i) { return a.part[i] > b.part[i] ? a.part[i] : b.part[i]; });
}
inline Floats smaller(const Floats& a, const Floats& b) {
    return each_float([&](int i) { return a.part[i] < b.part[i] ? a.part[i] : b.part[i]; });
}
inline Floats choose(Mask mask, const Floats& yes, const Floats& no) {
    typedef int32_t Bits __attribute__((vector_size(kFloatPartLanes * sizeof(int32_t))));
    Bits bits;
    for (int lane = 0; lane < kFloatPartLanes; ++lane)
        bits[lane] = 1 << lane;
    return each_float([&](int i) {
        const Bits set = bits & (mask >> i * kFloatPartLanes);
        return set != 0 ? yes.part[i] : no.part[i];
    });
}

} // namespace
} // namespace voxrt
