// Which of some parallel rays leave the world without a hit. parallel_rays_body.h is compiled once per instruction set.
#pragma once

#include <voxrt/octree/words/verify.h>

#include <cstdint>

namespace voxrt::sim {

inline constexpr int kPacketGroups = 32; // of 8 rays
inline constexpr int kPacketRays = 8 * kPacketGroups;
inline constexpr int32_t kParallelLimit = 1 << 11;       // components of directions are below it
inline constexpr int32_t kParallelOriginLimit = 1 << 22; // components of origins are below it, 1/16 voxel

// `count` rays, at most kPacketRays, from origins in 1/16 voxel, 3 per ray. Ray 8 g + i is bit i of wanted[g]; rays
// that are not wanted are not traced. A ray that starts in a solid voxel hits it. Exact: a ray is open where Ray::trace
// (ray.h) hits nothing.
struct ParallelRays {
    const int32_t* origins;
    int count;
    int32_t direction[3]; // not zero
    const uint8_t* wanted;
};

// Sets bit i of open[g] for each wanted ray that is open, and clears it for all others.
using OpenRays = void (*)(const octree::VerifiedMemory& memory, const ParallelRays& rays, uint8_t* open);

void open_rays_portable(const octree::VerifiedMemory& memory, const ParallelRays& rays, uint8_t* open);
#if defined(__x86_64__)
void open_rays_avx2(const octree::VerifiedMemory& memory, const ParallelRays& rays, uint8_t* open);
void open_rays_avx512(const octree::VerifiedMemory& memory, const ParallelRays& rays, uint8_t* open);
#endif

} // namespace voxrt::sim
