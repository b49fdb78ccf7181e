#include "vector_coverage.h"

#include "../vectors/instruction_sets.h"

#include <cmath>

namespace voxrt::voxelize {

namespace {

constexpr int64_t kWideExtent = int64_t{1} << 24;

/// The normal of a triangle, rounded.
struct Normal {
    double x, y, z;

    Normal(const Vertex& a, const Vertex& b, const Vertex& c) {
        const double u[3] = {double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
        const double v[3] = {double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
        x = u[1] * v[2] - u[2] * v[1];
        y = u[2] * v[0] - u[0] * v[2];
        z = u[0] * v[1] - u[1] * v[0];
    }
};

/// Whether heights of the plane of a wide triangle are exact in doubles wherever the triangle's box is.
bool is_flat_enough(const Vertex& a, const Vertex& b, const Vertex& c) {
    const Normal n(a, b, c);
    return n.z == 0 || std::abs(n.x) + std::abs(n.y) < std::abs(n.z) * 0x1p37;
}

} // namespace

bool fits_vectors(const Vertex& a, const Vertex& b, const Vertex& c) {
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    const auto [low_z, high_z] = std::minmax({a.z, b.z, c.z});
    const int64_t extent = std::max({int64_t{high_x} - low_x, int64_t{high_y} - low_y, int64_t{high_z} - low_z});
    if (low_z < 0 || extent >= kWideExtent)
        return false;
    // The last voxel of each axis, from the first: -1 where the triangle is flat on a plane.
    const int x = voxel_below(high_x) - voxel_floor(low_x), y = voxel_below(high_y) - voxel_floor(low_y),
              z = voxel_below(high_z) - voxel_floor(low_z);
    return x >= 0 && y >= 0 && z >= 0 && (x > 0) + (y > 0) + (z > 0) > 1 &&
           (extent < kNarrowExtent || is_flat_enough(a, b, c));
}

bool fits_pieces(const Vertex& a, const Vertex& b, const Vertex& c, int top, double limit) {
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    const auto [low_z, high_z] = std::minmax({a.z, b.z, c.z});
    const double extent = std::max({double(high_x) - low_x, double(high_y) - low_y, double(high_z) - low_z});
    const Normal n(a, b, c);
    return high_z <= (top + 1) * kUnit && extent < kNarrowExtent &&
           std::abs(n.z) * limit * kUnit > (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) * extent;
}

const std::vector<CoverageEngine>& coverage_engines() {
    static const std::vector<CoverageEngine> engines = [] {
        std::vector<CoverageEngine> found;
#if defined(__x86_64__)
        if (has_avx512())
            found.push_back(kAvx512Coverage);
        if (has_avx2())
            found.push_back(kAvx2Coverage);
#endif
#if defined(__wasm__)
        found.push_back({"portable", nullptr, nullptr, nullptr, nullptr});
#else
        found.push_back(kPortableCoverage);
#endif
        return found;
    }();
    return engines;
}

} // namespace voxrt::voxelize
