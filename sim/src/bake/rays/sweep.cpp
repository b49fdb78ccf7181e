#include "sweep.h"

#include <cstdlib>

namespace voxrt::sim {

std::vector<std::array<int32_t, 3>> lattice_path(const int32_t steps[3]) {
    // On axis i the plane before cell j + 1 is crossed at (2 j + 1) / (2 |steps_i|) of the way; ties go by axis.
    std::vector<std::array<int32_t, 3>> path;
    std::array<int32_t, 3> at{}, size{};
    for (int axis = 0; axis < 3; ++axis)
        size[axis] = std::abs(steps[axis]);
    while (at != size) {
        int next = -1;
        for (int axis = 0; axis < 3; ++axis)
            if (at[axis] < size[axis] &&
                (next < 0 || (2 * at[axis] + 1) * size[next] < (2 * at[next] + 1) * size[axis]))
                next = axis;
        ++at[next];
        std::array<int32_t, 3> voxel;
        for (int axis = 0; axis < 3; ++axis)
            voxel[axis] = steps[axis] < 0 ? -at[axis] : at[axis];
        path.push_back(voxel);
    }
    return path;
}

} // namespace voxrt::sim
