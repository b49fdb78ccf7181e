// An open surface made closable: its boundary edges found, its holes capped, its mere sheets told apart.
//
// A hole is a connected piece of the boundary; it is capped by the fan from its mean point. A connected piece of the
// surface whose caps are nearly as large as itself is a sheet. Sheets that together enclose nothing (their generalized
// winding number stays low) have a shell and no inside; panels that stand around a room do enclose it.
#pragma once

#include "hole_winding.h"
#include "parts.h"

#include <memory>

namespace voxrt {

/// The edges that a surface walks oftener one way than the other, its sheets left out.
struct Boundary {
    struct Edge {
        uint32_t from, to;
        int times;     // how much oftener it is walked this way than back
        uint32_t hole; // which it is part of
    };
    std::vector<Edge> edges;
    uint32_t holes = 0;
    std::vector<uint8_t> sheet; // by triangle: 1 has no inside; empty where none
};

/// `points`: a position each vertex; vertices at one position count as one. Bound: sorting the edges.
Boundary find_boundary(const MeshView& mesh, const std::vector<Point>& points);

struct OpenSurface {
    /// `at`: the snapped position of a vertex.
    template <class At> OpenSurface(std::shared_ptr<const Boundary> found, At&& at);

    std::shared_ptr<const Boundary> boundary;
    std::vector<std::array<Vertex, 3>> caps; // a triangle as often as it counts
    HoleWinding holes;                       // the same caps

    bool is_sheet(size_t triangle) const { return !boundary->sheet.empty() && boundary->sheet[triangle] != 0; }
};

inline Point in_voxels(const Vertex& v) { return {double(v.x) / kUnit, double(v.y) / kUnit, double(v.z) / kUnit}; }

template <class At>
OpenSurface::OpenSurface(std::shared_ptr<const Boundary> found, At&& at) : boundary(std::move(found)) {
    struct Mean {
        int64_t x = 0, y = 0, z = 0, count = 0;
        Vertex rounded() const {
            return {int32_t(floor_div(x, count)), int32_t(floor_div(y, count)), int32_t(floor_div(z, count))};
        }
    };
    std::vector<Mean> means(boundary->holes);
    for (const Boundary::Edge& edge : boundary->edges)
        for (const Vertex& v : {at(edge.from), at(edge.to)}) {
            Mean& mean = means[edge.hole];
            mean.x += v.x;
            mean.y += v.y;
            mean.z += v.z;
            ++mean.count;
        }
    std::vector<HoleWinding::Cap> seen;
    for (const Boundary::Edge& edge : boundary->edges) {
        // A cap walks its edge backwards.
        const std::array<Vertex, 3> cap = {at(edge.to), at(edge.from), means[edge.hole].rounded()};
        for (int i = 0; i < edge.times; ++i)
            caps.push_back(cap);
        seen.push_back({{in_voxels(cap[0]), in_voxels(cap[1]), in_voxels(cap[2])}, edge.times});
    }
    holes = HoleWinding(std::move(seen));
}

} // namespace voxrt
