// The edges of a mesh, each with the faces that use it. Vertices at one position count as one.
//
// Faces with two corners at one position have no area and no edges here. A counting sort by vertex: linear in the
// faces.
#pragma once

#include "../scene/parts.h"
#include "../work/interrupt.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

namespace voxrt::voxelize {

using Corners = std::array<uint32_t, 3>;

/// A face at an edge between vertices low < high.
struct EdgeUse {
    uint32_t high;
    uint32_t opposite;       // the face's third corner
    uint32_t face : 31;      // fewer than 2^31, as their vertices
    uint32_t is_upwards : 1; // the face walks from low to high
};

/// For each vertex the first one with the same key (vertex_key() or point_key(), closed_surface.h). Keys of different
/// positions are equal about once in 2^64. n log n.
std::vector<uint32_t> weld(const std::vector<uint64_t>& keys);

/// An edge between vertices low < high, and the vertices on it, on the way from low to high.
struct EdgeCut {
    uint32_t low, high;
    std::vector<uint32_t> at;
};

class MeshEdges {
public:
    /// `welded`: for each vertex the one that stands for its position. The mesh must outlive this.
    MeshEdges(const MeshView& mesh, std::vector<uint32_t> welded);
    /// The same faces, with some edges cut into several. `cuts` are in the order of each().
    MeshEdges(const MeshEdges& whole, const std::vector<EdgeCut>& cuts);

    size_t face_count() const { return mesh_.triangle_count(); }
    size_t vertex_count() const { return welded_.size(); }
    /// The corners of a face, welded.
    Corners corners(size_t face) const {
        const int32_t* corner = mesh_.triangles.data() + 3 * face;
        return {welded_[corner[0]], welded_[corner[1]], welded_[corner[2]]};
    }
    /// Calls visit(low, uses) for each edge; `uses` are ordered by face.
    template <class Visit> void each(Visit&& visit) const {
        for (uint32_t low = 0; low + 1 < starts_.size(); ++low)
            for (size_t i = starts_[low], end; i < starts_[low + 1]; i = end) {
                for (end = i + 1; end < starts_[low + 1] && uses_[end].high == uses_[i].high;)
                    ++end;
                count_work(uint32_t(end - i));
                visit(low, std::span<const EdgeUse>(uses_.data() + i, end - i));
            }
    }

private:
    /// Sorts uses by a counting sort. each_use(visit) calls visit(low, use) for each, twice in the same order.
    template <class EachUse> void sort_uses(EachUse&& each_use);

    const MeshView& mesh_;
    std::vector<uint32_t> welded_;
    std::vector<size_t> starts_; // of uses_, by low vertex
    std::vector<EdgeUse> uses_;
};

} // namespace voxrt::voxelize
