#include "corner_normals.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace voxrt::sim {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t kMostNeighbours = 256; // of one place: more are summed without looking at their angles

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return length > 0 && std::isfinite(length) ? Vector{a[0] / length, a[1] / length, a[2] / length} : Vector{};
}

// The number of each vertex's place: vertices with equal coordinates have one.
std::vector<std::uint32_t> places(const double* positions, std::size_t vertices) {
    std::vector<std::uint32_t> order(vertices), place(vertices);
    std::iota(order.begin(), order.end(), 0u);
    const auto at = [&](std::uint32_t v) { return positions + 3 * std::size_t{v}; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::lexicographical_compare(at(a), at(a) + 3, at(b), at(b) + 3);
    });
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        if (i != 0 && !std::equal(at(order[i]), at(order[i]) + 3, at(order[i - 1])))
            ++number;
        place[order[i]] = number;
    }
    return place;
}

} // namespace

std::vector<float> corner_normals(const double* positions, std::size_t vertices, const std::int32_t* triangles,
                                  std::size_t count, double least_cosine) {
    const std::vector<std::uint32_t> place = places(positions, vertices);
    std::vector<Vector> faces(count);
    std::vector<double> angles(3 * count, 0.0);
    for (std::size_t t = 0; t < count; ++t) {
        Vector corner[3];
        for (int k = 0; k < 3; ++k)
            std::copy_n(positions + 3 * static_cast<std::size_t>(triangles[3 * t + k]), 3, corner[k].begin());
        faces[t] = unit(cross(corner[1] - corner[0], corner[2] - corner[0]));
        for (int k = 0; k < 3; ++k) {
            const Vector one = unit(corner[(k + 1) % 3] - corner[k]), other = unit(corner[(k + 2) % 3] - corner[k]);
            angles[3 * t + k] = std::acos(std::clamp(dot(one, other), -1.0, 1.0));
        }
    }
    // The corners at each place, one place after another.
    std::vector<std::size_t> first(vertices + 1, 0);
    for (std::size_t i = 0; i < 3 * count; ++i)
        ++first[place[triangles[i]] + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> corners(3 * count);
    std::vector<std::size_t> next = first;
    for (std::size_t i = 0; i < 3 * count; ++i)
        corners[next[place[triangles[i]]]++] = static_cast<std::uint32_t>(i);

    std::vector<float> normals(9 * count, 0.0f);
    for (std::size_t p = 0; p < vertices; ++p) {
        const std::size_t begin = first[p], end = first[p + 1];
        Vector all{};
        if (end - begin > kMostNeighbours)
            for (std::size_t j = begin; j < end; ++j)
                for (int axis = 0; axis < 3; ++axis)
                    all[axis] += angles[corners[j]] * faces[corners[j] / 3][axis];
        voxelize::count_work(static_cast<std::uint32_t>(1 + (end - begin)));
        for (std::size_t i = begin; i < end; ++i) {
            const Vector& own = faces[corners[i] / 3];
            Vector sum = all;
            if (end - begin <= kMostNeighbours)
                for (std::size_t j = begin; j < end; ++j)
                    if (const Vector& other = faces[corners[j] / 3]; dot(own, other) > least_cosine)
                        for (int axis = 0; axis < 3; ++axis)
                            sum[axis] += angles[corners[j]] * other[axis];
            sum = unit(sum);
            if (dot(sum, own) <= 0)
                sum = own;
            for (int axis = 0; axis < 3; ++axis)
                normals[3 * std::size_t{corners[i]} + axis] = static_cast<float>(sum[axis]);
        }
    }
    return normals;
}

} // namespace voxrt::sim
