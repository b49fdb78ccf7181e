// An open surface made closable: its holes capped, and told apart from what is open on purpose.
//
// A hole in a scan is a flaw: what it opens is filled all the same. Rooms without a front, bowls and sheets are open as
// they were made, and have a shell alone. They are told so: a connected piece of the surface stands open where one of
// its loops of boundary, closed, is large beside the piece itself (by its vector area, so that it does not matter how
// it is closed; a face wound against its neighbours opens nothing). Pieces that stand open may close one another, as a
// box and its lid or the panels around a room do. Then hardly any direction leads out from what they enclose; their
// generalized winding number is the share of those that do not.
#pragma once

#include "hole_winding.h"
#include "parts.h"

#include <memory>

namespace voxrt {

/// What closes a surface.
struct Boundary {
    std::vector<std::array<uint32_t, 3>> caps; // three vertices each
    std::vector<uint8_t> shell_only;           // by triangle: 1 is part of what stands open; empty where none
    bool stands_open = false;                  // some of that encloses something, as a room without a front does
};

/// `points`: a position each vertex; vertices at one position count as one. Bound: sorting the edges.
Boundary find_boundary(const MeshView& mesh, const std::vector<Point>& points);

struct OpenSurface {
    /// `at`: the snapped position of a vertex.
    template <class At> OpenSurface(std::shared_ptr<const Boundary> found, At&& at);

    std::shared_ptr<const Boundary> boundary;
    std::vector<std::array<Vertex, 3>> caps;
    HoleWinding holes; // the same caps

    bool is_shell_only(size_t triangle) const {
        return !boundary->shell_only.empty() && boundary->shell_only[triangle] != 0;
    }
};

inline Point in_voxels(const Vertex& v) { return {double(v.x) / kUnit, double(v.y) / kUnit, double(v.z) / kUnit}; }

template <class At>
OpenSurface::OpenSurface(std::shared_ptr<const Boundary> found, At&& at) : boundary(std::move(found)) {
    std::vector<HoleWinding::Cap> seen;
    caps.reserve(boundary->caps.size());
    seen.reserve(boundary->caps.size());
    for (const auto& [a, b, c] : boundary->caps) {
        const auto& cap = caps.emplace_back(std::array<Vertex, 3>{at(a), at(b), at(c)});
        seen.push_back({in_voxels(cap[0]), in_voxels(cap[1]), in_voxels(cap[2])});
    }
    holes = HoleWinding(std::move(seen));
}

} // namespace voxrt
