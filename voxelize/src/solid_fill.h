// From one object's shell and crossings in a tile to the voxels it claims.
//
// Each brick column is swept upwards once. Between shell bricks the winding numbers stand still, so a run of bricks
// there is claimed or skipped as a whole.
//
// Where the surface has holes, the sweep knows the winding number of the surface with its holes capped, and OpenInside
// takes off what the caps add.
#pragma once

#include "column_winding.h"
#include "open_inside.h"
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
            if (brick.has_shell())
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
        inside_.start(holes, box, window);
        for (int column = 0; column < kTileColumns; ++column)
            number_open(layer, column);
        inside_.settle();
        for (int column = 0; column < kTileColumns; ++column)
            sweep_open(tile, layer, column, interior, result);
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
        pulse(20 * uint32_t(layer.height()));
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
            claim_brick(tile, layer, column, k, *brick, within, interior, result);
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

    /// Tells the winding numbers of the closed surface where the settling of large cubes asks for them.
    void number_open(ObjectLayer& layer, int column) {
        ColumnWinding winding;
        OpenInside::Brick last;
        for (int k = 0; k < layer.height(); ++k) {
            pulse(10);
            const ShellBrick* brick = layer.find(column, k);
            if (brick != nullptr) {
                const Crossings crossings(*brick);
                for (int z = 0; z < kBrickSide; ++z) {
                    advance(winding, crossings, layer.index_of(*brick), brick->has_spill, z);
                    if (z == 0)
                        last.corner = winding.at(0);
                    if (z == kBrickSide / 2)
                        last.middle = winding.at(column_bit(kBrickSide / 2, kBrickSide / 2));
                }
                last.surface = brick->has_shell() || brick->cuts != kNone;
            }
            inside_.brick(column, k) = last;
            if (brick != nullptr)
                last = {winding.at(0), winding.at(column_bit(kBrickSide / 2, kBrickSide / 2)), false};
        }
    }

    void sweep_open(TileVoxels& tile, ObjectLayer& layer, int column, uint8_t interior, Claim& result) {
        static const ShellBrick nothing;
        ColumnWinding winding;
        for (int k = 0; k < layer.height(); ++k) {
            pulse(10);
            const ShellBrick* found = layer.find(column, k);
            const ShellBrick& brick = found != nullptr ? *found : nothing;
            const OpenInside::Verdict verdict = inside_.verdict(column, k);
            if (found == nullptr && (verdict == OpenInside::Verdict::outside ||
                                     (verdict == OpenInside::Verdict::capped && winding.inside() == 0)))
                continue;
            const Slices surface = layer.surface(brick, slices_of(brick.shell));
            const Crossings crossings(brick);
            const bool mixed = verdict == OpenInside::Verdict::mixed;
            Slices within{};
            if (mixed)
                numbers_.resize(kBrickVoxels);
            for (int z = 0; z < kBrickSide; ++z) {
                if (found != nullptr)
                    advance(winding, crossings, layer.index_of(brick), brick.has_spill, z);
                within[z] = verdict == OpenInside::Verdict::inside   ? ~uint64_t{0}
                            : verdict == OpenInside::Verdict::capped ? winding.inside()
                                                                     : 0;
                for (int bit = 0; mixed && bit < 64; ++bit)
                    numbers_[z * 64 + bit] = winding.at(bit);
            }
            if (mixed)
                within = inside_.inside(column, k, surface, numbers_);
            else if (!is_empty(within))
                keep(within, inside_.box_of(column, k));
            if (is_full(within) && is_empty(surface))
                claim_run(tile, column, k, k + 1, ~uint64_t{0}, interior, result);
            else
                claim_brick(tile, layer, column, k, brick, within, interior, result);
        }
    }

    static void keep(Slices& within, const Slices& box) {
        for (int z = 0; z < kBrickSide; ++z)
            within[z] &= box[z];
    }

    void claim_brick(TileVoxels& tile, ObjectLayer& layer, int column, int k, const ShellBrick& brick,
                     const Slices& within, uint8_t interior, Claim& result) {
        const Slices shell = slices_of(brick.shell), surface = layer.surface(brick, shell);
        Slices mask, hidden;
        for (int z = 0; z < kBrickSide; ++z) {
            hidden[z] = within[z] & ~surface[z];
            mask[z] = shell[z] | hidden[z];
        }
        if (is_empty(mask))
            return;
        const bool has_shell = brick.has_shell();
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
    OpenInside inside_;
    std::vector<int> numbers_; // of the closed surface in a brick, by slice and bit
};

} // namespace voxrt
