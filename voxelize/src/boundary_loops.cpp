#include "boundary_loops.h"

#include "parallel.h"

namespace voxrt {
namespace {

constexpr uint32_t kNowhere = 0xFFFF'FFFF;

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
    std::vector<uint32_t> next(vertices, kNowhere), place(vertices, kNowhere);
    for (size_t i = edges.size(); i-- > 0;)
        next[edges[i].from] = uint32_t(i);
    std::vector<BoundaryLoop> loops;
    std::vector<uint32_t> path;
    std::vector<size_t> turned; // edges of the path up to each vertex
    for (const BoundaryEdge& start : std::vector<BoundaryEdge>(edges)) {
        path = {start.from};
        turned = {0};
        place[start.from] = 0;
        while (true) {
            uint32_t& edge = next[path.back()];
            while (edge < edges.size() && edges[edge].from == path.back() && edges[edge].times == 0)
                ++edge;
            if (edge >= edges.size() || edges[edge].from != path.back())
                break; // at the start again, and all its edges are walked
            pulse(5);
            --edges[edge].times;
            const uint32_t to = edges[edge].to;
            const size_t so_far = turned.back() + (edges[edge].turned ? 1 : 0);
            if (place[to] == kNowhere) {
                place[to] = uint32_t(path.size());
                path.push_back(to);
                turned.push_back(so_far);
                continue;
            }
            loops.push_back({{path.begin() + place[to], path.end()}, so_far - turned[place[to]]});
            while (path.back() != to) {
                place[path.back()] = kNowhere;
                path.pop_back();
                turned.pop_back();
            }
        }
        place[start.from] = kNowhere;
    }
    return loops;
}

void close_loop(const std::vector<uint32_t>& loop, std::vector<std::array<uint32_t, 3>>& caps) {
    close_between(loop, 0, loop.size() - 1, caps);
}

} // namespace voxrt
