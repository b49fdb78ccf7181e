#include "cut_edges.h"

#include "../faces/exact_predicates.h"
#include "triangle_bvh.h"

#include <cmath>

namespace voxrt::voxelize {
namespace {

constexpr double kRounding = 2;                     // units of the lattice
constexpr double kRoundingOfFile = 1.0 / (1 << 23); // of the size of the mesh, where a file has float32

constexpr size_t kMostFaces = 64; // at an edge

using Vector = std::array<double, 3>;

Vector between(const Vertex& from, const Vertex& to) {
    return {double(to.x) - from.x, double(to.y) - from.y, double(to.z) - from.z};
}
double dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

/// The part of a line between two vertices, and what is near it.
class Segment {
public:
    Segment(const Vertex& from, const Vertex& to, double room)
        : from_(from), way_(between(from, to)), length_(length(way_)), room_(room) {}

    bool meets(const TriangleBox& box) const {
        const double start[3] = {double(from_.x), double(from_.y), double(from_.z)};
        double first = 0, last = 1;
        for (size_t i = 0; i < 3; ++i) {
            const double low = box.low[i] - start[i] - room_, high = box.high[i] - start[i] + room_;
            if (way_[i] == 0) {
                if (low > 0 || high < 0)
                    return false;
                continue;
            }
            const double one = low / way_[i], other = high / way_[i];
            first = std::max(first, std::min(one, other));
            last = std::min(last, std::max(one, other));
        }
        return first <= last;
    }

    /// How far along a vertex lies that is on the segment, away from its ends; 0 for others.
    double place_of(const Vertex& v) const {
        const Vector to = between(from_, v);
        const double along = dot(to, way_) / length_;
        const Vector off{to[0] - way_[0] * along / length_, to[1] - way_[1] * along / length_,
                         to[2] - way_[2] * along / length_};
        return along > room_ && along < length_ - room_ && length(off) <= room_ ? along : 0;
    }

private:
    Vertex from_;
    Vector way_;
    double length_, room_;
};

/// Whether two faces at an edge lie upon one another there.
bool overlap(const Vertex& u, const Vertex& v, const Vertex& a, const Vertex& b) {
    if (volume6_of(u, v, a, b) != 0)
        return false;
    const Vector way = between(u, v), p = between(u, a), q = between(u, b);
    const double square = dot(way, way), along = dot(p, way) * dot(q, way) / square;
    return dot(p, q) > along; // on one side of the edge
}

/// Whether the faces at an edge do not pair: more walk it one way than the other. Faces that lie upon one another may
/// be two sides of one, or of two parts: they are to pair whether they count once or each. Of many the first count.
bool is_unpaired(uint32_t low, std::span<const EdgeUse> uses, const std::vector<Vertex>& at) {
    int surplus = 0, once = 0;
    uses = uses.first(std::min(uses.size(), kMostFaces));
    for (size_t i = 0; i < uses.size(); ++i) {
        const int way = uses[i].is_upwards ? 1 : -1;
        surplus += way;
        if (std::none_of(uses.begin(), uses.begin() + ptrdiff_t(i), [&](const EdgeUse& other) {
                return overlap(at[low], at[uses[0].high], at[other.opposite], at[uses[i].opposite]);
            }))
            once += way;
    }
    return surplus != 0 || once != 0;
}

} // namespace

std::optional<MeshEdges> cut_edges(const MeshEdges& edges, const std::vector<Vertex>& vertices) {
    std::vector<bool> is_end(vertices.size(), false);
    TriangleBox whole;
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        whole.add(vertices[low]);
        whole.add(vertices[uses[0].high]);
        if (is_unpaired(low, uses, vertices))
            is_end[low] = is_end[uses[0].high] = true;
    });
    std::vector<std::pair<TriangleBox, uint32_t>> ends;
    for (uint32_t v = 0; v < vertices.size(); ++v)
        if (is_end[v]) {
            TriangleBox box;
            box.add(vertices[v]);
            ends.push_back({box, v});
        }
    if (ends.empty())
        return std::nullopt;
    double size = 0;
    for (int i = 0; i < 3; ++i)
        size = std::max(size, double(whole.high[i]) - whole.low[i]);
    const TriangleBvh bvh(std::move(ends));
    std::vector<EdgeCut> cuts;
    std::vector<std::pair<double, uint32_t>> on_edge;
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        if (!is_unpaired(low, uses, vertices))
            return;
        const uint32_t high = uses[0].high;
        const Segment segment(vertices[low], vertices[high], kRounding + size * kRoundingOfFile);
        on_edge.clear();
        bvh.find_where([&](const TriangleBox& box) { return segment.meets(box); },
                       [&](uint32_t v) {
                           if (const double place = segment.place_of(vertices[v]); place > 0)
                               on_edge.push_back({place, v});
                       });
        if (on_edge.empty())
            return;
        std::sort(on_edge.begin(), on_edge.end());
        EdgeCut& cut = cuts.emplace_back(EdgeCut{low, high, {}});
        for (const auto& [place, v] : on_edge)
            cut.at.push_back(v);
    });
    if (cuts.empty())
        return std::nullopt;
    return MeshEdges(edges, cuts);
}

} // namespace voxrt::voxelize
