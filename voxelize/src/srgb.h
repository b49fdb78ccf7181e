// Linear light and sRGB of 8 bits, by the exact curve: IEC 61966-2-1:1999, with its amendment's thresholds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace voxrt::voxelize {

/// Encodes linear light, clipped to 0 … 1 first, and rounds to the nearest (halves up). Not a number: 0.
inline uint8_t srgb_from_linear(double linear) {
    const double light = linear > 0 ? std::min(linear, 1.0) : 0.0;
    const double encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    return static_cast<uint8_t>(std::floor(encoded * 255.0 + 0.5));
}

inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

} // namespace voxrt::voxelize
