// Fixed-point grid space: where every decision about coverage is made.
//
// A coordinate is an integer in units of 1/4096 voxel; voxel v covers [v * kUnit, (v + 1) * kUnit). Vertices are
// rounded to it once (which absorbs the noise of float32 files, so that faces meant to lie on planes between voxels
// do). From there on all arithmetic is exact.
//
// Range: |coordinate| <= kCoordinateLimit, that is 2^18 voxels. Products of a triangle up to kNarrowExtent wide fit
// int64; wider triangles use __int128 (3 coordinates of 2^31 multiply to less than 2^97).
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

inline constexpr int kFractionBits = 12;
inline constexpr int64_t kUnit = int64_t{1} << kFractionBits; // of a voxel
inline constexpr int64_t kCoordinateLimit = int64_t{1} << 30;
inline constexpr int64_t kTinyExtent = int64_t{1} << 15;
inline constexpr int64_t kNarrowExtent = int64_t{1} << 19;

using int128 = __int128;

/// A vertex in grid space, 1/4096 voxel.
struct Vertex {
    int32_t x, y, z;
    bool operator==(const Vertex&) const = default;
};

/// floor(a / b), b > 0. Divisions of int128 are calls; most have numbers that fit 64 bits.
template <typename T> constexpr T floor_div(T a, T b) {
    if constexpr (sizeof(T) > sizeof(int64_t)) {
        if (a == static_cast<int64_t>(a) && b == static_cast<int64_t>(b))
            return floor_div(static_cast<int64_t>(a), static_cast<int64_t>(b));
    }
    const T q = a / b;
    return q - (a - q * b < 0 ? 1 : 0);
}

/// Index of the voxel that holds a coordinate: floor(coordinate / kUnit).
constexpr int voxel_floor(int64_t coordinate) { return static_cast<int>(coordinate >> kFractionBits); }

/// Index of the last voxel whose interior reaches below a coordinate: ceil(coordinate / kUnit) - 1.
constexpr int voxel_below(int64_t coordinate) { return static_cast<int>((coordinate - 1) >> kFractionBits); }

} // namespace voxrt::voxelize
