// Edges that others meet between their ends: T-junctions.
//
// CAD programs write the faces along a seam with vertices that the faces beyond it do not have. The surface closes all
// the same, so the faces on both sides are to be wound alike. Edges that more faces walk one way than the other are cut
// where the ends of others lie on them, as far as the rounding of vertices lets one tell. Where there are such, all
// edges are cut where vertices lie on them, if they pair as well then: faces of two parts that touch may pair by
// chance.
//
// Cost: a query of a bounding volume hierarchy per unpaired edge; about 100 ns. Where there are seams, per edge.
#pragma once

#include "../faces/mesh_edges.h"

namespace voxrt::voxelize {

/// The edges to be cut, in the order of `edges`. `vertices`: in a lattice. `rounding`: how far a vertex may lie from
/// the edge that it was meant to be on, as a part of the size of the mesh.
std::vector<EdgeCut> find_cuts(const MeshEdges& edges, const std::vector<Vertex>& vertices, double rounding);

} // namespace voxrt::voxelize
