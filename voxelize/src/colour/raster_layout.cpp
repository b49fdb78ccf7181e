#include "raster_layout.h"

#include "../work/interrupt.h"

#include <algorithm>
#include <cmath>

namespace voxrt::voxelize {
namespace {

constexpr int64_t kMostCells = 1 << 23;
constexpr double kLongest = 1 << 16;
constexpr double kRight = 1e-6;
constexpr double kFarthest = 1e9;

using Point = std::array<double, 3>;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double bounded(double value) { return std::isnan(value) ? 0 : std::clamp(value, -kFarthest, kFarthest); }

TriangleLayout lay_out(const std::array<Point, 3>& corners) {
    Point sides[3];
    double squares[3], feet[3];
    for (int k = 0; k < 3; ++k)
        sides[k] = minus(corners[(k + 1) % 3], corners[k]);
    int longest = 0;
    for (int k = 0; k < 3; ++k) {
        squares[k] = dot(sides[k], sides[k]);
        feet[k] = -dot(sides[k], sides[(k + 2) % 3]) / (squares[k] > 0 ? squares[k] : 1);
        if (squares[k] > squares[longest])
            longest = k;
    }
    // Columns run along the shortest side on which the height stands; the longest side is always one of these. So rows
    // and columns run along a right angle, as those of voxels often do.
    int base = longest;
    for (int k = 2; k >= 0; --k)
        if ((k == longest || (feet[k] > -kRight && feet[k] < 1 + kRight)) && squares[k] <= squares[base])
            base = k;
    const double foot = std::clamp(feet[base], 0.0, 1.0);
    const Point &along = sides[base], &back = sides[(base + 2) % 3];
    const Point height{-back[0] - foot * along[0], -back[1] - foot * along[1], -back[2] - foot * along[2]};
    return {std::sqrt(squares[base]), std::sqrt(dot(height, height)), foot, base, 1, 1};
}

} // namespace

std::vector<TriangleLayout> lay_out(const Numbers& positions, std::span<const int32_t> triangles,
                                    std::span<const int32_t> rows, const std::array<double, 9>& linear) {
    std::vector<TriangleLayout> layouts(rows.size());
    for (size_t t = 0; t < rows.size(); ++t) {
        count_work(16);
        if (rows[t] < 0)
            continue;
        std::array<Point, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            const size_t at = 3 * static_cast<size_t>(triangles[3 * t + k]);
            const Point own{positions[at], positions[at + 1], positions[at + 2]};
            for (size_t axis = 0; axis < 3; ++axis)
                corners[k][axis] = bounded(dot({linear[3 * axis], linear[3 * axis + 1], linear[3 * axis + 2]}, own));
        }
        layouts[t] = lay_out(corners);
    }
    return layouts;
}

void fit_rasters(std::vector<std::vector<TriangleLayout>>& meshes) {
    for (double scale = 1;; scale *= 0.9) {
        int64_t cells = 0;
        const auto fitted = [&](double length) {
            return static_cast<int32_t>(std::clamp(std::ceil(length * scale), 1.0, kLongest));
        };
        for (std::vector<TriangleLayout>& mesh : meshes)
            for (TriangleLayout& one : mesh)
                if (one.columns > 0) {
                    one.columns = fitted(one.length);
                    one.rows = fitted(one.height);
                    cells += one.cells();
                }
        if (cells <= kMostCells || scale < 1e-9)
            return;
    }
}

std::array<std::array<float, 2>, 3> raster_corners(const TriangleLayout& layout) {
    std::array<std::array<float, 2>, 3> corners{};
    corners[(layout.base + 1) % 3][0] = static_cast<float>(layout.columns);
    corners[(layout.base + 2) % 3] = {static_cast<float>(layout.foot * layout.columns),
                                      static_cast<float>(layout.rows)};
    return corners;
}

} // namespace voxrt::voxelize
