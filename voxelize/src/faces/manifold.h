// Whether a closed surface is a manifold: two faces meet at each edge, and the faces at each vertex are one fan.
//
// Found without a table of the edges (mesh_edges.h), which takes several times as long.
#pragma once

#include "../scene/parts.h"

#include <vector>

namespace voxrt::voxelize {

/// For a surface whose edges are all walked as often one way as the other. Vertices at one position count as one:
/// `vertex_keys` are those of closed_surface.h. About 30 ns per triangle.
bool is_manifold(const MeshView& mesh, const std::vector<uint64_t>& vertex_keys);

} // namespace voxrt::voxelize
