// From one object's shell and crossings in a tile to the voxels it claims.
//
// Each brick column is swept upwards once. Between shell bricks the winding numbers stand still, so a run of bricks
// there is claimed or skipped as a whole.
//
// Where the surface has holes, the sweep knows the winding number of the surface with its holes capped, and what the
// caps add is taken off: a whole number for most of space, found once for a large cube or a brick; voxel by voxel only
// in bricks on a cap or where the two halves of a hole's doubt meet. A voxel is inside when what is left is beyond 1/2.
#pragma once

#include "column_winding.h"
#include "survey.h"
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
            if (brick.material != 0 || cells != nullptr)
                result.voxels += tile.claim(column, k, slices_of(brick.shell), brick.material, cells);
        }
        return result;
    }

    /// Claims the shell and what it encloses; the inside takes the material `interior`.
    Claim claim_solid(TileVoxels& tile, ObjectLayer& layer, uint8_t interior) {
        Claim result;
        sort_spills(layer);
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

    /// The same for a part with holes, whose inside lies within `box`; `window` is the tile's.
    Claim claim_open_solid(TileVoxels& tile, ObjectLayer& layer, uint8_t interior, const HoleWinding& holes,
                           const VoxelBox& box, const Window& window) {
        Claim result;
        sort_spills(layer);
        settled_.assign(size_t(kTileColumns) * layer.height(), 0);
        const int low = std::max(box.low[2], 0) >> kBrickBits, high = std::min(box.high[2], window.top) >> kBrickBits;
        for (int cube = low / kTileBricks; cube <= high / kTileBricks; ++cube)
            settle(layer, holes, window, 0, 0, cube * kTileBricks, kTileBricks);
        for (int column = 0; column < kTileColumns; ++column)
            sweep_open(tile, layer, column, interior, holes, box, window, result);
        return result;
    }

private:
    void sort_spills(const ObjectLayer& layer) {
        spills_.assign(layer.spills().begin(), layer.spills().end());
        std::sort(spills_.begin(), spills_.end(), [](const Spill& a, const Spill& b) { return a.brick < b.brick; });
    }

    /// A brick's crossings slice by slice.
    struct Crossings {
        explicit Crossings(const ShellBrick& brick) {
            if (brick.crossed) {
                enters = slices_of(brick.enters);
                leaves = slices_of(brick.leaves);
            }
        }
        Slices enters{}, leaves{};
    };

    /// Adds a slice's crossings to the running winding numbers.
    void advance(ColumnWinding& winding, const Crossings& crossings, uint32_t brick, bool has_spill, int z) {
        if (has_spill)
            add_spills(winding, brick, z);
        if ((crossings.enters[z] | crossings.leaves[z]) != 0)
            winding.add(crossings.enters[z], crossings.leaves[z]);
    }

    void sweep(TileVoxels& tile, ObjectLayer& layer, int column, int k, int highest, uint8_t interior, Claim& result) {
        ColumnWinding winding;
        const int slices = std::min(layer.side(), kBrickSide);
        while (k < layer.height()) {
            const ShellBrick* brick = layer.find(column, k);
            if (brick == nullptr) {
                const int end = k > highest ? layer.height() : next_brick(layer, column, k, highest);
                claim_run(tile, column, k, end, winding.inside(), interior, result);
                k = end;
                continue;
            }
            Slices within{};
            const Crossings crossings(*brick);
            const uint32_t index = layer.index_of(*brick);
            for (int z = 0; z < slices; ++z) {
                advance(winding, crossings, index, brick->has_spill, z);
                within[z] = winding.inside();
            }
            claim_brick(tile, layer, column, k, *brick, slices_of(brick->shell), within, interior, result);
            ++k;
        }
        result.simple = result.simple && winding.simple();
    }

    static int next_brick(ObjectLayer& layer, int column, int k, int highest) {
        while (k <= highest && layer.find(column, k) == nullptr)
            ++k;
        return k;
    }

    void claim_run(TileVoxels& tile, int column, int from, int to, uint64_t inside, uint8_t interior, Claim& result) {
        if (inside == ~uint64_t{0}) {
            result.voxels += tile.claim_full(column, from, to, interior);
        } else if (inside != 0) {
            Slices mask;
            mask.fill(inside);
            for (int k = from; k < to; ++k)
                result.voxels += tile.claim(column, k, mask, interior, nullptr);
        }
    }

    /// Finds, for the bricks of a cube of `bricks` a side, the whole number that the caps add there.
    void settle(const ObjectLayer& layer, const HoleWinding& holes, const Window& w, int bx, int by, int k,
                int bricks) {
        if (k >= layer.height())
            return;
        const double half = bricks * kBrickSide / 2.0;
        const int value =
            holes.settled({w.x0 + bx * kBrickSide + half, w.y0 + by * kBrickSide + half, k * kBrickSide + half},
                          half * 1.7320508075688772);
        if (value == HoleWinding::kUnsettled && bricks > 1) {
            const int step = bricks / 2;
            for (int i = 0; i < 8; ++i)
                settle(layer, holes, w, bx + (i & 1) * step, by + (i >> 1 & 1) * step, k + (i >> 2) * step, step);
            return;
        }
        for (int y = by; y < by + bricks; ++y)
            for (int x = bx; x < bx + bricks; ++x)
                for (int z = k; z < std::min(k + bricks, layer.height()); ++z)
                    settled_[size_t(y * kTileBricks + x) * layer.height() + z] = value;
    }

    void sweep_open(TileVoxels& tile, ObjectLayer& layer, int column, uint8_t interior, const HoleWinding& holes,
                    const VoxelBox& box, const Window& w, Claim& result) {
        static const ShellBrick nothing;
        ColumnWinding winding;
        const int x0 = w.x0 + column % kTileBricks * kBrickSide, y0 = w.y0 + column / kTileBricks * kBrickSide;
        uint64_t columns = 0; // inside the box and the grid
        for (int bit = 0; bit < 64; ++bit) {
            const int x = x0 + column_x(bit), y = y0 + column_y(bit);
            if (x >= box.low[0] && x <= std::min(box.high[0], w.x1) && y >= box.low[1] &&
                y <= std::min(box.high[1], w.y1))
                columns |= uint64_t{1} << bit;
        }
        for (int k = 0; k < layer.height(); ++k) {
            const ShellBrick* found = layer.find(column, k);
            const ShellBrick& brick = found != nullptr ? *found : nothing;
            const int value = settled_[size_t(column) * layer.height() + k];
            if (found == nullptr && value == 0 && winding.inside() == 0)
                continue;
            Slices within{};
            const Slices shell = slices_of(brick.shell);
            const Crossings crossings(brick);
            for (int z = 0; z < kBrickSide; ++z) {
                if (found != nullptr)
                    advance(winding, crossings, layer.index_of(brick), brick.has_spill, z);
                const int at = k * kBrickSide + z;
                if (at < box.low[2] || at > std::min(box.high[2], w.top))
                    continue;
                if (value != HoleWinding::kUnsettled) {
                    within[z] = winding.differs(value) & columns;
                    continue;
                }
                for (uint64_t left = columns & ~shell[z]; left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    constexpr double sample = 0.5 + 1.0 / 8192;
                    const double seen =
                        holes.at({x0 + column_x(bit) + sample, y0 + column_y(bit) + sample, at + sample});
                    if (std::abs(winding.at(bit) - seen) > 0.5 + 1e-6)
                        within[z] |= uint64_t{1} << bit;
                }
            }
            if (is_full(within) && is_empty(shell))
                claim_run(tile, column, k, k + 1, ~uint64_t{0}, interior, result);
            else
                claim_brick(tile, layer, column, k, brick, shell, within, interior, result);
        }
    }

    void claim_brick(TileVoxels& tile, ObjectLayer& layer, int column, int k, const ShellBrick& brick,
                     const Slices& shell, const Slices& within, uint8_t interior, Claim& result) {
        Slices mask, hidden;
        for (int z = 0; z < kBrickSide; ++z) {
            mask[z] = shell[z] | within[z];
            hidden[z] = within[z] & ~shell[z];
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
                cells[i] = shell[z] >> bit & 1 ? own : hidden[z] >> bit & 1 ? interior : 0;
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
    std::vector<int> settled_; // by brick place: what the caps add, or kUnsettled
};

} // namespace voxrt
