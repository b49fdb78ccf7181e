#include "frame.h"

#include "cores.h"
#include "frame_tile.h"
#include "ray.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace voxrt::model {
namespace {

constexpr size_t kRaysATile = 1024;

// round(c * d_a^2 / |d|^2), half up: the brightness of a face lit from the camera is (n . l)^2.
void shade(const uint8_t* surface, const int32_t direction[3], uint8_t face, uint8_t* colour) {
    if (face == kFaceNone) {
        std::copy_n(surface, 3, colour);
        return;
    }
    uint64_t squares[3];
    for (int axis = 0; axis < 3; ++axis)
        squares[axis] = static_cast<uint64_t>(int64_t{direction[axis]} * direction[axis]);
    const uint64_t length = squares[0] + squares[1] + squares[2];
    for (int channel = 0; channel < 3; ++channel)
        colour[channel] = static_cast<uint8_t>((2 * surface[channel] * squares[face] + length) / (2 * length));
}

Hit trace_any(const Memory& memory, const int32_t origin[3], const int32_t direction[3]) {
    return key_fits_64(origin) ? trace<int64_t>(memory, origin, direction) : trace<WideKey>(memory, origin, direction);
}

uint64_t render_pixel(const FrameJob& job, int32_t column, int32_t row) {
    const Camera& camera = job.camera;
    const FrameView& frame = job.frame;
    int32_t direction[3];
    for (int axis = 0; axis < 3; ++axis)
        direction[axis] = camera.look[axis] + camera.right[axis] * (column - frame.width / 2) +
                          camera.up[axis] * (frame.height / 2 - row);
    const Hit hit = trace_any(job.memory, camera.position, direction);
    const size_t pixel = static_cast<size_t>(row) * frame.width + column;
    frame.material[pixel] = hit.material;
    frame.face[pixel] = hit.face;
    shade(job.materials + 3 * hit.material, direction, hit.face, frame.colour + 3 * pixel);
    return hit.words_read;
}

} // namespace

void check_directions(const Camera& camera, int32_t width, int32_t height) {
    // Directions are linear in the pixel: the largest stand in the corners.
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

uint64_t render(const Memory& memory, const uint8_t* materials, const Camera& camera, const FrameView& frame,
                int threads, RenderTile render_tile, const Interrupted& interrupted) {
    const int32_t no_direction[3] = {0, 0, 0};
    const FrameJob job{memory, materials, camera, frame, trace_any(memory, camera.position, no_direction).material};
    const int32_t across = (frame.width + kTileSide - 1) / kTileSide;
    const int32_t down = (frame.height + kTileSide - 1) / kTileSide;
    return on_all_cores(static_cast<size_t>(across) * down, threads, interrupted, [&](size_t tile) {
        const int32_t left = static_cast<int32_t>(tile % across) * kTileSide;
        const int32_t top = static_cast<int32_t>(tile / across) * kTileSide;
        if (tile_fits(job, left, top))
            return render_tile(job, left, top);
        uint64_t words_read = 0;
        for (int32_t row = top; row < std::min(top + kTileSide, frame.height); ++row)
            for (int32_t column = left; column < std::min(left + kTileSide, frame.width); ++column)
                words_read += render_pixel(job, column, row);
        return words_read;
    });
}

uint64_t trace_all(const Memory& memory, const RaysView& rays, int threads, const Interrupted& interrupted) {
    return on_all_cores((rays.count + kRaysATile - 1) / kRaysATile, threads, interrupted, [&](size_t tile) {
        uint64_t words_read = 0;
        for (size_t ray = tile * kRaysATile; ray < std::min((tile + 1) * kRaysATile, rays.count); ++ray) {
            const Hit hit = trace_any(memory, rays.origins + 3 * ray, rays.directions + 3 * ray);
            rays.material[ray] = hit.material;
            rays.face[ray] = hit.face;
            std::copy_n(hit.cell, 3, rays.cell + 3 * ray);
            words_read += hit.words_read;
        }
        return words_read;
    });
}

} // namespace voxrt::model
