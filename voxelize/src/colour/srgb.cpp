#include "srgb.h"

namespace voxrt::voxelize {
namespace {

/// The fifth root of a number in 0 … 1, by Newton's method: it descends from 1 until rounding stops it.
double fifth_root(double number) {
    double root = 1;
    for (;;) {
        const double square = root * root, fourth = square * square;
        const double next = root - (fourth * root - number) / (5 * fourth);
        if (!(next < root))
            return root;
        root = next;
    }
}

double decode(double encoded) {
    if (encoded <= 0.04045)
        return encoded / 12.92;
    const double base = (encoded + 0.055) / 1.055, square = base * base;
    return square * fifth_root(square); // base to the power of 2.4
}

} // namespace

SrgbCurve::SrgbCurve() {
    for (unsigned code = 0; code < 256; ++code) {
        linear_[code] = decode(code / 255.0);
        threshold_[code] = code == 0 ? 0 : decode((code - 0.5) / 255);
    }
    unsigned code = 0;
    for (unsigned bucket = 0; bucket < kBuckets; ++bucket) {
        while (code < 255 && double(bucket) / kBuckets >= threshold_[code + 1])
            ++code;
        first_[bucket] = static_cast<uint8_t>(code);
    }
}

} // namespace voxrt::voxelize
