// One tile of a frame: its rays, their traversal and their colours, by the camera's light or flat, without reflections.
// frame_tile_body.h is compiled once per instruction set.
#pragma once

#include "frame.h"

#include <cstdint>
#include <vector>

namespace voxrt::sim {

inline constexpr int32_t kTileSide = 16; // pixels

struct FrameJob {
    const octree::VerifiedMemory& memory;
    const Shading& shading;
    const Lod& lod;
    const Camera& camera;
    const FrameView& frame;
    uint8_t material_at_camera; // of the voxel that holds the camera: what a ray without direction hits
};

// Whether the keys of the tile with its upper left pixel at (left, top) are exact in doubles.
bool tile_fits(const FrameJob& job, int32_t left, int32_t top);

// Counts work of the current thread, in the units of interrupt.h. It is no inline function: those of interrupt.h must
// not be compiled for instructions that the processor may lack.
void count_tile_work(uint32_t units);

// Renders the tile at (left, top), clipped to the frame, if it fits. Counts its work. Returns how many words were read.
uint64_t render_tile_portable(const FrameJob& job, int32_t left, int32_t top);
#if defined(__x86_64__)
uint64_t render_tile_avx2(const FrameJob& job, int32_t left, int32_t top);
uint64_t render_tile_avx512(const FrameJob& job, int32_t left, int32_t top);
#endif

// The instruction sets that this processor has, the fastest first. All give the same pixels.
struct TileEngine {
    const char* instructions;
    RenderTile render_tile;
};
const std::vector<TileEngine>& tile_engines();

} // namespace voxrt::sim
