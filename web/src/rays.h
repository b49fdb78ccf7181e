// Rays of the C interface.
#pragma once

#include <voxrt/sim/rays/ray.h>

#include <stdexcept>

namespace voxrt::web {

/// `origin`: in 1/16 voxel. Throws std::invalid_argument where a part of the direction is not below 2^20.
inline sim::Line line_of(const int32_t* origin, const int32_t* direction) {
    sim::Line line{};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] <= -sim::kDirectionLimit || direction[axis] >= sim::kDirectionLimit)
            throw std::invalid_argument("the direction is not below 2**20");
        line.origin[axis] = origin[axis];
        line.direction[axis] = direction[axis];
    }
    return line;
}

} // namespace voxrt::web
