// Sums of products that do not fit 128 bits.
#pragma once

#include "fixed_point.h"

#include <compare>

namespace voxrt::voxelize {

/// An integer below 2^190 in magnitude: high * 2^64 + low.
struct WideInteger {
    int128 high = 0;
    uint64_t low = 0;

    /// Adds a * b; |a| < 2^126 and |b| < 2^62, and at most eight times.
    void add(int128 a, int64_t b) {
        const int128 upper = (a >> 64) * b, lower = int128(uint64_t(a)) * b + int128(low);
        low = uint64_t(lower);
        high += upper + (lower >> 64);
    }
    std::strong_ordering operator<=>(const WideInteger&) const = default;
};

} // namespace voxrt::voxelize
