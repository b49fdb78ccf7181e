// Connected coplanar faces, and their places in a stack of such: several may lie upon one another.
//
// The faces of a part of the surface that touches another in a plane lie on one side of it. So the sheet of the part
// below is the lower one, however the faces of both are turned.
#pragma once

#include "../work/disjoint_sets.h"
#include "exact_predicates.h"
#include "mesh_edges.h"

#include <compare>

namespace voxrt::voxelize {

/// The signs of the normal of triangle uvw. Normals of parallel planes are equal or opposite as these are.
inline std::array<int, 3> normal_signs(const Vertex& u, const Vertex& v, const Vertex& w) {
    const auto part = [&](int32_t Vertex::* i, int32_t Vertex::* j) {
        return sign_of((int128(v.*i) - u.*i) * (int128(w.*j) - u.*j) - (int128(v.*j) - u.*j) * (int128(w.*i) - u.*i));
    };
    return {part(&Vertex::y, &Vertex::z), part(&Vertex::z, &Vertex::x), part(&Vertex::x, &Vertex::y)};
}

/// Whether a normal points up: of a normal and its opposite, one does.
inline bool points_up(const std::array<int, 3>& normal) { return normal > std::array<int, 3>{0, 0, 0}; }

/// The place of a face in a stack of coplanar faces, from below.
struct StackRank {
    int side;       // of the plane where its part of the surface lies: -1 below, 1 above, 0 not known
    bool faces_up;  // so that faces that point away from the stack are its ends
    uint32_t sheet; // as a number
    auto operator<=>(const StackRank&) const = default;
};

class Sheets {
public:
    /// each_edge(visit) calls visit(low, uses) for each edge, whose lower vertex is `low`. The edges and `at`, the
    /// place of each vertex, must outlive this.
    template <class EachEdge>
    Sheets(const MeshEdges& edges, const std::vector<Vertex>& at, EachEdge&& each_edge)
        : edges_(edges), at_(at), sheets_(edges.face_count()), is_above_(2 * edges.face_count()),
          is_known_(2 * edges.face_count(), false) {
        each_edge([&](uint32_t low, const std::vector<EdgeUse>& uses) {
            if (uses.size() == 2 && are_coplanar(low, uses[0], uses[1]) && !are_stacked(low, uses[0], uses[1]))
                sheets_.merge(uses[0].face, uses[1].face);
        });
        each_edge([&](uint32_t low, const std::vector<EdgeUse>& uses) {
            for (size_t i = 0; i < uses.size() && uses.size() <= kMostFaces; ++i)
                for (size_t j = 0; j < i; ++j)
                    if (are_stacked(low, uses[i], uses[j]))
                        oppose(uses[i].face, uses[j].face);
        });
        each_edge([&](uint32_t low, const std::vector<EdgeUse>& uses) {
            if (uses.size() == 2 && !are_coplanar(low, uses[0], uses[1])) {
                note_wall(uses[0].face, at[uses[1].opposite]);
                note_wall(uses[1].face, at[uses[0].opposite]);
            }
        });
    }

    StackRank rank_of(uint32_t face) {
        const uint32_t sheet = sheets_.find(face), above = is_above_.find(2 * sheet),
                       below = is_above_.find(2 * sheet + 1);
        const bool is_above = is_known_[above], is_below = is_known_[below];
        int side = is_above - is_below;
        if (!is_above && !is_below && above != below) // nor of those upon it: the lowest face decides
            side = (above < below) == faces_up(std::min(above, below) / 2) ? 1 : -1;
        return {side, faces_up(sheet), sheet};
    }

private:
    static constexpr size_t kMostFaces = 64; // at an edge whose stacks are looked at

    bool are_coplanar(uint32_t low, const EdgeUse& a, const EdgeUse& b) const {
        return volume6_of(at_[a.high], at_[a.opposite], at_[b.opposite], at_[low]) == 0;
    }

    bool are_stacked(uint32_t low, const EdgeUse& a, const EdgeUse& b) const {
        const Vertex &u = at_[low], &v = at_[a.high];
        return are_coplanar(low, a, b) && normal_signs(u, v, at_[a.opposite]) == normal_signs(u, v, at_[b.opposite]);
    }

    /// Of two sheets upon one another, one is that of a part above, the other of a part below.
    void oppose(uint32_t face, uint32_t other) {
        const uint32_t a = sheets_.find(face), b = sheets_.find(other);
        is_above_.merge(2 * a, 2 * b + 1);
        is_above_.merge(2 * a + 1, 2 * b);
    }

    /// Notes that the face beside `face` leads to `v`.
    void note_wall(uint32_t face, const Vertex& v) {
        const Corners c = edges_.corners(face);
        const bool in_front = volume6_of(at_[c[0]], at_[c[1]], at_[c[2]], v) < 0;
        is_known_[is_above_.find(2 * sheets_.find(face) + (in_front != faces_up(face)))] = true;
    }

    bool faces_up(uint32_t face) const {
        const Corners c = edges_.corners(face);
        return points_up(normal_signs(at_[c[0]], at_[c[1]], at_[c[2]]));
    }

    const MeshEdges& edges_;
    const std::vector<Vertex>& at_;
    DisjointSets sheets_;   // the lowest face of a sheet tells which way it faces
    DisjointSets is_above_; // for each sheet whether it is above, and whether it is below: those that are the same
    std::vector<bool> is_known_;
};

} // namespace voxrt::voxelize
