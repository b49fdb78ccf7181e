// A frame of the exact model, and a list of rays, on several threads.
//
// Long calls count their work: the caller's interrupt check may end them (voxrt/voxelize/work/interrupt.h).
#pragma once

#include "pixel.h"

#include <cstddef>
#include <cstdint>

namespace voxrt::sim {

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
    uint8_t* colour; // 3 bytes per pixel
    uint8_t* material;
    uint8_t* face;
};

// Where traced rays go: `count` entries each.
struct RaysView {
    size_t count;
    const int32_t* origins;    // 3 per ray, 1/16 voxel
    const int32_t* directions; // 3 per ray
    uint8_t* material;
    uint8_t* face;
    int32_t* cell; // 3 per ray
};

struct FrameJob;
// Renders one tile of a frame: frame_tile.h.
using RenderTile = uint64_t (*)(const FrameJob& job, int32_t left, int32_t top);

// Throws std::invalid_argument where a pixel's direction reaches kDirectionLimit on an axis.
void check_directions(const Camera& camera, int32_t width, int32_t height);

// Some of a frame's rows of tiles, which are kTileSide (frame_tile.h) pixels high: from `first` up to and without
// `end`.
struct TileRows {
    int32_t first;
    int32_t end;
};

// How many rows of tiles a frame has.
int32_t tile_rows(int32_t height);

// Renders those rows of a frame. `threads`: 0 takes as many as the machine has; the frame does not depend on it.
// `render_tile` is one of tile_engines() (frame_tile.h). Returns how many octree words were read.
uint64_t render(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, const Camera& camera,
                const FrameView& frame, TileRows rows, int threads, RenderTile render_tile);

// Renders all of a frame.
inline uint64_t render(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod,
                       const Camera& camera, const FrameView& frame, int threads, RenderTile render_tile) {
    return render(memory, shading, lod, camera, frame, {0, tile_rows(frame.height)}, threads, render_tile);
}

// Traces a list of rays, whose directions are below kDirectionLimit. Returns how many octree words were read.
uint64_t trace_all(const octree::VerifiedMemory& memory, const RaysView& rays, int threads);

} // namespace voxrt::sim
