// Which vertices of a mesh its triangles use. The others have no place: they must stretch no bounds, and may be far
// away.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::voxelize {

/// A byte per vertex: 1 where a triangle uses it. `triangles`: vertices below `vertices`.
inline std::vector<uint8_t> used_vertices(std::span<const int32_t> triangles, size_t vertices) {
    std::vector<uint8_t> used(vertices, 0);
    for (const int32_t vertex : triangles)
        used[static_cast<size_t>(vertex)] = 1;
    return used;
}

/// Whether the corners of a triangle lie on one line, as far as float64 tells. Of any size.
template <class Real> bool has_no_area(const Real* a, const Real* b, const Real* c) {
    double u[3], v[3], largest = 0;
    for (int i = 0; i < 3; ++i) {
        u[i] = double(b[i]) - double(a[i]);
        v[i] = double(c[i]) - double(a[i]);
        largest = std::max({largest, std::abs(u[i]), std::abs(v[i])});
    }
    if (!(largest > 0))
        return largest == 0;
    for (int i = 0; i < 3; ++i) {
        u[i] /= largest;
        v[i] /= largest;
    }
    return u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0];
}

/// As used_vertices(), but for triangles without area, which must stretch no bounds either; as that if there are no
/// others. `positions`: 3 per vertex.
template <class Real>
std::vector<uint8_t> spanning_vertices(std::span<const int32_t> triangles, std::span<const Real> positions) {
    std::vector<uint8_t> used(positions.size() / 3, 0);
    bool any = false;
    const auto corner = [&](size_t i) { return positions.data() + 3 * static_cast<size_t>(triangles[i]); };
    for (size_t i = 0; i + 2 < triangles.size(); i += 3)
        if (!has_no_area(corner(i), corner(i + 1), corner(i + 2))) {
            any = true;
            for (size_t j = i; j < i + 3; ++j)
                used[static_cast<size_t>(triangles[j])] = 1;
        }
    return any ? used : used_vertices(triangles, used.size());
}

/// Moves the vertices that no triangle uses to a used one. `positions`: 3 per vertex; `triangles` is not empty.
inline void move_unused_vertices(std::span<double> positions, std::span<const int32_t> triangles) {
    const std::vector<uint8_t> used = used_vertices(triangles, positions.size() / 3);
    const double* place = positions.data() + 3 * static_cast<size_t>(triangles[0]);
    for (size_t vertex = 0; vertex < used.size(); ++vertex)
        if (!used[vertex])
            std::copy_n(place, 3, positions.data() + 3 * vertex);
}

} // namespace voxrt::voxelize
