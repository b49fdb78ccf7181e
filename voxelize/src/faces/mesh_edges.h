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
#include <tuple>
#include <vector>

namespace voxrt::voxelize {

using Corners = std::array<uint32_t, 3>;

/// A face at an edge between vertices low < high.
struct EdgeUse {
    uint32_t high;
    uint32_t face;
    uint32_t opposite; // the face's third corner
    bool is_upwards;   // the face walks from low to high
};

/// For each vertex the first one at the same position.
template <class Position> std::vector<uint32_t> weld(const std::vector<Position>& positions) {
    std::vector<uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    WorkCounter& work = WorkCounter::current();
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        work.count(1);
        const Position &p = positions[a], &q = positions[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

class MeshEdges {
public:
    /// `welded`: for each vertex the one that stands for its position. The mesh must outlive this.
    MeshEdges(const MeshView& mesh, std::vector<uint32_t> welded);

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
    const MeshView& mesh_;
    std::vector<uint32_t> welded_;
    std::vector<size_t> starts_; // of uses_, by low vertex
    std::vector<EdgeUse> uses_;
};

} // namespace voxrt::voxelize
