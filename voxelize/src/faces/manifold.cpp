#include "manifold.h"

#include "../work/interrupt.h"

#include <array>
#include <bit>
#include <numeric>
#include <span>

namespace voxrt::voxelize {
namespace {

constexpr uint32_t kNone = 0xFFFF'FFFF;

/// For each vertex the first one with the same key.
std::vector<uint32_t> first_of(const std::vector<uint64_t>& keys) {
    constexpr size_t kAhead = 16; // places are fetched ahead, since each is somewhere else in memory
    std::vector<uint32_t> table(std::bit_ceil(2 * keys.size() + 1), kNone), first(keys.size());
    for (size_t v = 0; v < keys.size(); ++v) {
        if (v + kAhead < keys.size())
            __builtin_prefetch(&table[keys[v + kAhead] & (table.size() - 1)], 1);
        size_t place = keys[v] & (table.size() - 1);
        while (table[place] != kNone && keys[table[place]] != keys[v])
            place = (place + 1) & (table.size() - 1);
        if (table[place] == kNone)
            table[place] = uint32_t(v);
        first[v] = table[place];
    }
    count_work(uint32_t(keys.size()));
    return first;
}

/// What a face has at a vertex: its next corner and the one after that.
struct Corner {
    uint32_t from, to;
};

/// Tells whether the faces at a vertex are one fan: from each, its last corner leads to the next one.
class Fans {
public:
    explicit Fans(size_t vertices) : steps_(vertices, {kNone, kNone}) {}

    /// `corners`: those of the faces at `vertex`, at least one.
    bool is_fan(uint32_t vertex, std::span<const Corner> corners) {
        for (const Corner& corner : corners) {
            if (steps_[corner.from].vertex == vertex)
                return false; // two faces leave by one edge
            steps_[corner.from] = {vertex, corner.to};
        }
        uint32_t at = corners[0].from;
        for (size_t length = 1; length <= corners.size(); ++length) {
            if (steps_[at].vertex != vertex)
                return false;
            at = steps_[at].to;
            if (at == corners[0].from)
                return length == corners.size();
        }
        return false;
    }

private:
    struct Step {
        uint32_t vertex; // about which it was taken last
        uint32_t to;
    };
    std::vector<Step> steps_; // by the vertex that they begin at
};

} // namespace

bool is_manifold(const MeshView& mesh, const std::vector<uint64_t>& vertex_keys) {
    const std::vector<uint32_t> first = first_of(vertex_keys);
    const auto each_face = [&](auto&& visit) {
        for (size_t t = 0; t < mesh.triangle_count(); ++t) {
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const std::array<uint32_t, 3> c{first[size_t(corner[0])], first[size_t(corner[1])],
                                            first[size_t(corner[2])]};
            if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0])
                visit(c);
        }
        count_work(2 * uint32_t(mesh.triangle_count()));
    };
    std::vector<size_t> ends(first.size() + 1, 0); // of the corners of each vertex; starts, once they are filled in
    each_face([&](const std::array<uint32_t, 3>& c) {
        for (const uint32_t v : c)
            ++ends[v];
    });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<Corner> corners(ends.back());
    each_face([&](const std::array<uint32_t, 3>& c) {
        for (size_t i = 0; i < 3; ++i)
            corners[--ends[c[i]]] = {c[(i + 1) % 3], c[(i + 2) % 3]};
    });
    Fans fans(first.size());
    for (size_t v = 0; v < first.size(); ++v)
        if (const size_t count = ends[v + 1] - ends[v];
            count > 0 && !fans.is_fan(uint32_t(v), std::span(corners).subspan(ends[v], count)))
            return false;
    return true;
}

} // namespace voxrt::voxelize
