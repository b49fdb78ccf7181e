#include "grid_fit.h"

#include "../grid/fixed_point.h"

#include <algorithm>
#include <cmath>

namespace voxrt::voxelize {

template <class Real>
void Bounds::add(std::span<const Real> positions, std::span<const uint8_t> used,
                 std::span<const double, 12> transform) {
    for (size_t vertex = 0; vertex < positions.size() / 3; ++vertex) {
        if (!used.empty() && !used[vertex])
            continue;
        const double x = positions[3 * vertex], y = positions[3 * vertex + 1], z = positions[3 * vertex + 2];
        for (size_t axis = 0; axis < 3; ++axis) {
            const double* row = transform.data() + 4 * axis;
            const double place = row[0] * x + row[1] * y + row[2] * z + row[3];
            not_a_number_ |= std::isnan(place);
            low_[axis] = std::min(low_[axis], place);
            high_[axis] = std::max(high_[axis], place);
        }
    }
}

template void Bounds::add(std::span<const float>, std::span<const uint8_t>, std::span<const double, 12>);
template void Bounds::add(std::span<const double>, std::span<const uint8_t>, std::span<const double, 12>);

void Bounds::check(size_t hidden) const {
    const char* const repair = "repair the mesh or its transform";
    if (not_a_number_)
        throw UnfitScene("a coordinate is not a number", repair);
    bool finite = true;
    for (size_t axis = 0; axis < 3; ++axis) {
        if (!(low_[axis] <= high_[axis]))
            throw UnfitScene("nothing to voxelize: no triangles and no colliders",
                             hidden == 0 ? std::string()
                                         : std::to_string(hidden) +
                                               " objects are hidden: use geometry collider for their colliders");
        finite &= std::isfinite(low_[axis]) && std::isfinite(high_[axis]);
    }
    if (!finite)
        throw UnfitScene("a coordinate is infinite", repair);
}

double longest_side(const std::array<double, 3>& low, const std::array<double, 3>& high) {
    double longest = high[0] - low[0];
    for (size_t axis = 1; axis < 3; ++axis)
        longest = std::max(longest, high[axis] - low[axis]);
    if (!std::isfinite(longest))
        throw UnfitScene("the scene's size overflows float64", "scale it down");
    return longest;
}

FittedGrid fit_grid(const std::array<double, 3>& low, const std::array<double, 3>& high, unsigned depth) {
    const double voxel = std::ldexp(longest_side(low, high), -static_cast<int>(depth));
    return {depth, low, voxel > 0 ? voxel : 1.0};
}

std::array<double, 12> FittedGrid::frame(std::span<const double, 12> transform) const {
    const double scale = static_cast<double>(kUnit) / voxel_size;
    std::array<double, 12> frame;
    for (size_t i = 0; i < 12; ++i)
        frame[i] = (i % 4 == 3 ? transform[i] - origin[i / 4] : transform[i]) * scale;
    return frame;
}

} // namespace voxrt::voxelize
