// Where the surface of a scene is: its area by place along each axis. It tells whether nearly all of it is close
// together.
//
//     AreaByPlace areas(bounds.low(), longest_side, 64);
//     for (each instance of a mesh)
//         areas.add(positions, triangles, placed);   // placed: its 3x4 transform to the scene frame
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::voxelize {

class AreaByPlace {
public:
    /// For triangles within `width` of `low`, metres; each axis has so many bins.
    AreaByPlace(const std::array<double, 3>& low, double width, size_t bins)
        : low_(low), scale_(width > 0 ? double(bins) / (3 * width) : 0), bins_(bins), areas_(3 * bins) {}

    /// Adds triangles where their middles are. `positions`: 3 per vertex, float or double. `transform`: rows of the
    /// affine map (3x4) to the scene frame.
    template <class Real>
    void add(std::span<const Real> positions, std::span<const int32_t> triangles,
             std::span<const double, 12> transform) {
        placed_.resize(positions.size() / 3);
        for (size_t vertex = 0; vertex < placed_.size(); ++vertex) {
            const Real* p = positions.data() + 3 * vertex;
            for (size_t axis = 0; axis < 3; ++axis) {
                const double* row = transform.data() + 4 * axis;
                placed_[vertex][axis] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] - low_[axis];
            }
        }
        const auto corner = [&](size_t i) -> const auto& { return placed_[static_cast<size_t>(triangles[i])]; };
        for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
            const std::array<double, 3>&a = corner(i), &b = corner(i + 1), &c = corner(i + 2);
            const std::array<double, 3> u{b[0] - a[0], b[1] - a[1], b[2] - a[2]},
                v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
            const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
            const double area = std::sqrt(x * x + y * y + z * z) / 2;
            for (size_t axis = 0; axis < 3; ++axis)
                areas_[axis * bins_ + bin(a[axis] + b[axis] + c[axis])] += area;
        }
    }

    /// Square metres: all bins of x, then those of y and z.
    std::vector<double>& areas() { return areas_; }

private:
    /// `sum`: of three corners, along an axis.
    size_t bin(double sum) const {
        const double at = sum * scale_;
        return at > 0 ? static_cast<size_t>(std::min(at, double(bins_ - 1))) : 0; // what is no number is in the first
    }

    std::array<double, 3> low_;
    double scale_;
    size_t bins_;
    std::vector<double> areas_;
    std::vector<std::array<double, 3>> placed_; // from the lowest corner
};

} // namespace voxrt::voxelize
