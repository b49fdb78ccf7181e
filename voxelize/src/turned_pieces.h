// Pieces of a surface that are inside out beside the others.
//
// The winding number of a piece whose normals point inwards is -1: where it overlaps another piece the two would
// cancel. So each connected closed piece is made to face outwards by its own signed volume. But a piece that lies
// inside others may be the wall of a cavity: there it keeps facing as it does beside the smallest piece around it,
// turned with it or not. A piece lies inside another when none of its vertices is outside and the two surfaces do not
// pass through one another; they may touch. All of that is exact, in integers.
//
// Bound: the triangles, 10 ns each, where there is one piece or all face one way; else finding triangles in a tree.
#pragma once

#include "open_surface.h"

namespace voxrt {

struct TurnedPieces {
    std::vector<uint8_t> triangles; // 1 where a triangle is to be taken the other way round; empty where none is
    uint32_t count = 0;             // pieces turned
    bool is_turned(size_t triangle) const { return !triangles.empty() && triangles[triangle] != 0; }
};

/// Null where no piece is to be turned, or all are: then the surface as a whole is inside out.
///
/// `vertices`: a position each, in grid space or in any finer lattice. `boundary`: what closes the surface where it is
/// open. Pieces with caps are never turned, nor are others beside a capped one that is inside out.
std::shared_ptr<const TurnedPieces> find_turned_pieces(const MeshView& mesh, const std::vector<Vertex>& vertices,
                                                       const Boundary* boundary);

} // namespace voxrt
