#include "received_light.h"

#include <voxrt/voxelize/vectors/instruction_sets.h>
#include <voxrt/voxelize/work/interrupt.h>
#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

namespace voxrt::sim {
namespace {

constexpr std::uint32_t kPacketWork = 1000;
constexpr std::size_t kPointsPerJob = 1 << 14; // a multiple of 64

// Estimates, measured on one machine: nanoseconds per ray of a packet, and per 256 voxels of a sweep.
constexpr double kRayCost = 60, kChunkCost = 12;
constexpr std::uint64_t kMostSweepBits = std::uint64_t{1} << 32;

// A bit per direction and point: whether the ray hits nothing.
class OpenPoints {
public:
    OpenPoints(std::size_t directions, std::size_t points)
        : stride_((points + 63) / 64), words_(directions * stride_, 0) {}

    std::uint64_t* of(std::size_t direction) { return words_.data() + direction * stride_; }
    std::uint64_t at(std::size_t direction, std::size_t point) const {
        return words_[direction * stride_ + point / 64] >> point % 64 & 1;
    }

private:
    std::size_t stride_;
    std::vector<std::uint64_t> words_;
};

bool fits_sweep(const std::int32_t* steps) {
    return (steps[1] != 0 || steps[2] != 0) && std::abs(steps[0]) <= kSweepLimit && std::abs(steps[1]) <= kSweepLimit &&
           std::abs(steps[2]) <= kSweepLimit;
}

std::int32_t facing(const std::int16_t* normal, const std::int16_t* unit) {
    return std::max(0, normal[0] * unit[0] + normal[1] * unit[1] + normal[2] * unit[2]);
}

// Points from `first` on, one packet, along all directions.
void trace_packet(const octree::VerifiedMemory& memory, const PointsView& points, const DirectionsView& directions,
                  std::size_t first, OpenRays open_rays, OpenPoints& out) {
    const int count = static_cast<int>(std::min<std::size_t>(kPacketRays, points.count - first));
    std::int32_t origins[3 * kPacketRays];
    for (int i = 0; i < 3 * count; ++i)
        origins[i] = 16 * points.voxels[3 * first + i] + 8;
    for (std::size_t d = 0; d < directions.count; ++d) {
        const std::int32_t* step = directions.steps + 3 * d;
        std::uint8_t wanted[kPacketGroups] = {}, open[kPacketGroups] = {};
        for (int i = 0; i < count; ++i)
            wanted[i / 8] |= static_cast<std::uint8_t>(
                (facing(points.normals + 3 * (first + i), directions.units + 3 * d) > 0) << i % 8);
        voxelize::count_work(kPacketWork);
        open_rays(memory, {origins, count, {step[0], step[1], step[2]}, wanted}, open);
        for (int i = 0; i < count; i += 8)
            out.of(d)[(first + i) / 64] |= std::uint64_t{open[i / 8]} << (first + i) % 64;
    }
}

// The points by z, as a sweep takes them: order[i] is the number of its point i.
struct ByPlane {
    std::vector<std::uint32_t> order;
    std::vector<SweepPoint> points;
    std::vector<std::size_t> first;

