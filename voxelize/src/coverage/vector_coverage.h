// Which voxels a triangle covers, eight planes or columns at a time.
//
// vector_coverage_body.h is compiled once per instruction set. All give the same voxels.
#pragma once

#include "tile_surface.h"

namespace voxrt::voxelize {

/// Whether triangle abc is for these functions: up to 4096 voxels wide, and neither flat on a plane, nor one voxel wide
/// in two axes, nor below the grid, nor wide and all but upright.
bool fits_vectors(const Vertex& a, const Vertex& b, const Vertex& c);

/// Adds to a surface what triangle abc covers of the surface's tile, and which columns it crosses where `crosses`.
/// `window`: the tile's.
/// The engine of the page has none: compiled to WebAssembly, eight at once take twice the time of one after the other.
using CoverByVectors = void (*)(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window, bool crosses,
                                TileSurface& surface);
void cover_by_vectors_portable(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window, bool crosses,
                               TileSurface& surface);
#if defined(__x86_64__)
void cover_by_vectors_avx2(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window, bool crosses,
                           TileSurface& surface);
void cover_by_vectors_avx512(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window, bool crosses,
                             TileSurface& surface);
#endif

/// The instruction sets that this processor has, the fastest first.
struct CoverageEngine {
    const char* instructions;
    CoverByVectors cover_by_vectors;
};
const std::vector<CoverageEngine>& coverage_engines();

} // namespace voxrt::voxelize
