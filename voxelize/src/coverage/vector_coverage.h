// Which voxels a triangle covers, eight planes or columns at a time.
//
// vector_coverage_body.h is compiled once per instruction set. All give the same voxels.
#pragma once

#include "column_sheets.h"
#include "tile_surface.h"

namespace voxrt::voxelize {

/// Whether triangle abc is for these functions: up to 4096 voxels wide, and neither flat on a plane, nor one voxel wide
/// in two axes, nor below the grid, nor wide and all but upright.
bool fits_vectors(const Vertex& a, const Vertex& b, const Vertex& c);

/// Whether they find the pieces of triangle abc (volume_pieces.h), too: it fits vectors, is no higher than voxel `top`,
/// and not upright, and its extent in voxels, times its slope or 1, is below `limit`: kFineLimit for errors below
/// 2^-42, kHalfLimit for errors below 2^-34.
bool fits_pieces(const Vertex& a, const Vertex& b, const Vertex& c, int top, double limit);
inline constexpr double kFineLimit = 0x1p7, kHalfLimit = 0x1p15;

/// Whether triangle abc is a segment or a point, seen along z.
inline bool is_upright(const Vertex& a, const Vertex& b, const Vertex& c) {
    return (int64_t{b.x} - a.x) * (int64_t{c.y} - a.y) == (int64_t{b.y} - a.y) * (int64_t{c.x} - a.x);
}

/// Whether a triangle that is not upright faces downwards.
inline bool faces_down(const Vertex& a, const Vertex& b, const Vertex& c) {
    return (int64_t{b.x} - a.x) * (int64_t{c.y} - a.y) < (int64_t{b.y} - a.y) * (int64_t{c.x} - a.x);
}

/// What is wanted beside the voxels that a triangle covers.
struct Wanted {
    bool crosses = false;           // which columns it crosses
    bool centres = false;           // at their centres (centre_crossings.h). Not of upright triangles
    bool holds = false;             // which centres lie on it, with `centres`
    bool pieces = false;            // its pieces
    ColumnSheets* sheets = nullptr; // takes it into its sheet, with `crosses` and `centres`
};

/// Adds to a surface what triangle abc covers of the surface's tile, and what else is wanted. `window`: the tile's.
/// The engine of the page has none: compiled to WebAssembly, eight at once take twice the time of one after the other.
using CoverByVectors = void (*)(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window,
                                const Wanted& wanted, TileSurface& surface);

/// Finds which voxels are in doubt. `top`: the grid's last voxel along z.
using FindDoubts = void (*)(ColumnSheets& sheets, int top);

/// Adds what triangle abc adds to its sheet's volumes, or pieces in doubtful columns to the surface. The triangle
/// fits_pieces().
using AddToSheet = void (*)(const Vertex& a, const Vertex& b, const Vertex& c, const Window& window,
                            ColumnSheets& sheets, TileSurface& surface);

struct CoverageEngine {
    const char* instructions;
    CoverByVectors cover_by_vectors;
    FindDoubts find_doubts;
    AddToSheet add_to_halved, add_to_doubtful;
};
extern const CoverageEngine kPortableCoverage;
#if defined(__x86_64__)
extern const CoverageEngine kAvx2Coverage, kAvx512Coverage;
#endif

/// The instruction sets that this processor has, the fastest first.
const std::vector<CoverageEngine>& coverage_engines();

} // namespace voxrt::voxelize
