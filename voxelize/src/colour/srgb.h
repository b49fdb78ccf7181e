// Linear light and sRGB of 8 bits, by the exact curve: IEC 61966-2-1:1999, with its amendment's thresholds 0.0031308
// and 0.04045. Everything rests on two tables that are made of sums, products and quotients alone, so that all
// platforms have the same values.
#pragma once

#include <array>
#include <cstdint>

namespace voxrt::voxelize {

class SrgbCurve {
public:
    static const SrgbCurve& get() {
        static const SrgbCurve curve;
        return curve;
    }

    /// The linear light of each code, 0 … 1.
    const std::array<double, 256>& linear() const { return linear_; }

    /// Encodes linear light, clipped to 0 … 1 first, and rounds to the nearest (halves up). Not a number: 0.
    uint8_t encode(double linear) const {
        if (!(linear > 0))
            return 0;
        if (linear >= 1)
            return 255;
        unsigned code = first_[static_cast<unsigned>(linear * kBuckets)];
        while (code < 255 && linear >= threshold_[code + 1])
            ++code;
        return static_cast<uint8_t>(code);
    }

private:
    static constexpr unsigned kBuckets = 4096;

    SrgbCurve();

    std::array<double, 256> linear_;
    std::array<double, 256> threshold_;   // the least light of a code
    std::array<uint8_t, kBuckets> first_; // the code of the least light of a bucket
};

inline uint8_t srgb_from_linear(double linear) { return SrgbCurve::get().encode(linear); }

} // namespace voxrt::voxelize
