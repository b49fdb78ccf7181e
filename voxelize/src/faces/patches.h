// Patches: faces joined over edges of two faces each. One that closes by itself has a volume, so that it is known
// whether it faces outwards.
#pragma once

#include "../work/disjoint_sets.h"
#include "exact_predicates.h"
#include "mesh_edges.h"

namespace voxrt::voxelize {

class Patches {
public:
    /// each_edge(visit) calls visit(low, uses) for each edge, whose lower vertex is `low`; each_face(visit) calls
    /// visit(face). `at`: the place of each vertex.
    template <class EachEdge, class EachFace>
    Patches(const MeshEdges& edges, const std::vector<Vertex>& at, EachEdge&& each_edge, EachFace&& each_face)
        : patches_(edges.face_count()), volumes_(edges.face_count(), 0), is_open_(edges.face_count(), false) {
        each_edge([&](uint32_t, const std::vector<EdgeUse>& uses) {
            if (uses.size() == 2)
                patches_.merge(uses[0].face, uses[1].face);
        });
        each_edge([&](uint32_t, const std::vector<EdgeUse>& uses) {
            for (const EdgeUse& use : uses) {
                int sum = 0;
                for (const EdgeUse& other : uses)
                    if (patches_.find(other.face) == patches_.find(use.face))
                        sum += other.is_upwards ? 1 : -1;
                if (sum != 0)
                    is_open_[patches_.find(use.face)] = true;
            }
        });
        each_face([&](uint32_t face) {
            const uint32_t patch = patches_.find(face);
            const Corners c = edges.corners(face);
            volumes_[patch] += volume6_of(at[c[0]], at[c[1]], at[c[2]], at[edges.corners(patch)[0]]);
        });
    }

    /// Whether the patch of a face faces outwards (1) or inwards (-1); 0 where that is not known.
    int facing_of(uint32_t face) {
        const uint32_t patch = patches_.find(face);
        return is_open_[patch] ? 0 : sign_of(volumes_[patch]);
    }

private:
    DisjointSets patches_; // by their lowest face
    std::vector<int128> volumes_;
    std::vector<bool> is_open_;
};

} // namespace voxrt::voxelize
