#include "manifold.h"

#include "../work/interrupt.h"

#include <algorithm>
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

/// Whether the faces at a vertex are one fan: from each, its last corner leads to the next one.
bool is_fan(std::span<Corner> corners) {
    constexpr size_t kFew = 16; // are searched one after another
    const auto by_from = [](const Corner& a, const Corner& b) { return a.from < b.from; };
    const bool is_sorted = corners.size() > kFew;
    if (is_sorted) {
        count_work(uint32_t(corners.size()));
        std::sort(corners.begin(), corners.end(), by_from);
    }
    size_t length = 0;
    uint32_t at = corners[0].from;
    do {
        const auto next =
            is_sorted ? std::lower_bound(corners.begin(), corners.end(), Corner{at, 0}, by_from)
                      : std::find_if(corners.begin(), corners.end(), [at](const Corner& c) { return c.from == at; });
        if (next == corners.end() || next->from != at || ++length > corners.size())
            return false;
        at = next->to;
    } while (at != corners[0].from);
    return length == corners.size();
}

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
    std::vector<size_t> starts(first.size() + 1, 0);
    each_face([&](const std::array<uint32_t, 3>& c) {
        for (const uint32_t v : c)
            ++starts[v + 1];
    });
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<Corner> corners(starts.back());
    std::vector<size_t> next(starts.begin(), starts.end() - 1);
    each_face([&](const std::array<uint32_t, 3>& c) {
        for (size_t i = 0; i < 3; ++i)
            corners[next[c[i]]++] = {c[(i + 1) % 3], c[(i + 2) % 3]};
    });
    for (size_t v = 0; v < first.size(); ++v)
        if (const size_t count = starts[v + 1] - starts[v];
            count > 0 && !is_fan(std::span(corners).subspan(starts[v], count)))
            return false;
    return true;
}

} // namespace voxrt::voxelize
