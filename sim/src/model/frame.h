// A frame of the exact model, and a list of rays, on all cores.
#pragma once

#include "memory.h"
#include "pixel.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace voxrt::model {

// The camera's registers: direction = look + right * (column - width / 2) + up * (height / 2 - row).
struct Camera {
    int32_t position[3]; // 1/16 voxel
    int32_t look[3];
    int32_t right[3];
    int32_t up[3];
};

// Where a frame goes: all arrays hold height * width pixels, row 0 at the top.
struct FrameView {
    int32_t width;
    int32_t height;
    uint8_t* colour; // 3 bytes a pixel
    uint8_t* material;
    uint8_t* face;
};

// Where traced rays go: `count` entries each.
struct RaysView {
    size_t count;
    const int32_t* origins;    // 3 a ray, 1/16 voxel
    const int32_t* directions; // 3 a ray
    uint8_t* material;
    uint8_t* face;
    int32_t* cell; // 3 a ray
};

struct FrameJob;
// Renders one tile of a frame: frame_tile.h.
using RenderTile = uint64_t (*)(const FrameJob& job, int32_t left, int32_t top);

// Asked now and then from the calling thread; true ends the work early, its output unfinished.
using Interrupted = std::function<bool()>;

// Throws std::invalid_argument where a pixel's direction reaches kDirectionLimit on an axis.
void check_directions(const Camera& camera, int32_t width, int32_t height);

// Renders a frame of a verified memory. `threads` = 0
// takes every core. `render_tile` is one of tile_engines (frame_tile.h). Returns how many octree words were read.
uint64_t render(const Memory& memory, const Shading& shading, const Camera& camera, const FrameView& frame, int threads,
                RenderTile render_tile, const Interrupted& interrupted);

// Traces a list of rays through a verified memory; directions are below kDirectionLimit. Returns words read.
uint64_t trace_all(const Memory& memory, const RaysView& rays, int threads, const Interrupted& interrupted);

} // namespace voxrt::model
