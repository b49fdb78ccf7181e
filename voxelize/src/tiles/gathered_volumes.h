// The volumes of tiles, laid out by object.
#pragma once

#include "../work/workers.h"
#include "tile_order.h"
#include "voxelizer.h"

#include <array>
#include <bit>
#include <numeric>
#include <vector>

namespace voxrt::voxelize {

/// Writes the values of a tile. `starts`: by brick, the place of its first value among those of its object; `begins`:
/// by object, the place of its first value.
inline void write_volumes(const TileVolumes& tile, const std::vector<size_t>& starts, const std::vector<size_t>& begins,
                          ObjectVolumes& out) {
    const double* value = tile.values.data();
    for (size_t b = 0; b < tile.bricks.size(); ++b) {
        const VolumeBrick& brick = tile.bricks[b];
        if (!out.known[brick.object]) {
            value += count(brick.voxels);
            continue;
        }
        const auto corner = [&brick](int axis) { return int32_t(gather_bits(brick.code >> axis)) * kBrickSide; };
        const std::array<int32_t, 3> at{corner(0), corner(1), corner(2)};
        size_t to = begins[brick.object] + starts[b];
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = brick.voxels[size_t(z)]; left != 0; left &= left - 1, ++to) {
                const int bit = std::countr_zero(left);
                out.objects[to] = brick.object;
                out.voxels[to] = {at[0] + column_x(bit), at[1] + column_y(bit), at[2] + z};
                out.volumes[to] = *value++;
            }
    }
}

/// Lays the volumes of all tiles out by object, and empties the tiles' own. Returns how many voxels each object has;
/// those whose volumes are not known have none.
inline std::vector<size_t> gather_volumes(std::vector<TileResult>& tiles, ObjectVolumes& out, const Workers& workers) {
    std::vector<size_t> counts(out.known.size()), begins(out.known.size());
    std::vector<std::vector<size_t>> starts(tiles.size());
    for (size_t t = 0; t < tiles.size(); ++t)
        for (const VolumeBrick& brick : tiles[t].volumes.bricks) {
            starts[t].push_back(counts[brick.object]);
            counts[brick.object] += out.known[brick.object] ? size_t(count(brick.voxels)) : 0;
        }
    std::exclusive_scan(counts.begin(), counts.end(), begins.begin(), size_t{0});
    const size_t all = std::reduce(counts.begin(), counts.end());
    out.objects.resize(all);
    out.voxels.resize(all);
    out.volumes.resize(all);
    workers.run(tiles.size(), [&](size_t t, int) {
        write_volumes(tiles[t].volumes, starts[t], begins, out);
        tiles[t].volumes = {};
    });
    return counts;
}

} // namespace voxrt::voxelize
