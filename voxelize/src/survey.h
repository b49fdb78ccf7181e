// First pass over the parts: vertices snapped, closure tested, triangles counted into tiles.
#pragma once

#include "closure.h"
#include "open_surface.h"
#include "parallel.h"
#include "parts.h"
#include "triangle_coverage.h"

#include <memory>

namespace voxrt {

inline constexpr uint32_t kWhole = 0xFFFF'FFFF;

/// One entry of a tile: a triangle of a part, or the part as a whole. Triangles are followed by the caps of an open
/// part, and these by one number that stands for nothing: it brings the tile to look inside.
struct Item {
    uint32_t part, triangle;
};

/// Voxels that a part may cover or enclose, inclusive.
struct VoxelBox {
    int low[3], high[3];
};

/// What the survey found out about a mesh part.
struct SurveyedMesh {
    std::vector<Vertex> vertices; // snapped; empty where tiles snap the vertices themselves
    bool closed = false;
    bool inverted = false; // closed, its normals pointing inside
    VoxelBox box{};
    std::unique_ptr<OpenSurface> open; // where not closed and to be filled
};

struct Survey {
    std::vector<SurveyedMesh> meshes; // by part
    std::vector<uint32_t> starts;     // tile t owns items starts[t] … starts[t+1]-1
    std::vector<Item> items;          // by tile, then part and triangle in authored order
    int tiles_a_side = 0;
};

/// Surveys the parts for a grid of `side` voxels. Throws OutOfReach.
/// `fill`: find what open parts need to be filled.
Survey survey_parts(const std::vector<PartView>& parts, int side, bool fill, Workers& workers);

} // namespace voxrt
