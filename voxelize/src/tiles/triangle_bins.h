// Triangles listed by tile, in authored order.
//
// A part that few tiles need, or that has few triangles, is listed as a whole: its tiles snap its vertices themselves.
// Cost: the analysis of the meshes, in parallel; then a serial counting sort, about 5 ns per entry.
#pragma once

#include "../mesh/mesh_analysis.h"
#include "../work/workers.h"

#include <span>

namespace voxrt::voxelize {

struct TriangleBins {
    std::vector<MeshAnalysis> meshes;      // by part; those of solids stay empty
    std::vector<uint32_t> starts;          // tile t owns triangles starts[t] … starts[t+1]-1
    std::vector<BinnedTriangle> triangles; // by tile, then part and triangle in authored order
    int tiles_per_side = 0;
    double seconds = 0; // that the sort took
};

/// Analyses and bins the parts for a grid of `side` voxels. `wanted_objects`: by object, 0 where it is left out; empty
/// for all. Throws OutOfRange, and std::length_error where the tiles would list 2^32 triangles or more.
TriangleBins bin_triangles(const std::vector<PartView>& parts, std::span<const uint8_t> wanted_objects, int side,
                           const Workers& workers);

} // namespace voxrt::voxelize