    ByPlane(const Occupancy& solid, const PointsView& view)
        : order(view.count), points(view.count), first(solid.size[2] + 1, 0) {
        const auto plane = [&](std::size_t i) {
            return static_cast<std::size_t>(view.voxels[3 * i + 2] - solid.low[2]);
        };
        for (std::size_t i = 0; i < view.count; ++i)
            ++first[plane(i) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < view.count; ++i) {
            const std::size_t to = next[plane(i)]++;
            order[to] = static_cast<std::uint32_t>(i);
            points[to] = {static_cast<std::uint32_t>(view.voxels[3 * i + 1] - solid.low[1]),
                          static_cast<std::uint32_t>(view.voxels[3 * i] - solid.low[0])};
        }
    }
};

// Sums the light of all points, whose bits in `open` stand in the order that `order` gives, or, where it is empty, in
// their own.
void gather(const OpenPoints& open, const std::vector<std::uint32_t>& order, const PointsView& points,
            const DirectionsView& directions, std::int64_t* received, std::int64_t* full,
            const voxelize::Workers& workers) {
    workers.run((points.count + kPointsPerJob - 1) / kPointsPerJob, [&](std::size_t job, int) {
        const std::size_t first = job * kPointsPerJob, last = std::min(first + kPointsPerJob, points.count);
        std::vector<std::int64_t> sum(last - first, 0), all(last - first, 0);
        std::vector<std::int16_t> normals(3 * (last - first));
        for (std::size_t i = first; i < last; ++i)
            std::copy_n(points.normals + 3 * (order.empty() ? i : order[i]), 3, &normals[3 * (i - first)]);
        for (std::size_t d = 0; d < directions.count; ++d) {
            const std::int64_t weight = directions.weights[d];
            voxelize::count_work(static_cast<std::uint32_t>((last - first) / 8));
            for (std::size_t i = first; i < last; ++i) {
                const std::int64_t cosine = facing(&normals[3 * (i - first)], directions.units + 3 * d);
                all[i - first] += cosine;
                sum[i - first] += cosine * weight & -static_cast<std::int64_t>(open.at(d, i));
            }
        }
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t to = order.empty() ? i : order[i];
            received[to] = sum[i - first];
            full[to] = all[i - first];
        }
    });
}

} // namespace

const std::vector<LightEngine>& light_engines() {
    static const std::vector<LightEngine> engines = [] {
        std::vector<LightEngine> found;
#if defined(__x86_64__)
        if (voxelize::has_avx512())
            found.push_back({"avx512", open_rays_avx512, sweep_avx512});
        if (voxelize::has_avx2())
            found.push_back({"avx2", open_rays_avx2, sweep_avx2});
#endif
        found.push_back({"portable", open_rays_portable, sweep_portable});
        return found;
    }();
    return engines;
}

void receive_light(const octree::VerifiedMemory& memory, const PointsView& points, const DirectionsView& directions,
                   std::int64_t* received, std::int64_t* full, int threads, Method method, const LightEngine& engine) {
    bool fits = true;
    for (std::size_t d = 0; d < directions.count; ++d)
        fits &= fits_sweep(directions.steps + 3 * d);
    if (method == Method::sweep && !fits)
        throw std::invalid_argument("a sweep takes steps of at most 16, not along x alone");
    if (method == Method::automatic) {
        const std::uint64_t bits = occupancy_bits(memory.memory(), kPointMargin);
        const double sweeping = kChunkCost * (static_cast<double>(bits) / Occupancy::kChunkBits);
        const bool faster = sweeping < kRayCost * static_cast<double>(points.count) / 2;
        method = fits && faster && bits <= kMostSweepBits ? Method::sweep : Method::rays;
    }
    const voxelize::Workers workers(threads);
    OpenPoints open(directions.count, points.count);
    if (method == Method::rays) {
        workers.run((points.count + kPacketRays - 1) / kPacketRays, [&](std::size_t packet, int) {
            trace_packet(memory, points, directions, packet * kPacketRays, engine.open_rays, open);
        });
        gather(open, {}, points, directions, received, full, workers);
        return;
    }
    std::int32_t longest = 0;
    for (std::size_t i = 0; i < 3 * directions.count; ++i)
        longest = std::max(longest, std::abs(directions.steps[i]));
    const Occupancy solid = occupancy_of(memory.memory(), kPointMargin, static_cast<std::size_t>(longest));
    const ByPlane by_plane(solid, points);
    const SweepJob job{solid, by_plane.points, by_plane.first};
    workers.run(directions.count, [&](std::size_t d, int) { engine.sweep(job, directions.steps + 3 * d, open.of(d)); });
    gather(open, by_plane.order, points, directions, received, full, workers);
}

} // namespace voxrt::sim
