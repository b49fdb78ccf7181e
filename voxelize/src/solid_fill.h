// From one object's shell and crossings in a tile to the voxels it claims.
//
// Each brick column is swept upwards once. Between shell bricks the winding numbers stand still, so a run of bricks
// there is claimed or skipped as a whole.
#pragma once

#include "column_winding.h"
#include "tile_voxels.h"

#include <algorithm>

namespace voxrt {

struct Claim {
    int64_t voxels = 0; // that were free
    bool simple = true; // winding numbers were 0 and 1, or 0 and -1
};

class SolidFill {
public:
    /// Claims the shell alone.
    Claim claim_shell(TileVoxels& tile, ObjectLayer& layer) {
        Claim result;
        for (uint32_t place : layer.places()) {
            const int column = int(place) / layer.height(), k = int(place) % layer.height();
            const ShellBrick& brick = *layer.find(column, k);
            const Cells* cells = brick.cells == kNone ? nullptr : &layer.cells(brick.cells);
            if (!is_empty(brick.shell))
                result.voxels += tile.claim(column, k, brick.shell, brick.material, cells);
        }
        return result;
    }

    /// Claims the shell and what it encloses; the inside takes the material `interior`.
    Claim claim_solid(TileVoxels& tile, ObjectLayer& layer, uint8_t interior) {
        Claim result;
        spills_.assign(layer.spills().begin(), layer.spills().end());
        std::sort(spills_.begin(), spills_.end(), [](const Spill& a, const Spill& b) { return a.brick < b.brick; });
        int lowest[kTileColumns], highest[kTileColumns];
        std::fill_n(lowest, kTileColumns, INT_MAX);
        std::fill_n(highest, kTileColumns, -1);
        for (uint32_t place : layer.places()) {
            const int column = int(place) / layer.height(), k = int(place) % layer.height();
            lowest[column] = std::min(lowest[column], k);
            highest[column] = std::max(highest[column], k);
        }
        for (int column = 0; column < kTileColumns; ++column)
            if (highest[column] >= 0)
                sweep(tile, layer, column, lowest[column], highest[column], interior, result);
        return result;
    }

private:
    void sweep(TileVoxels& tile, ObjectLayer& layer, int column, int k, int highest, uint8_t interior, Claim& result) {
        ColumnWinding winding;
        const int slices = std::min(layer.side(), kBrickSide);
        while (k < layer.height()) {
            const ShellBrick* brick = layer.find(column, k);
            const uint64_t inside = winding.inside();
            if (brick == nullptr) {
                int end = k + 1;
                while (end <= highest && layer.find(column, end) == nullptr)
                    ++end;
                if (end > highest)
                    end = layer.height();
                if (inside == ~uint64_t{0}) {
                    result.voxels += tile.claim_full(column, k, end, interior);
                } else if (inside != 0) {
                    Slices mask;
                    mask.fill(inside);
                    for (int at = k; at < end; ++at)
                        result.voxels += tile.claim(column, at, mask, interior, nullptr);
                }
                k = end;
                continue;
            }
            Slices within{};
            for (int z = 0; z < slices; ++z) {
                if (brick->has_spill)
                    add_spills(winding, layer.index_of(*brick), z);
                if ((brick->enters[z] | brick->leaves[z]) != 0)
                    winding.add(brick->enters[z], brick->leaves[z]);
                within[z] = winding.inside();
            }
            claim_brick(tile, layer, column, k, *brick, within, interior, result);
            ++k;
        }
        result.simple = result.simple && winding.simple();
    }

    void claim_brick(TileVoxels& tile, ObjectLayer& layer, int column, int k, const ShellBrick& brick,
                     const Slices& within, uint8_t interior, Claim& result) {
        Slices mask, hidden;
        for (int z = 0; z < kBrickSide; ++z) {
            mask[z] = brick.shell[z] | within[z];
            hidden[z] = within[z] & ~brick.shell[z];
        }
        if (is_empty(mask))
            return;
        const bool has_shell = brick.material != 0 || brick.cells != kNone;
        if (!has_shell || (brick.cells == kNone && (brick.material == interior || is_empty(hidden)))) {
            result.voxels += tile.claim(column, k, mask, has_shell ? brick.material : interior, nullptr);
            return;
        }
        Cells cells;
        for (int z = 0; z < kBrickSide; ++z)
            for (int bit = 0; bit < 64; ++bit) {
                const int i = z * 64 + bit;
                const uint8_t own = brick.cells == kNone ? brick.material : layer.cells(brick.cells)[i];
                cells[i] = brick.shell[z] >> bit & 1 ? own : hidden[z] >> bit & 1 ? interior : 0;
            }
        result.voxels += tile.claim(column, k, mask, 0, &cells);
    }

    void add_spills(ColumnWinding& winding, uint32_t brick, int z) {
        auto it = std::lower_bound(spills_.begin(), spills_.end(), brick,
                                   [](const Spill& s, uint32_t wanted) { return s.brick < wanted; });
        for (; it != spills_.end() && it->brick == brick; ++it)
            if (it->z == z)
                winding.add(it->enters ? uint64_t{1} << it->bit : 0, it->enters ? 0 : uint64_t{1} << it->bit);
    }

    std::vector<Spill> spills_;
};

} // namespace voxrt
