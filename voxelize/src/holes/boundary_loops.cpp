#include "boundary_loops.h"

#include "../work/interrupt.h"

namespace voxrt::voxelize {
namespace {

constexpr uint32_t kNone = 0xFFFF'FFFF;

/// Closes what lies between vertices `from` and `to` of a loop.
void close_between(const std::vector<uint32_t>& loop, size_t from, size_t to,
                   std::vector<std::array<uint32_t, 3>>& caps) {
    if (to - from < 2)
        return;
    const size_t middle = from + (to - from) / 2;
    caps.push_back({loop[to], loop[middle], loop[from]}); // a cap walks the boundary backwards
    close_between(loop, from, middle, caps);
    close_between(loop, middle, to, caps);
}

} // namespace

std::vector<BoundaryLoop> cut_into_loops(std::vector<BoundaryEdge> edges, size_t vertices) {
    std::vector<uint32_t> next(vertices, kNone), position(vertices, kNone);
    for (size_t i = edges.size(); i-- > 0;)
        next[edges[i].from] = uint32_t(i);
    std::vector<BoundaryLoop> loops;
    std::vector<uint32_t> path;
    std::vector<size_t> inconsistent; // edges of the path up to each vertex
    for (const BoundaryEdge& start : std::vector<BoundaryEdge>(edges)) {
        path = {start.from};
        inconsistent = {0};
        position[start.from] = 0;
        while (true) {
            uint32_t& edge = next[path.back()];
            while (edge < edges.size() && edges[edge].from == path.back() && edges[edge].times == 0)
                ++edge;
            if (edge >= edges.size() || edges[edge].from != path.back())
                break; // at the start again, and all its edges are walked
            count_work(5);
            --edges[edge].times;
            const uint32_t to = edges[edge].to;
            const size_t so_far = inconsistent.back() + (edges[edge].inconsistent ? 1 : 0);
            if (position[to] == kNone) {
                position[to] = uint32_t(path.size());
                path.push_back(to);
                inconsistent.push_back(so_far);
                continue;
            }
            loops.push_back({{path.begin() + position[to], path.end()}, so_far - inconsistent[position[to]]});
            while (path.back() != to) {
                position[path.back()] = kNone;
                path.pop_back();
                inconsistent.pop_back();
            }
        }
        position[start.from] = kNone;
    }
    return loops;
}

void close_loop(const std::vector<uint32_t>& loop, std::vector<std::array<uint32_t, 3>>& caps) {
    close_between(loop, 0, loop.size() - 1, caps);
}

} // namespace voxrt::voxelize
