// The boundary of a surface as loops, and triangles that close them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt {

/// An edge that triangles walk oftener from `from` to `to` than back.
struct BoundaryEdge {
    uint32_t from, to;
    int times;           // how much oftener
    bool turned = false; // an even number of triangles meets here: one is wound against another, and nothing is open
};

struct BoundaryLoop {
    std::vector<uint32_t> vertices;
    size_t turned = 0; // edges
};

/// Cuts edges, sorted by `from`, into loops that pass no vertex twice. Every vertex is left as often as it is entered,
/// as the boundary of triangles is.
///
/// Bound: the edges.
std::vector<BoundaryLoop> cut_into_loops(std::vector<BoundaryEdge> edges, size_t vertices);

/// Adds the triangles that close a loop, facing as the surface around it does: one between its ends and its middle,
/// then the halves likewise. So all but few are small and lie at the rim.
void close_loop(const std::vector<uint32_t>& loop, std::vector<std::array<uint32_t, 3>>& caps);

} // namespace voxrt
