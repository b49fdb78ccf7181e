// The areas of surface in voxels of several tiles.
#pragma once

#include "../work/workers.h"
#include "tile_areas.h"

#include <numeric>

namespace voxrt::voxelize {

/// The areas of surface in voxels, by Morton code, in their order.
inline SurfaceAreas find_areas(const TileAreas& tiles, int tiles_per_side, std::span<const uint64_t> codes,
                               const Workers& workers) {
    const auto tile_of = [tiles_per_side](uint64_t code) {
        return gather_bits(code >> 1) / kTileSide * uint32_t(tiles_per_side) + gather_bits(code) / kTileSide;
    };
    std::vector<uint32_t> order(codes.size()); // by tile
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return tile_of(codes[a]) < tile_of(codes[b]); });
    std::vector<uint64_t> sorted(codes.size());
    std::vector<size_t> starts; // of tiles
    for (size_t i = 0; i < codes.size(); ++i) {
        sorted[i] = codes[order[i]];
        if (i == 0 || tile_of(sorted[i]) != tile_of(sorted[i - 1]))
            starts.push_back(i);
    }
    starts.push_back(codes.size());
    std::vector<SurfaceAreas> found(starts.size() - 1);
    std::vector<std::vector<Vertex>> vertices(size_t(workers.threads()));
    workers.run(found.size(), [&](size_t job, int thread) {
        const std::span<const uint64_t> own(sorted.data() + starts[job], starts[job + 1] - starts[job]);
        tiles.find_areas(tile_of(own[0]), own, vertices[size_t(thread)], found[job]);
    });
    std::vector<std::span<const MaterialArea>> rows(codes.size());
    for (size_t job = 0; job < found.size(); ++job)
        for (size_t i = starts[job]; i < starts[job + 1]; ++i)
            rows[order[i]] = found[job].at(i - starts[job]);
    SurfaceAreas all;
    for (const auto& row : rows) {
        all.areas.insert(all.areas.end(), row.begin(), row.end());
        all.end_voxel();
    }
    return all;
}

} // namespace voxrt::voxelize
