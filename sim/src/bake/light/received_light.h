// The light that points receive from directions from which they see no solid voxel.
#pragma once

#include "../rays/parallel_rays.h"
#include "../rays/sweep.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace voxrt::sim {

// Points stand in the centres of empty voxels, at most kPointMargin outside the box of the solid voxels.
inline constexpr std::int64_t kPointMargin = 4;

struct PointsView {
    std::size_t count;
    const std::int32_t* voxels;  // 3 per point, grid frame
    const std::int16_t* normals; // 3 per point: length 2^14
};

struct DirectionsView {
    std::size_t count;
    const std::int32_t* steps;   // 3 per direction: integers below kParallelLimit, not all zero, towards the light
    const std::int16_t* units;   // 3 per direction: the same, length 2^14, rounded
    const std::int32_t* weights; // one per direction: radiance, 0 ... 2^16
};

// How visibility is found; all find the same.
enum class Method {
    automatic, // the one that is likely to be the faster
    rays,      // by packets of parallel rays: parallel_rays.h; cost: points
    sweep, // for whole rows of voxels: sweep.h; cost: the box of the solid voxels. Needs steps of at most kSweepLimit
};

// The instruction sets that this processor has, the fastest first. All find the same.
struct LightEngine {
    const char* instructions;
    OpenRays open_rays;
    Sweep sweep;
};
const std::vector<LightEngine>& light_engines();

// received[i] is the sum, over the directions d along which the ray from point i hits nothing, of weight(d) * max(0, n
// . d), in units of 2^-28; full[i] is the sum of max(0, n . d) over all directions, hit or not, in the same units.
// Whole numbers, so the result depends neither on `threads` (0: as many as the machine has), nor on the method or
// engine.
//
// Neighbours are traced together: points in Morton order are the fastest. Throws std::invalid_argument where the sweep
// is asked for and does not take a direction.
void receive_light(const octree::VerifiedMemory& memory, const PointsView& points, const DirectionsView& directions,
                   std::int64_t* received, std::int64_t* full, int threads, Method method, const LightEngine& engine);

} // namespace voxrt::sim
