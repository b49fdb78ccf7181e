#include "edge_cuts.h"

#include "../faces/exact_predicates.h"
#include "triangle_bvh.h"

#include <cmath>

namespace voxrt::voxelize {
namespace {

constexpr double kRounding = 2;   // units of the lattice
constexpr double kExactly = 0.01; // likewise: rounding in here alone

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

/// Whether the faces at an edge do not pair: more walk it one way than the other. Those that lie upon one another count
/// once, and of many the first.
bool is_unpaired(uint32_t low, std::span<const EdgeUse> uses, const std::vector<Vertex>& at) {
    int surplus = 0;
    uses = uses.first(std::min(uses.size(), kMostFaces));
    for (size_t i = 0; i < uses.size(); ++i)
        if (std::none_of(uses.begin(), uses.begin() + ptrdiff_t(i), [&](const EdgeUse& other) {
                return overlap(at[low], at[uses[0].high], at[other.opposite], at[uses[i].opposite]);
            }))
            surplus += uses[i].is_upwards ? 1 : -1;
    return surplus != 0;
}

/// Some vertices, to be found on edges.
class VerticesOnEdges {
public:
    /// `room`: how far from a line a vertex may lie that is on it.
    VerticesOnEdges(const std::vector<Vertex>& vertices, const std::vector<bool>& chosen, double room)
        : vertices_(vertices), room_(room), bvh_(boxes_of(vertices, chosen)) {}

    /// Those between the ends of an edge, from `low` to `high`.
    std::vector<uint32_t> on(uint32_t low, uint32_t high) {
        const Segment segment(vertices_[low], vertices_[high], room_);
        found_.clear();
        bvh_.find_where([&](const TriangleBox& box) { return segment.meets(box); },
                        [&](uint32_t v) {
                            if (const double place = segment.place_of(vertices_[v]); place > 0)
                                found_.push_back({place, v});
                        });
        std::sort(found_.begin(), found_.end());
        std::vector<uint32_t> on_edge;
        for (const auto& [place, v] : found_)
            on_edge.push_back(v);
        return on_edge;
    }

private:
    static std::vector<std::pair<TriangleBox, uint32_t>> boxes_of(const std::vector<Vertex>& vertices,
                                                                  const std::vector<bool>& chosen) {
        std::vector<std::pair<TriangleBox, uint32_t>> boxes;
        for (uint32_t v = 0; v < vertices.size(); ++v)
            if (chosen[v]) {
                TriangleBox box;
                box.add(vertices[v]);
                boxes.push_back({box, v});
            }
        return boxes;
    }

    const std::vector<Vertex>& vertices_;
    double room_;
    TriangleBvh bvh_;
    std::vector<std::pair<double, uint32_t>> found_;
};

void add_cut(std::vector<EdgeCut>& cuts, uint32_t low, std::span<const EdgeUse> uses, std::vector<uint32_t> at) {
    if (!at.empty())
        cuts.push_back({low, uses[0].high, std::move(at)});
}

struct Balance {
    bool is_balanced = true; // each edge is walked as often one way as the other, edges of one face left out
    size_t odd = 0;          // edges of an odd number of faces
};

Balance balance_of(const MeshEdges& edges) {
    Balance found;
    edges.each([&](uint32_t, std::span<const EdgeUse> uses) {
        int sum = 0;
        for (const EdgeUse& use : uses)
            sum += use.is_upwards ? 1 : -1;
        found.is_balanced = found.is_balanced && (sum == 0 || uses.size() == 1);
        found.odd += uses.size() % 2;
    });
    return found;
}

} // namespace

std::vector<EdgeCut> find_cuts(const MeshEdges& edges, const std::vector<Vertex>& vertices, double rounding) {
    std::vector<bool> is_end(vertices.size(), false), is_used(vertices.size(), false);
    TriangleBox whole;
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        for (const uint32_t v : {low, uses[0].high}) {
            whole.add(vertices[v]);
            is_used[v] = true;
        }
        if (is_unpaired(low, uses, vertices))
            is_end[low] = is_end[uses[0].high] = true;
    });
    double size = 0;
    for (int i = 0; i < 3; ++i)
        size = std::max(size, double(whole.high[i]) - whole.low[i]);
    const double room = kRounding + size * rounding;
    VerticesOnEdges ends(vertices, is_end, room);
    std::vector<EdgeCut> cuts;
    edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
        if (is_unpaired(low, uses, vertices))
            add_cut(cuts, low, uses, ends.on(low, uses[0].high));
    });
    if (cuts.empty())
        return cuts;
    // Where parts meet, faces of two may pair along a seam by chance.
    const auto cut_all = [&](double near) {
        VerticesOnEdges all(vertices, is_used, near);
        auto cut = cuts.begin();
        std::vector<EdgeCut> more;
        edges.each([&](uint32_t low, std::span<const EdgeUse> uses) {
            std::vector<uint32_t> at = all.on(low, uses[0].high);
            for (const EdgeUse& use : uses)
                std::erase(at, use.opposite);
            if (cut != cuts.end() && cut->low == low && cut->high == uses[0].high) {
                if (cut->at.size() > at.size())
                    at = cut->at;
                ++cut;
            }
            add_cut(more, low, uses, std::move(at));
        });
        return more;
    };
    std::vector<EdgeCut> near = cut_all(room);
    const Balance of_near = balance_of(MeshEdges(edges, near));
    // What closes with others' ends on its edges is closed, though some faces are turned.
    if (of_near.is_balanced || of_near.odd == 0)
        return near;
    std::vector<EdgeCut> exact = cut_all(kExactly);
    if (balance_of(MeshEdges(edges, exact)).is_balanced)
        return exact;
    if (balance_of(edges).is_balanced)
        return {};
    return of_near.odd <= balance_of(MeshEdges(edges, cuts)).odd ? near : cuts;
}

} // namespace voxrt::voxelize
