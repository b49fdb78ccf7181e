// sweep.h's sweep for the instruction set of the including file, which defines VOXRT_SWEEP as its name.
#include "sweep.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <cstdlib>
#include <cstring>

namespace voxrt::sim {
namespace {

constexpr std::size_t kChunkWords = Occupancy::kChunkBits / 64;
typedef std::uint64_t Chunk __attribute__((vector_size(Occupancy::kChunkBits / 8)));
constexpr std::uint32_t kRowWork = 2;

inline Chunk load(const std::uint64_t* from) {
    Chunk chunk;
    std::memcpy(&chunk, from, sizeof chunk);
    return chunk;
}

// Another row, moved so that the bit of voxel x is the one of x + dx.
struct Source {
    std::ptrdiff_t offset; // words to it
    int bits;              // 0 ... 63

    Source(std::ptrdiff_t row, int32_t dx) : offset(row + (dx < 0 ? -1 : 0)), bits(dx & 63) {}

    Chunk of(const std::uint64_t* row) const {
        const Chunk low = load(row + offset) >> bits;
        return low | load(row + offset + 1) << 1 << (63 - bits);
    }
};

} // namespace

void VOXRT_SWEEP(const SweepJob& job, const int32_t steps[3], std::uint64_t* open) {
    const Occupancy& solid = job.solid;
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(solid.stride),
                         plane = static_cast<std::ptrdiff_t>(solid.plane());
    const std::size_t height = solid.size[1], planes = solid.size[2], words = solid.size[0] / 64;
    std::vector<Source> path;
    for (const auto& [dx, dy, dz] : lattice_path(steps))
        path.emplace_back(dz * plane + dy * stride, dx);
    // The blocked voxels of the last planes: plane z is number z % ring. Those that were not swept yet are zeros, which
    // stand for the outside.
    const std::size_t ring = static_cast<std::size_t>(std::abs(steps[2])) + 1;
    std::vector<std::uint64_t> blocked(ring * plane + 1, 0);
    const auto blocked_row = [&](std::size_t y, std::size_t z) {
        return &blocked[z % ring * plane + (y + solid.frame) * stride + 1];
    };
    for (std::size_t k = 0; k < planes; ++k) {
        const std::size_t z = steps[2] > 0 ? planes - 1 - k : k;
        const Source before(blocked_row(0, z + ring + steps[2]) - blocked_row(0, z) + steps[1] * stride, steps[0]);
        for (std::size_t j = 0; j < height; ++j) {
            const std::size_t y = steps[1] > 0 ? height - 1 - j : j;
            const std::uint64_t* own = &solid.words[solid.row(y, z)];
            std::uint64_t* out = blocked_row(y, z);
            for (std::size_t i = 0; i < words; i += kChunkWords) {
                Chunk any = before.of(out + i);
                for (const Source& source : path)
                    any |= source.of(own + i);
                std::memcpy(out + i, &any, sizeof any);
            }
        }
        voxelize::count_work(static_cast<std::uint32_t>(height) * kRowWork);
        for (std::size_t i = job.first[z]; i < job.first[z + 1]; ++i) {
            const SweepPoint& point = job.points[i];
            const std::uint64_t bit = blocked_row(point.y, z)[point.bit / 64] >> point.bit % 64 & 1;
            open[i / 64] |= (bit ^ 1) << i % 64;
        }
    }
}

} // namespace voxrt::sim
