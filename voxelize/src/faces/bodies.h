// Bodies: connected faces, where those that close by themselves are apart from others that share edges with them.
//
// Boxes that are glued together share edges, or pieces of them. Each closes over its other edges, which have two faces.
// So nobody has to ask for the order of the faces about the shared ones, which the rounding of a file decides where
// faces nearly lie upon one another; and boxes may cross.
#pragma once

#include "../work/disjoint_sets.h"
#include "mesh_edges.h"

namespace voxrt::voxelize {

class Bodies {
public:
    /// `whole`: the edges of the faces. `edges`: the same, or cut where other edges meet them (mesh/edge_cuts.h).
    Bodies(const MeshEdges& whole, const MeshEdges& edges);

    /// The lowest face of the body of a face.
    uint32_t of(uint32_t face) const { return bodies_[face]; }
    /// Whether the body of a face closes, as all do before note_closed().
    bool closes(uint32_t face) const { return !is_open_[of(face)]; }
    /// Notes which bodies close over `edges`. upwards(use): how often a face walks its edge from low to high.
    template <class Upwards> void note_closed(const MeshEdges& edges, Upwards&& upwards) {
        is_open_.assign(bodies_.size(), false);
        each_edge(edges, [&](uint32_t, std::span<const EdgeUse> uses) {
            int sum = 0;
            for (const EdgeUse& use : uses)
                sum += upwards(use);
            if (sum != 0)
                is_open_[of(uses[0].face)] = true;
        });
    }

    /// For each face the first one with the same corners.
    const std::vector<uint32_t>& first() const { return first_; }

    /// Calls visit(low, uses) for each edge of each body, as MeshEdges::each() does.
    template <class Visit> void each_edge(const MeshEdges& edges, Visit&& visit) const {
        std::vector<EdgeUse> sorted;
        edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
            const uint32_t body = of(uses[0].face);
            if (std::all_of(uses.begin(), uses.end(), [&](const EdgeUse& use) { return of(use.face) == body; })) {
                visit(low, uses);
                return;
            }
            sorted.assign(uses.begin(), uses.end());
            std::sort(sorted.begin(), sorted.end(), [&](const EdgeUse& a, const EdgeUse& b) {
                return of(a.face) != of(b.face) ? of(a.face) < of(b.face) : a.face < b.face;
            });
            for (size_t i = 0, end; i < sorted.size(); i = end) {
                for (end = i + 1; end < sorted.size() && of(sorted[end].face) == of(sorted[i].face);)
                    ++end;
                visit(low, std::span<const EdgeUse>(sorted.data() + i, end - i));
            }
        });
    }

private:
    static constexpr uint32_t kNone = UINT32_MAX;

    /// Whether a face is the first one with its corners, and of no body that was set apart.
    bool is_left(uint32_t face) const { return bodies_[face] == kNone && first_[face] == face; }
    /// Calls visit(uses, left) for each edge of faces that are left.
    template <class Visit> void each_edge_left(const MeshEdges& edges, Visit&& visit) const;
    /// Sets those of the faces left apart that close; returns how many they are.
    uint32_t set_apart(const MeshEdges& edges);
    /// Connects the faces left.
    void connect_rest(const MeshEdges& edges, DisjointSets& connected) const;

    std::vector<uint32_t> first_, bodies_;
    std::vector<bool> is_open_; // by body
};

/// Calls visit(first, again) for each face at an edge that has the corners of an earlier one. `sorted` is for reuse.
template <class Visit> void each_repeated(std::span<const EdgeUse> uses, std::vector<EdgeUse>& sorted, Visit&& visit) {
    if (uses.size() < 2 || (uses.size() == 2 && uses[0].opposite != uses[1].opposite))
        return;
    sorted.assign(uses.begin(), uses.end());
    std::sort(sorted.begin(), sorted.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return a.opposite != b.opposite ? a.opposite < b.opposite : a.face < b.face;
    });
    for (size_t i = 1, first = 0; i < sorted.size(); ++i)
        if (sorted[i].opposite == sorted[first].opposite)
            visit(sorted[first], sorted[i]);
        else
            first = i;
}

} // namespace voxrt::voxelize
