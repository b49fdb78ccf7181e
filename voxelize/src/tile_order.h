// A tile's voxels in Morton order: bricks where the content is mixed, octants where it is uniform.
//
// The order is made cube by cube (64 voxels a side, 512 brick places); a grid's cubes are put in order afterwards.
#pragma once

#include "tile_voxels.h"

namespace voxrt {

/// A run of one tile's bricks and octants that make up a cube.
struct CubeRun {
    uint64_t code; // Morton code of the cube's corner / 64
    uint32_t tile;
    uint32_t bricks_from, bricks_to, octants_from, octants_to;
};

/// One tile's part of the result.
struct TileResult {
    std::vector<uint64_t> brick_codes;
    std::vector<Slices> brick_masks; // Morton order
    std::vector<uint8_t> brick_materials;
    std::vector<int32_t> brick_rows; // of this tile's cells
    std::vector<Cells> cells;        // Morton order
    std::vector<uint64_t> octant_codes;
    std::vector<uint8_t> octant_levels, octant_materials;
    std::vector<CubeRun> runs;
};

class TileOrder {
public:
    TileOrder() {
        for (uint32_t i = 0; i < kBrickVoxels; ++i) {
            x_[i] = uint8_t(compact(i));
            y_[i] = uint8_t(compact(i >> 1));
            z_[i] = uint8_t(compact(i >> 2));
        }
    }

    /// Orders the content of a tile (number `index`, at (tile_x, tile_y) in tiles).
    void order(const TileVoxels& tile, uint32_t index, int tile_x, int tile_y, TileResult& out) {
        for (int cube = 0; cube * kTileBricks < tile.height(); ++cube) {
            CubeRun run{morton(tile_x, tile_y, cube),      index, uint32_t(out.brick_codes.size()), 0,
                        uint32_t(out.octant_codes.size()), 0};
            order_cube(tile, cube, run.code, out);
            run.bricks_to = uint32_t(out.brick_codes.size());
            run.octants_to = uint32_t(out.octant_codes.size());
            if (run.bricks_to > run.bricks_from || run.octants_to > run.octants_from)
                out.runs.push_back(run);
        }
    }

private:
    static constexpr uint32_t compact(uint32_t i) { return (i & 1) | (i >> 2 & 2) | (i >> 4 & 4); }

    void order_cube(const TileVoxels& tile, int cube, uint64_t code, TileResult& out) {
        // full_[l]: for each octant of 8 << l voxels the material that fills it, else 0
        bool any = false;
        for (int i = 0; i < kBrickVoxels; ++i) {
            const int column = y_[i] * kTileBricks + x_[i], k = cube * kTileBricks + z_[i];
            const bool there = k < tile.height() && tile.column_used(column);
            bricks_[i] = there ? tile.brick(column, k) : nullptr;
            full_[0][i] = there ? tile.full(column, k) : 0;
            any = any || bricks_[i] != nullptr || full_[0][i] != 0;
        }
        if (!any)
            return;
        for (int level = 1; level <= 3; ++level)
            for (int i = 0; i < kBrickVoxels >> 3 * level; ++i) {
                const uint8_t* children = &full_[level - 1][8 * i];
                bool equal = true;
                for (int c = 1; c < 8; ++c)
                    equal = equal && children[c] == children[0];
                full_[level][i] = equal ? children[0] : 0;
            }
        emit(tile, 3, 0, code, out);
    }

    void emit(const TileVoxels& tile, int level, int i, uint64_t code, TileResult& out) {
        if (full_[level][i] != 0) {
            out.octant_codes.push_back(code);
            out.octant_levels.push_back(uint8_t(level + kBrickBits));
            out.octant_materials.push_back(full_[level][i]);
        } else if (level > 0) {
            for (int c = 0; c < 8; ++c)
                emit(tile, level - 1, 8 * i + c, code << 3 | uint64_t(c), out);
        } else if (bricks_[i] != nullptr) {
            out.brick_codes.push_back(code);
            out.brick_masks.push_back(morton_order(bricks_[i]->mask));
            emit_materials(tile, *bricks_[i], out);
        }
    }

    void emit_materials(const TileVoxels& tile, const OwnedBrick& brick, TileResult& out) {
        if (brick.cells == kNone) {
            out.brick_materials.push_back(brick.material);
            out.brick_rows.push_back(-1);
            return;
        }
        const Cells& cells = tile.cells(brick.cells);
        uint8_t only = 0;
        bool mixed = false;
        for (uint8_t material : cells) {
            mixed = mixed || (only != 0 && material != 0 && material != only);
            only = material != 0 ? material : only;
        }
        if (!mixed) {
            out.brick_materials.push_back(only);
            out.brick_rows.push_back(-1);
            return;
        }
        out.brick_materials.push_back(0);
        out.brick_rows.push_back(int32_t(out.cells.size()));
        Cells& row = out.cells.emplace_back();
        for (int i = 0; i < kBrickVoxels; ++i)
            row[i] = cells[x_[i] + 8 * y_[i] + 64 * z_[i]];
    }

    uint8_t x_[kBrickVoxels], y_[kBrickVoxels], z_[kBrickVoxels]; // place of each Morton index
    const OwnedBrick* bricks_[kBrickVoxels];
    uint8_t full_[4][kBrickVoxels];
};

} // namespace voxrt
