// Connected components of a surface that are inside out beside the others.
//
// The winding number inside a component whose normals point inwards is -1: where it overlaps another component the two
// would cancel. So each connected closed component is made to face outwards, by the sign of its volume. But a component
// that lies inside others may be the wall of a cavity: it keeps its orientation relative to the smallest component
// around it, and is flipped where that one is: see enclosing_components.h.
//
// Cost: the triangles, about 10 ns each, where there is one component or all face one way; else also queries of a
// bounding volume hierarchy.
#pragma once

#include "../holes/capped_surface.h"

namespace voxrt::voxelize {

/// Completes an orientation. Leaves it as it is where no component is to be flipped, or all are: then the surface as a
/// whole is inverted.
///
/// `vertices`: a position per vertex, in grid space or in any finer lattice. `caps`: what closes the surface, or null
/// where it closes by itself. Components with caps that are more than seams are never flipped, nor are others beside
/// such a one that is inside out. Caps stay as they are: they are to be found anew. `edges`: of the mesh, cut, with
/// its bodies; null where nobody needed them, so that parts that touch at a vertex alone are one component.
struct FlippedComponents {
    std::shared_ptr<const Orientation> orientation;
    bool has_flat; // of several components one has no volume
};
FlippedComponents flip_components(const MeshView& mesh, const std::vector<Vertex>& vertices,
                                  std::shared_ptr<const Orientation> orientation, const HoleCaps* caps,
                                  const MeshEdges* edges, const Bodies* bodies);

} // namespace voxrt::voxelize
