// First pass over the parts: vertices snapped, closure tested, triangles listed by tile.
//
// A part that few tiles need, or that has few triangles, is listed as a whole: its tiles snap its vertices themselves.
// What instances of one mesh have in common is found once, so that millions of instanced triangles cost nothing here.
//
// Bound: 30 ns a triangle, in parallel; the listing's counting sort, 5 ns an item, is serial.
#pragma once

#include "parallel.h"
#include "stage_seconds.h"
#include "tiling.h"
#include "turned_pieces.h"

#include <memory>

namespace voxrt {

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
    std::shared_ptr<const Boundary> boundary;   // where not closed and to be filled
    std::unique_ptr<OpenSurface> open;          // the same; null in an instance whose tiles make it themselves
    std::shared_ptr<const TurnedPieces> turned; // null where none is; the rest is then as `inverted` says
};

struct Survey {
    std::vector<SurveyedMesh> meshes; // by part
    std::vector<uint32_t> starts;     // tile t owns items starts[t] … starts[t+1]-1
    std::vector<Item> items;          // by tile, then part and triangle in authored order
    int tiles_a_side = 0;
    double bin_seconds = 0; // that the listing took
};

/// Surveys the parts for a grid of `side` voxels. Throws OutOfReach.
/// `fill`: find what open parts need to be filled.
Survey survey_parts(const std::vector<PartView>& parts, int side, bool fill, Workers& workers);

} // namespace voxrt
