// Whether more than two faces meet at some edge, found without a table of the edges (mesh_edges.h).
#pragma once

#include "../scene/parts.h"

#include <vector>

namespace voxrt::voxelize {

/// For a surface whose edges are all walked as often one way as the other: whether one of them is walked twice the same
/// way. Vertices at one position count as one: `vertex_keys` are those of closed_surface.h. Compares 31 bits of a hash,
/// so one edge of 10^9 is taken for another. About 15 ns per triangle.
bool has_nonmanifold_edges(const MeshView& mesh, const std::vector<uint64_t>& vertex_keys);

} // namespace voxrt::voxelize
