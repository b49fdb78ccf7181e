// Which vertices of a mesh its triangles use. The others have no place: they must stretch no bounds, and may be far
// away.
#pragma once

#include <algorithm>
#include <bit>
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
    if (!(largest > 0) || std::isinf(largest))
        return largest == 0;
    // By a power of two, so that nothing is rounded, and without a division: it would take as long as all else.
    const uint64_t exponent = std::bit_cast<uint64_t>(largest) >> 52;
    const double scale = std::bit_cast<double>((exponent < 2045 ? 2045 - exponent : 1) << 52);
    for (int i = 0; i < 3; ++i) {
        u[i] *= scale;
        v[i] *= scale;
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
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
        uint8_t* const of[3] = {&used[static_cast<size_t>(triangles[i])], &used[static_cast<size_t>(triangles[i + 1])],
                                &used[static_cast<size_t>(triangles[i + 2])]};
        if ((*of[0] & *of[1] & *of[2]) == 0 && !has_no_area(corner(i), corner(i + 1), corner(i + 2)))
            any = *of[0] = *of[1] = *of[2] = 1;
    }
    return any ? used : used_vertices(triangles, used.size());
}

/// Moves the vertices that no triangle uses to a used one. Those that only triangles without area use, and that are
/// farther from all others than these are wide, move to another corner of such a triangle, where none of these gets an
/// area by that. `spanning`: by spanning_vertices(). `positions`: 3 per vertex; `triangles` is not empty.
inline void move_unused_vertices(std::span<double> positions, std::span<const int32_t> triangles,
                                 const std::vector<uint8_t>& spanning) {
    constexpr int32_t kUnmoved = -1;
    const std::vector<uint8_t> used = used_vertices(triangles, positions.size() / 3);
    std::vector<int32_t> places(used.size(), kUnmoved);
    int32_t first = triangles[0];
    for (size_t vertex = spanning.size(); vertex-- > 0;)
        first = spanning[vertex] != 0 ? static_cast<int32_t>(vertex) : first;
    for (size_t vertex = 0; vertex < used.size(); ++vertex)
        if (used[vertex] == 0)
            places[vertex] = first;
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, width = 0;
    for (size_t i = 0; i < positions.size(); ++i)
        if (spanning[i / 3] != 0) {
            low[i % 3] = std::min(low[i % 3], positions[i]);
            high[i % 3] = std::max(high[i % 3], positions[i]);
        }
    for (int i = 0; i < 3; ++i)
        width = std::max(width, high[i] - low[i]);
    const auto is_far = [&](int32_t vertex) {
        bool far = false;
        for (int i = 0; i < 3; ++i) {
            const double at = positions[3 * size_t(vertex) + size_t(i)];
            far = far || at < low[i] - width || at > high[i] + width;
        }
        return far;
    };
    bool stays_flat = true;
    const auto each_flat = [&](auto&& visit) {
        for (size_t i = 0; i + 2 < triangles.size(); i += 3)
            if (!(spanning[size_t(triangles[i])] && spanning[size_t(triangles[i + 1])] &&
                  spanning[size_t(triangles[i + 2])]))
                visit(triangles.subspan(i, 3));
    };
    each_flat([&](std::span<const int32_t> corners) {
        int32_t place = first;
        for (const int32_t corner : corners)
            place = spanning[size_t(corner)] != 0 ? corner : place;
        for (const int32_t corner : corners)
            if (spanning[size_t(corner)] == 0 && places[size_t(corner)] == kUnmoved && is_far(corner))
                places[size_t(corner)] = place;
    });
    each_flat([&](std::span<const int32_t> corners) {
        const double* at[3];
        for (int i = 0; i < 3; ++i) {
            const int32_t place = places[size_t(corners[size_t(i)])];
            at[i] = positions.data() + 3 * size_t(place == kUnmoved ? corners[size_t(i)] : place);
        }
        stays_flat = stays_flat && has_no_area(at[0], at[1], at[2]);
    });
    for (size_t vertex = 0; vertex < used.size(); ++vertex)
        if (places[vertex] != kUnmoved && (stays_flat || used[vertex] == 0))
            std::copy_n(positions.data() + 3 * size_t(places[vertex]), 3, positions.data() + 3 * vertex);
}

} // namespace voxrt::voxelize
