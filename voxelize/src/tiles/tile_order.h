// A tile's voxels in Morton order: bricks where the content is mixed, octants where it is uniform.
//
// A tile is sorted cube by cube (64 voxels per side, 512 slots of bricks); voxelize() then sorts the cubes of all
// tiles.
#pragma once

#include "rule_tile.h"
#include "tile_voxels.h"

namespace voxrt::voxelize {

inline constexpr uint8_t kCubeLevel = 6; // log2 of a cube's side in voxels

/// A run of one tile's bricks and octants that make up a cube.
struct CubeRun {
    uint64_t code; // Morton code of the cube's corner / 64
    uint32_t tile;
    uint32_t bricks_from, bricks_to, octants_from, octants_to;
    uint32_t rows; // of cells, which its bricks have
};

/// The content of one tile.
struct TileResult {
    std::vector<uint64_t> brick_codes;
    std::vector<Slices> brick_masks; // Morton order
    std::vector<uint8_t> brick_materials;
    std::vector<int32_t> brick_rows; // of this tile's cells
    std::vector<Cells> cells;        // Morton order
    std::vector<uint64_t> octant_codes;
    std::vector<uint8_t> octant_levels, octant_materials;
    std::vector<CubeRun> runs;
    std::vector<RuleBrick> rule_bricks; // these three for rules other than `touch`
    std::vector<OwnedSurface> owned;
    std::vector<MixedSurface> mixed;
    TileVolumes volumes; // where these alone are wanted
};

class TileSorter {
public:
    /// Appends the content of a tile (number `index`, at (tile_x, tile_y) in tiles) to `out`.
    void sort(const TileVoxels& tile, uint32_t index, int tile_x, int tile_y, TileResult& out) {
        const size_t bricks = out.brick_codes.size() + tile.bricks();
        out.brick_codes.reserve(bricks);
        out.brick_masks.reserve(bricks);
        out.brick_materials.reserve(bricks);
        out.brick_rows.reserve(bricks);
        for (int cube = 0; cube * kTileBricks < tile.height(); ++cube) {
            CubeRun run{morton(tile_x, tile_y, cube),      index, uint32_t(out.brick_codes.size()), 0,
                        uint32_t(out.octant_codes.size()), 0,     uint32_t(out.cells.size())};
            if (!read_cube(tile, cube * kTileBricks))
                continue;
            emit(tile, 3, 0, run.code, out);
            run.bricks_to = uint32_t(out.brick_codes.size());
            run.octants_to = uint32_t(out.octant_codes.size());
            run.rows = uint32_t(out.cells.size()) - run.rows;
            out.runs.push_back(run);
        }
    }

private:
    /// Reads the slots of a cube in Morton order; false where it is empty.
    bool read_cube(const TileVoxels& tile, int k) {
        const int levels = std::min(kTileBricks, tile.height() - k);
        if (levels == kTileBricks && read_uniform_cube(tile, k))
            return slots_[3][0] != 0;
        uint32_t any = 0;
        slots_[0].fill(0);
        for (int column = 0; column < kTileColumns; ++column) {
            const uint32_t* slots = tile.slots(column, k);
            uint32_t found = 0;
            for (int z = 0; z < levels; ++z)
                found |= slots[z];
            if (found == 0)
                continue;
            any |= found;
            const size_t base = morton(column % kTileBricks, column / kTileBricks, 0);
            for (int z = 0; z < levels; ++z)
                slots_[0][base | kAlongZ[z]] = slots[z];
        }
        if (any == 0)
            return false;
        for (int level = 1; level <= 3; ++level)
            for (int i = 0; i < kBrickVoxels >> 3 * level; ++i) {
                const uint32_t* children = &slots_[level - 1][8 * i];
                uint32_t differ = 0;
                for (int c = 1; c < 8; ++c)
                    differ |= children[c] ^ children[0];
                slots_[level][i] = differ == 0 ? children[0] : kMixed;
            }
        return true;
    }

    /// Reads a cube whose slots are all the same, as are most of a solid; false where they are not.
    bool read_uniform_cube(const TileVoxels& tile, int k) {
        const uint32_t first = *tile.slots(0, k);
        if (first >= TileVoxels::kFirstBrick)
            return false;
        for (int column = 0; column < kTileColumns; ++column) {
            const uint32_t* slots = tile.slots(column, k);
            uint32_t differ = 0;
            for (int z = 0; z < kTileBricks; ++z)
                differ |= slots[z] ^ first;
            if (differ != 0)
                return false;
        }
        slots_[3][0] = first;
        return true;
    }

    void emit(const TileVoxels& tile, int level, int i, uint64_t code, TileResult& out) {
        const uint32_t slot = slots_[level][i];
        if (slot == 0)
            return;
        if (slot < TileVoxels::kFirstBrick) {
            out.octant_codes.push_back(code);
            out.octant_levels.push_back(uint8_t(level + kBrickBits));
            out.octant_materials.push_back(uint8_t(slot));
        } else if (level > 0) {
            for (int c = 0; c < 8; ++c)
                emit(tile, level - 1, 8 * i + c, code << 3 | uint64_t(c), out);
        } else {
            count_work(10);
            const VoxelBrick& brick = tile.brick(slot);
            out.brick_codes.push_back(code);
            out.brick_masks.push_back(morton_order(brick.mask));
            emit_materials(tile, brick, out);
        }
    }

    void emit_materials(const TileVoxels& tile, const VoxelBrick& brick, TileResult& out) {
        if (brick.cells == kNone) {
            out.brick_materials.push_back(brick.material);
            out.brick_rows.push_back(-1);
            return;
        }
        const Cells& cells = tile.cells(brick.cells);
        if (const uint8_t only = only_material(cells); only != 0) {
            out.brick_materials.push_back(only);
            out.brick_rows.push_back(-1);
            return;
        }
        out.brick_materials.push_back(0);
        out.brick_rows.push_back(int32_t(out.cells.size()));
        Cells& row = out.cells.emplace_back();
        for (int z = 0; z < kBrickSide; ++z)
            for (int bit = 0; bit < 64; ++bit)
                row[morton(column_x(bit), column_y(bit), z)] = cells[z * 64 + bit];
    }

    static constexpr std::array<uint16_t, 8> kAlongZ = {0, 4, 32, 36, 256, 260, 288, 292}; // morton(0, 0, z)
    static constexpr uint32_t kMixed = 0xFFFF'FFFF; // no slot: the bricks below differ. Not below kFirstBrick

    /// By level, in Morton order: the slot of a brick, and of 8, 64 or 512 where these are all equal.
    std::array<std::array<uint32_t, kBrickVoxels>, 4> slots_;
};

} // namespace voxrt::voxelize
