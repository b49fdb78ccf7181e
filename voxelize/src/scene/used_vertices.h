// Which vertices of a mesh its triangles use. The others have no place: they must stretch no bounds, and may be far
// away.
#pragma once

#include <algorithm>
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

/// Moves the vertices that no triangle uses to a used one. `positions`: 3 per vertex; `triangles` is not empty.
inline void move_unused_vertices(std::span<double> positions, std::span<const int32_t> triangles) {
    const std::vector<uint8_t> used = used_vertices(triangles, positions.size() / 3);
    const double* place = positions.data() + 3 * static_cast<size_t>(triangles[0]);
    for (size_t vertex = 0; vertex < used.size(); ++vertex)
        if (!used[vertex])
            std::copy_n(place, 3, positions.data() + 3 * vertex);
}

} // namespace voxrt::voxelize
