// Which voxel centres see the outside along one direction, for all voxels of a box at once.
//
// Where the steps (a, b, c) of a direction are small integers, the ray from the centre of voxel v meets the centre of
// voxel v + (a, b, c), and crosses the same few voxels on its way from every v. So
//     blocked(v) = one of these voxels is solid, or blocked(v + (a, b, c)).
// Rows of voxels are bits of words: this is a few shifts and ORs for 256 voxels at a time, row by row from the side to
// which the rays go. sweep_body.h is compiled once per instruction set.
#pragma once

#include "occupancy.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

inline constexpr int kSweepLimit = 16; // components of directions are at most this

// A voxel whose light is sought: its row of its z, and its bit there.
struct SweepPoint {
    std::uint32_t y;
    std::uint32_t bit;
};

struct SweepJob {
    const Occupancy& solid;                // in a frame as wide as the largest step
    const std::vector<SweepPoint>& points; // ascending by z
    const std::vector<std::size_t>& first; // the first point of each z, and the number of points
};

// Sets bit i of `open` where the ray from the centre of point i along `steps` hits nothing, and clears it elsewhere;
// the voxel in which it starts does not count. Exact, with the order of planes of ray.h. Not both steps[1] and steps[2]
// are 0. `open`: a bit per point.
using Sweep = void (*)(const SweepJob& job, const int32_t steps[3], std::uint64_t* open);

void sweep_portable(const SweepJob& job, const int32_t steps[3], std::uint64_t* open);
#if defined(__x86_64__)
void sweep_avx2(const SweepJob& job, const int32_t steps[3], std::uint64_t* open);
void sweep_avx512(const SweepJob& job, const int32_t steps[3], std::uint64_t* open);
#endif

// The voxels that the ray from the centre of voxel 0 along `steps` enters up to voxel `steps`, that one included.
std::vector<std::array<int32_t, 3>> lattice_path(const int32_t steps[3]);

} // namespace voxrt::sim
