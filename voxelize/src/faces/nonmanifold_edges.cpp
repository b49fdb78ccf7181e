#include "nonmanifold_edges.h"

#include "../work/interrupt.h"
#include "closed_surface.h"

#include <bit>

namespace voxrt::voxelize {

bool has_nonmanifold_edges(const MeshView& mesh, const std::vector<uint64_t>& vertex_keys) {
    constexpr size_t kBatch = 64; // triangles; places are fetched ahead, since each is somewhere else in memory
    // By hash of an edge, then the next place. Of the two ways to walk an edge, one alone is looked at.
    std::vector<uint32_t> seen(std::bit_ceil(2 * mesh.triangle_count() + 1), 0);
    uint64_t hashes[3 * kBatch];
    for (size_t from = 0; from < mesh.triangle_count(); from += kBatch) {
        const size_t to = std::min(from + kBatch, mesh.triangle_count());
        count_work(uint32_t(to - from));
        size_t count = 0;
        for (size_t t = from; t < to; ++t) {
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const uint64_t keys[3] = {vertex_keys[size_t(corner[0])], vertex_keys[size_t(corner[1])],
                                      vertex_keys[size_t(corner[2])]};
            if (keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0])
                continue;
            for (int i = 0; i < 3; ++i) {
                const uint64_t a = keys[i], b = keys[i == 2 ? 0 : i + 1];
                hashes[count] = mix_bits(a + std::rotl(b, 23));
                __builtin_prefetch(&seen[hashes[count] & (seen.size() - 1)], 1);
                count += a < b;
            }
        }
        for (size_t i = 0; i < count; ++i) {
            const uint32_t print = uint32_t(hashes[i] >> 32) | 1;
            size_t place = hashes[i] & (seen.size() - 1);
            for (; seen[place] != 0; place = (place + 1) & (seen.size() - 1))
                if (seen[place] == print)
                    return true;
            seen[place] = print;
        }
    }
    return false;
}

} // namespace voxrt::voxelize
