// The bricks and octants of tiles, laid out one after another in Morton order.
#pragma once

#include "../grid/push_octant.h"
#include "../work/workers.h"
#include "tile_order.h"

#include <algorithm>
#include <vector>

namespace voxrt::voxelize {

/// Appends the octants of all runs. Those of a cube are joined already.
inline void gather_octants(const std::vector<TileResult>& tiles, const std::vector<CubeRun>& runs, SparseVoxels& out) {
    size_t most = 0;
    for (const CubeRun& run : runs)
        most += run.octants_to - run.octants_from;
    out.octant_codes.reserve(most);
    out.octant_levels.reserve(most);
    out.octant_materials.reserve(most);
    const auto append = [](auto& to, const auto& from, const CubeRun& run) {
        to.insert(to.end(), from.begin() + run.octants_from, from.begin() + run.octants_to);
    };
    for (const CubeRun& run : runs) {
        const TileResult& tile = tiles[run.tile];
        const uint32_t i = run.octants_from;
        if (i + 1 == run.octants_to && tile.octant_levels[i] == kCubeLevel) {
            push_octant(out, tile.octant_codes[i], kCubeLevel, tile.octant_materials[i]);
        } else {
            append(out.octant_codes, tile.octant_codes, run);
            append(out.octant_levels, tile.octant_levels, run);
            append(out.octant_materials, tile.octant_materials, run);
        }
    }
}

/// Lays the bricks and octants of all tiles out one after another.
inline void gather(const std::vector<TileResult>& tiles, SparseVoxels& out, const Workers& workers) {
    std::vector<CubeRun> runs;
    for (const TileResult& tile : tiles)
        runs.insert(runs.end(), tile.runs.begin(), tile.runs.end());
    std::sort(runs.begin(), runs.end(), [](const CubeRun& a, const CubeRun& b) { return a.code < b.code; });
    gather_octants(tiles, runs, out);

    // Rows keep the order of their bricks.
    std::vector<size_t> brick_starts, row_starts;
    size_t bricks = 0, rows = 0;
    for (const CubeRun& run : runs) {
        brick_starts.push_back(bricks);
        row_starts.push_back(rows);
        bricks += run.bricks_to - run.bricks_from;
        rows += run.rows;
    }
    out.brick_codes.resize(bricks);
    out.brick_masks.resize(bricks);
    out.brick_materials.resize(bricks);
    out.brick_rows.resize(bricks);
    out.cells.resize(rows);
    constexpr size_t kRuns = 64; // per job
    workers.run((runs.size() + kRuns - 1) / kRuns, [&](size_t job, int) {
        for (size_t r = job * kRuns; r < std::min(runs.size(), (job + 1) * kRuns); ++r) {
            const CubeRun& run = runs[r];
            const TileResult& tile = tiles[run.tile];
            size_t to = brick_starts[r], row = row_starts[r];
            for (uint32_t i = run.bricks_from; i < run.bricks_to; ++i, ++to) {
                out.brick_codes[to] = tile.brick_codes[i];
                out.brick_masks[to] = tile.brick_masks[i];
                out.brick_materials[to] = tile.brick_materials[i];
                out.brick_rows[to] = -1;
                if (tile.brick_rows[i] >= 0) {
                    out.brick_rows[to] = int32_t(row);
                    out.cells[row++] = tile.cells[tile.brick_rows[i]];
                }
            }
        }
    });
}

} // namespace voxrt::voxelize
