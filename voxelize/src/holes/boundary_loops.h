// The boundary of a surface as loops of edges, and triangles that close a loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::voxelize {

/// An edge that more triangles walk from `from` to `to` than back.
struct BoundaryEdge {
    uint32_t from, to;
    int times; // how many more
    bool inconsistent =
        false; // an even number of triangles meets here: some are wound against others, and nothing is open
};

struct BoundaryLoop {
    std::vector<uint32_t> vertices;
    size_t inconsistent = 0; // edges
};

/// Cuts edges, sorted by `from`, into loops that pass no vertex twice. `vertices` is above every vertex. Each vertex
/// must be left as often as it is entered; the boundary of triangles is. Linear in the edges.
std::vector<BoundaryLoop> cut_into_loops(std::vector<BoundaryEdge> edges, size_t vertices);

/// Appends the triangles that close a loop, facing as the surface around it does: one between the loop's ends and its
/// middle, then the halves likewise. So all but few are small and lie near the loop.
void close_loop(const std::vector<uint32_t>& loop, std::vector<std::array<uint32_t, 3>>& caps);

} // namespace voxrt::voxelize
