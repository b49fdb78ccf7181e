// How much surface a mesh has for the axes of a grid: it tells how many voxels the mesh meets.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace voxrt::voxelize {

/// The sum of the areas of triangles, each as seen along the axis that it faces most. `positions`: 3 per vertex, float
/// or double. `triangles`: vertices. `transform`: rows of an affine map (3x4), which places the triangles.
template <class Real>
double projected_area(std::span<const Real> positions, std::span<const int32_t> triangles,
                      std::span<const double, 12> transform) {
    const auto placed_edge = [&](const Real* from, const Real* to) {
        const double x = double(to[0]) - double(from[0]), y = double(to[1]) - double(from[1]),
                     z = double(to[2]) - double(from[2]);
        std::array<double, 3> edge;
        for (size_t axis = 0; axis < 3; ++axis)
            edge[axis] = transform[4 * axis] * x + transform[4 * axis + 1] * y + transform[4 * axis + 2] * z;
        return edge;
    };
    const auto corner = [&](size_t i) { return positions.data() + 3 * static_cast<size_t>(triangles[i]); };
    double doubled = 0;
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
        const auto u = placed_edge(corner(i), corner(i + 1)), v = placed_edge(corner(i), corner(i + 2));
        doubled += std::max({std::abs(u[1] * v[2] - u[2] * v[1]), std::abs(u[2] * v[0] - u[0] * v[2]),
                             std::abs(u[0] * v[1] - u[1] * v[0])});
    }
    return doubled / 2;
}

} // namespace voxrt::voxelize
