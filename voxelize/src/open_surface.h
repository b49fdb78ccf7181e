// An open surface made closable: its boundary edges found, its holes capped, its mere sheets told apart.
//
// A hole is a connected piece of the boundary; it is capped by the fan from its mean point. A connected piece of the
// surface whose caps are nearly as large as itself is a sheet. Sheets that together enclose nothing (their generalized
// winding number stays low) have a shell and no inside; panels that stand around a room do enclose it.
#pragma once

#include "hole_winding.h"
#include "parts.h"

namespace voxrt {

struct OpenSurface {
    std::vector<uint8_t> sheet;              // by triangle: 1 has no inside; empty where none
    std::vector<std::array<Vertex, 3>> caps; // a triangle as often as it counts; they close the rest
    HoleWinding holes;                       // the same caps
};

/// `vertices`: the mesh's, snapped. Bound: sorting the edges.
OpenSurface open_surface(const MeshView& mesh, const std::vector<Vertex>& vertices);

} // namespace voxrt
