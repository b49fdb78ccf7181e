#include "frame.h"

#include "../rays/ray.h"
#include "frame_tile.h"

#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>

namespace voxrt::sim {
namespace {

constexpr size_t kRaysPerJob = 1024;

// Work in the units of interrupt.h; low estimates, so that the check runs a few times per second. A ray may read
// hundreds of thousands of words, so the words count too.
constexpr uint32_t kTileWork = 200, kPixelWork = 25, kRayWork = 8;

uint64_t render_pixel(const FrameJob& job, int32_t column, int32_t row) {
    const Camera& camera = job.camera;
    const FrameView& frame = job.frame;
    int32_t direction[3];
    for (int axis = 0; axis < 3; ++axis)
        direction[axis] = camera.look[axis] + camera.right[axis] * (column - frame.width / 2) +
                          camera.up[axis] * (frame.height / 2 - row);
    const Pixel traced = trace_pixel(job.memory, job.shading, job.lod, camera.position, direction);
    const size_t pixel = static_cast<size_t>(row) * frame.width + column;
    frame.material[pixel] = traced.material;
    frame.face[pixel] = traced.face;
    std::copy_n(traced.colour, 3, frame.colour + 3 * pixel);
    return traced.words_read;
}

// Whether a pixel's colour takes more rays than the camera's, which is all that render_tile traces.
bool takes_more_rays(const FrameJob& job, int32_t column, int32_t row) {
    const size_t pixel = static_cast<size_t>(row) * job.frame.width + column;
    const Shading& shading = job.shading;
    return job.frame.face[pixel] != kFaceNone &&
           (shading.light || (shading.bounces > 0 && shading.mirrors[job.frame.material[pixel]]));
}

} // namespace

void count_tile_work(uint32_t units) { voxelize::count_work(units); }

void check_directions(const Camera& camera, int32_t width, int32_t height) {
    // Directions are linear in the pixel: the largest are in the corners.
    for (const int64_t column : {0, width - 1})
        for (const int64_t row : {0, height - 1})
            for (int axis = 0; axis < 3; ++axis) {
                const int64_t d = camera.look[axis] + camera.right[axis] * (column - width / 2) +
                                  camera.up[axis] * (height / 2 - row);
                if (d <= -kDirectionLimit || d >= kDirectionLimit)
                    throw std::invalid_argument("the direction of pixel (" + std::to_string(column) + ", " +
                                                std::to_string(row) + ") reaches " + std::to_string(d) + " on axis " +
                                                "xyz"[axis] + ", which is not below 2**20");
            }
}

int32_t tile_rows(int32_t height) { return (height + kTileSide - 1) / kTileSide; }

uint64_t render(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, const Camera& camera,
                const FrameView& frame, TileRows rows, int threads, RenderTile render_tile) {
    const int32_t no_direction[3] = {0, 0, 0};
    const uint8_t at_camera = trace_pixel(memory, shading, lod, camera.position, no_direction).material;
    const FrameJob job{memory, shading, lod, camera, frame, at_camera};
    const int32_t across = (frame.width + kTileSide - 1) / kTileSide;
    const int32_t down = rows.end - rows.first;
    std::atomic<uint64_t> words_read{0};
    voxelize::Workers(threads).run(static_cast<size_t>(across) * down, [&](size_t tile, int) {
        voxelize::count_work(kTileWork);
        const int32_t left = static_cast<int32_t>(tile % across) * kTileSide;
        const int32_t top = (rows.first + static_cast<int32_t>(tile / across)) * kTileSide;
        const bool fits = tile_fits(job, left, top);
        uint64_t words = fits ? render_tile(job, left, top) : 0;
        if (!fits || shading.light || shading.bounces != 0)
            for (int32_t row = top; row < std::min(top + kTileSide, frame.height); ++row)
                for (int32_t column = left; column < std::min(left + kTileSide, frame.width); ++column)
                    if (!fits || takes_more_rays(job, column, row)) {
                        const uint64_t read = render_pixel(job, column, row);
                        voxelize::count_work(kPixelWork + static_cast<uint32_t>(read));
                        words += read;
                    }
        words_read.fetch_add(words, std::memory_order_relaxed);
    });
    return words_read;
}

uint64_t trace_all(const octree::VerifiedMemory& memory, const RaysView& rays, int threads) {
    std::atomic<uint64_t> words_read{0};
    voxelize::Workers(threads).run((rays.count + kRaysPerJob - 1) / kRaysPerJob, [&](size_t job, int) {
        uint64_t words = 0;
        for (size_t ray = job * kRaysPerJob; ray < std::min((job + 1) * kRaysPerJob, rays.count); ++ray) {
            Line line{};
            std::copy_n(rays.origins + 3 * ray, 3, line.origin);
            std::copy_n(rays.directions + 3 * ray, 3, line.direction);
            const auto store = [&](const auto& hit) {
                rays.material[ray] = hit.material;
                rays.face[ray] = hit.face;
                std::copy_n(hit.cell, 3, rays.cell + 3 * ray);
                words += hit.words_read;
                voxelize::count_work(kRayWork + hit.words_read);
            };
            if (key_fits_64(line))
                store(Ray<int64_t>(memory, line).trace());
            else
                store(Ray<WideKey>(memory, line).trace());
        }
        words_read.fetch_add(words, std::memory_order_relaxed);
    });
    return words_read;
}

} // namespace voxrt::sim
