// Which way the faces of a mesh are wound, where the file does not say it consistently.
//
// A surface that encloses space encloses it however its faces are turned. So the faces of a body (bodies.h) are looked
// at together. Each face has two sides; two sides belong to one cell where one can walk from one to the other around an
// edge, by the order of the faces about that edge. The cell with the least volume, as its sides see it, is the outside;
// all others are inside (cells of an arrangement: Zhou, Grinspun, Zorin and Jacobson, "Mesh Arrangements for Solid
// Geometry", 2016, here for faces that meet at edges alone). Walls between two cells of the inside, and faces with the
// outside on both sides, decide nothing. What remains closes exactly, whatever its faces cross; where it does not count
// as one sees it from outside, what is seen decides (patch_signs.h).
//
// Bodies whose edges are walked as often one way as the other keep the orientation of the file: its cavities
// stay. The exception are faces stored twice, once for each side: they count once, where they enclose something or
// where all faces of a piece are so.
//
// Where faces enclose nothing, those that meet in pairs are turned to face as most of them do. A piece that has one
// side only, like a Klein bottle, stays as it is, and is counted.
#pragma once

#include "bodies.h"

#include <memory>

namespace voxrt::voxelize {

/// How the winding number takes the faces of a mesh.
struct Orientation {
    static constexpr uint8_t kReversed = 1;  // the other way around
    static constexpr uint8_t kUncounted = 2; // it does not decide what is inside
    static constexpr uint8_t kSettled = 4;   // it opens nothing: it is a part of what closes, or does not count
    static constexpr uint8_t kRepeated = 8;  // an earlier face has the same corners

    std::vector<uint8_t> faces; // by face
    uint32_t turned = 0;        // faces that were wound against those beside them
    uint32_t one_sided = 0;     // pieces that cannot be wound consistently
    uint32_t unsure = 0;        // components that may not count as one sees them
    uint32_t components = 0;    // connected components that were inside out (flipped_components.h)

    bool is_reversed(size_t face) const { return (faces[face] & kReversed) != 0; }
    bool is_uncounted(size_t face) const { return (faces[face] & kUncounted) != 0; }
    bool is_repeated(size_t face) const { return (faces[face] & kRepeated) != 0; }
    bool is_settled(size_t face) const { return (faces[face] & kSettled) != 0; }
    /// Corners in the order of the winding number.
    template <class Corner> std::array<Corner, 3> turned_corners(size_t face, std::array<Corner, 3> corners) const {
        if (is_reversed(face))
            std::swap(corners[1], corners[2]);
        return corners;
    }
};

/// How often the winding number has a face walk its edge from low to high. `orientation`: null where all faces are as
/// the file says.
inline int counted_upwards(const Orientation* orientation, const EdgeUse& use) {
    if (orientation == nullptr)
        return use.is_upwards ? 1 : -1;
    return orientation->is_uncounted(use.face)                           ? 0
           : (use.is_upwards != 0) == orientation->is_reversed(use.face) ? -1
                                                                         : 1;
}

/// Null where all is as the file says. `whole`: the edges of the faces. `edges`: the same, or cut where other edges
/// meet them (mesh/edge_cuts.h). `bodies`: connected over `edges`. `vertices`: by vertex of the mesh, in grid space or
/// in any finer lattice. `flat`: some of the surface has no volume, so that consistent faces may be two sides of one.
/// Linear in the faces but for sorting those at edges of more than two.
std::shared_ptr<const Orientation> find_orientation(const MeshEdges& whole, const MeshEdges& edges,
                                                    const Bodies& bodies, const std::vector<Vertex>& vertices,
                                                    bool flat);

} // namespace voxrt::voxelize
