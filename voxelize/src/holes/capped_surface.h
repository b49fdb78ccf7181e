// A surface with holes, closed by caps; openings that were meant to be open are told from holes.
//
// A hole in a scan is a flaw: what it opens is filled all the same. Rooms without a front, bowls and sheets are open by
// design and keep a shell alone. They are recognized so: a connected component is open where one of its boundary loops,
// closed, has a large area beside the component itself (its vector area, so that it does not matter how it is closed;
// an edge at which triangles are wound against one another opens nothing). Open components may close one another, as a
// box and its lid or the panels around a room do. Then hardly any direction leads out of what they enclose; their
// generalized winding number is the share of those that do not.
//
// Clothes are such that no opening is large, and yet nobody means them to be filled. With Fill::automatic a component
// is open too where all its loops together, closed, exceed a smaller share of its area, and what open components
// enclose together must be tighter. A scan with holes stays below that share.
#pragma once

#include "../faces/orientation.h"
#include "../scene/fill.h"
#include "cap_winding.h"

#include <memory>

namespace voxrt::voxelize {

/// What closes a mesh.
struct HoleCaps {
    std::vector<std::array<uint32_t, 3>> triangles; // vertices of the mesh
    size_t seams = 0;                               // so many of them, the first ones, close the seams of bodies
    std::vector<uint8_t> shell_only; // by triangle of the mesh: 1 in an open component; empty where none is
    double opening = 0; // the largest share of its area that the loops of a filled component, closed, have together
    bool has_open_enclosure = false; // an open component encloses space, as a room without a front does

    /// Whether the surface closes but for rounding and the seams of T-junctions.
    bool are_seams() const { return shell_only.empty() && opening < 1e-6; }
};

/// `edges`: not cut. `cuts`: of them, in their order. `bodies`: with a note which of them close over cut edges.
/// `points`: a position per vertex. `orientation`: null where all faces are as the file says. Linear in the faces.
HoleCaps find_hole_caps(const MeshEdges& edges, const std::vector<EdgeCut>& cuts, const Bodies& bodies,
                        const Orientation* orientation, const std::vector<Point>& points, Fill fill);

/// A mesh part and its caps in grid space.
struct CappedSurface {
    /// `at(vertex)`: the snapped position of a vertex.
    template <class At> CappedSurface(std::shared_ptr<const HoleCaps> found, At&& at);

    std::shared_ptr<const HoleCaps> hole_caps;
    std::vector<std::array<Vertex, 3>> caps;
    CapWinding cap_winding; // of the same caps

    bool is_shell_only(size_t triangle) const {
        return !hole_caps->shell_only.empty() && hole_caps->shell_only[triangle] != 0;
    }
};

inline Point in_voxels(const Vertex& v) { return {double(v.x) / kUnit, double(v.y) / kUnit, double(v.z) / kUnit}; }

template <class At>
CappedSurface::CappedSurface(std::shared_ptr<const HoleCaps> found, At&& at) : hole_caps(std::move(found)) {
    std::vector<CapWinding::Cap> positions;
    caps.reserve(hole_caps->triangles.size());
    positions.reserve(hole_caps->triangles.size());
    for (const auto& [a, b, c] : hole_caps->triangles) {
        const auto& cap = caps.emplace_back(std::array<Vertex, 3>{at(a), at(b), at(c)});
        positions.push_back({in_voxels(cap[0]), in_voxels(cap[1]), in_voxels(cap[2])});
    }
    cap_winding = CapWinding(std::move(positions));
}

} // namespace voxrt::voxelize
