#include "frame_tile.h"

#include <voxrt/voxelize/vectors/instruction_sets.h>

#include <algorithm>
#include <cstdlib>

namespace voxrt::sim {

bool tile_fits(const FrameJob& job, int32_t left, int32_t top) {
    const Camera& camera = job.camera;
    // Directions are linear in the pixel: the largest are in the corners.
    double largest[3] = {1, 1, 1};
    for (const int32_t column : {left, left + kTileSide - 1})
        for (const int32_t row : {top, top + kTileSide - 1})
            for (int axis = 0; axis < 3; ++axis) {
                const double d = camera.look[axis] +
                                 static_cast<double>(camera.right[axis]) * (column - job.frame.width / 2) +
                                 static_cast<double>(camera.up[axis]) * (job.frame.height / 2 - row);
                largest[axis] = std::max(largest[axis], d < 0 ? -d : d);
            }
    const double world = 16.0 * (1 << job.memory.depth());
    for (int axis = 0; axis < 3; ++axis) {
        const double weight = 4 * largest[(axis + 1) % 3] * largest[(axis + 2) % 3];
        // The largest distance of a plane from a ray's start.
        const double distance = 2 * world + std::abs(static_cast<double>(camera.position[axis]));
        if (weight * distance + 3 >= 0x1p53)
            return false;
    }
    return true;
}

const std::vector<TileEngine>& tile_engines() {
    static const std::vector<TileEngine> engines = [] {
        std::vector<TileEngine> found;
#if defined(__x86_64__)
        if (voxelize::has_avx512())
            found.push_back({"avx512", render_tile_avx512});
        if (voxelize::has_avx2())
            found.push_back({"avx2", render_tile_avx2});
#endif
        found.push_back({"portable", render_tile_portable});
        return found;
    }();
    return engines;
}

} // namespace voxrt::sim
