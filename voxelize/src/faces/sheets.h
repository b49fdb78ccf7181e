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
    int wall_side;  // where the faces beside its sheet lead: -1 below its plane, 1 above it, 0 to both sides
    bool faces_up;  // so that faces that point away from the stack are its ends
    uint32_t sheet; // as a number
    auto operator<=>(const StackRank&) const = default;
};

class Sheets {
public:
    /// each_pair(visit) calls visit(low, a, b) for each edge with two faces, whose lower vertex is `low`. The edges and
    /// `at`, the place of each vertex, must outlive this.
    template <class EachPair>
    Sheets(const MeshEdges& edges, const std::vector<Vertex>& at, EachPair&& each_pair)
        : edges_(edges), at_(at), sheets_(edges.face_count()), sides_(edges.face_count(), 0) {
        const auto are_coplanar = [&](uint32_t low, const EdgeUse& a, const EdgeUse& b) {
            return volume6_of(at[a.high], at[a.opposite], at[b.opposite], at[low]) == 0;
        };
        each_pair([&](uint32_t low, const EdgeUse& a, const EdgeUse& b) {
            if (are_coplanar(low, a, b))
                sheets_.merge(a.face, b.face);
        });
        each_pair([&](uint32_t low, const EdgeUse& a, const EdgeUse& b) {
            if (!are_coplanar(low, a, b)) {
                note_wall(a.face, at[b.opposite]);
                note_wall(b.face, at[a.opposite]);
            }
        });
    }

    StackRank rank_of(uint32_t face) {
        const uint32_t sheet = sheets_.find(face);
        return {(sides_[sheet] == kAbove) - (sides_[sheet] == kBelow), faces_up(sheet), sheet};
    }

private:
    enum : uint8_t { kBelow = 1, kAbove = 2 };

    /// Notes that the face beside `face` leads to `v`.
    void note_wall(uint32_t face, const Vertex& v) {
        const Corners c = edges_.corners(face);
        const bool in_front = volume6_of(at_[c[0]], at_[c[1]], at_[c[2]], v) < 0;
        sides_[sheets_.find(face)] |= in_front == faces_up(face) ? kAbove : kBelow;
    }
    bool faces_up(uint32_t face) const {
        const Corners c = edges_.corners(face);
        return points_up(normal_signs(at_[c[0]], at_[c[1]], at_[c[2]]));
    }

    const MeshEdges& edges_;
    const std::vector<Vertex>& at_;
    DisjointSets sheets_;        // the lowest face of a sheet tells which way it faces
    std::vector<uint8_t> sides_; // by sheet: where the faces beside it lead
};

} // namespace voxrt::voxelize
