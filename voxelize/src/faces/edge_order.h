// The faces at an edge, in the order in which one meets them on the way around it. Exact.
#pragma once

#include "exact_predicates.h"
#include "mesh_edges.h"
#include "sheets.h"

namespace voxrt::voxelize {

/// Orders the faces at an edge counter-clockwise, seen against its direction from `low` to high. The first one has an
/// area; faces without area follow it. rank_of(face) orders faces that lie upon one another. n log n.
template <class RankOf>
void sort_about_edge(uint32_t low, std::vector<EdgeUse>& uses, const std::vector<Vertex>& at, RankOf&& rank_of) {
    struct Placed {
        EdgeUse use;
        std::array<int, 3> normal; // counter-clockwise about the edge
        int half;                  // 0: at the first face; 1: less than half a turn from it; 2: half a turn; 3: more
        StackRank rank;
    };
    const Vertex &u = at[low], &v = at[uses[0].high];
    std::vector<Placed> order;
    for (const EdgeUse& use : uses)
        order.push_back({use, normal_signs(u, v, at[use.opposite]), 0, rank_of(use.face)});
    constexpr std::array<int, 3> kNone{0, 0, 0};
    const auto with_area = std::find_if(order.begin(), order.end(), [&](const Placed& p) { return p.normal != kNone; });
    const Placed origin = with_area != order.end() ? *with_area : order[0];
    const auto turn = [&](const Placed& a, const Placed& b) {
        return sign_of(volume6_of(v, at[a.use.opposite], at[b.use.opposite], u));
    };
    for (Placed& placed : order) {
        const int side = turn(origin, placed);
        const bool ahead = placed.normal == origin.normal || placed.normal == kNone;
        placed.half = side > 0 ? 1 : side < 0 ? 3 : ahead ? 0 : 2;
    }
    std::sort(order.begin(), order.end(), [&](const Placed& a, const Placed& b) {
        if (a.half != b.half)
            return a.half < b.half;
        if (const int side = a.half % 2 == 1 ? turn(a, b) : 0; side != 0)
            return side > 0;
        if ((a.normal == kNone) != (b.normal == kNone))
            return b.normal == kNone;
        if (a.normal != kNone && a.rank != b.rank)
            return points_up(a.normal) == (a.rank < b.rank);
        return a.use.face < b.use.face;
    });
    for (size_t i = 0; i < uses.size(); ++i)
        uses[i] = order[i].use;
}

} // namespace voxrt::voxelize
