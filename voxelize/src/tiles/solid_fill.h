// From one object's surface in a tile to the voxels that it claims: the shell, and what it encloses.
//
// Each brick column is swept upwards once, with the winding numbers of its 64 columns (column_winding.h). They do not
// change between shell bricks, so a run of bricks there is claimed or skipped as a whole.
//
// Where the surface has holes, the sweep gives the winding number of the capped surface, and GeneralizedInside
// subtracts what the caps add.
//
// With a rule, crossings are marked where the winding number changes from one voxel's centre to the next, so that it
// tells for voxels with surface, too, whether their centre is inside.
#pragma once

#include "../mesh/mesh_analysis.h"
#include "column_winding.h"
#include "generalized_inside.h"
#include "lone_rule.h"
#include "rule_tile.h"
#include "tile_voxels.h"
#include "volume_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxrt::voxelize {

struct Claim {
    int64_t voxels = 0;                      // that no earlier object had
    int64_t shell = 0;                       // voxels of the shell, whoever has them
    int64_t inside = 0;                      // voxels that the shell encloses, whoever has them
    bool simple = true;                      // all winding numbers were 0 and 1, or 0 and -1
    bool positive = false, negative = false; // whether a voxel without shell has such a winding number

    /// `shell`: columns whose winding numbers do not count.
    void note(const ColumnWinding& winding, uint64_t shell) {
        const uint64_t below = winding.below_zero();
        positive = positive || (winding.inside() & ~below & ~shell) != 0;
        negative = negative || (below & ~shell) != 0;
    }
};

class SolidFill {
public:
    /// Where what rules fill is noted; both null where all parts have `touch`.
    void use_rule(RuleTile* rule, LoneRule* lone) {
        rule_ = rule;
        lone_ = lone;
    }

    /// Which columns of a lone part need volumes; null where all do.
    void use_sheets(const ColumnSheets* sheets) { sheets_ = sheets; }

    /// Claims the shell alone, which every rule fills.
    Claim claim_shell(TileVoxels& tile, TileSurface& object) {
        Claim result;
        for (uint32_t slot : object.slots()) {
            const int column = int(slot) / object.height(), k = int(slot) % object.height();
            const ShellBrick& brick = *object.find(column, k);
            const Cells* cells = brick.cells == kNone ? nullptr : &object.cells(brick.cells);
            if (!brick.has_shell())
                continue;
            const Slices shell = slices_of(brick.shell);
            Slices claimed;
            result.voxels += tile.claim(column, k, shell, brick.material, cells, rule_ ? &claimed : nullptr);
            if (rule_)
                rule_->add(column, k, shell, shell, claimed, object.mixed(brick));
            if (lone_)
                lone_->add(column, k, shell, shell);
        }
        return result;
    }

    /// Claims the shell and what it encloses. The inside takes the material `interior`.
    Claim claim_solid(TileVoxels& tile, TileSurface& object, uint8_t interior) {
        Claim result;
        is_capped_ = false;
        sort_repeated(object);
        int lowest[kTileColumns], highest[kTileColumns];
        std::fill_n(lowest, kTileColumns, INT_MAX);
        std::fill_n(highest, kTileColumns, -1);
        for (uint32_t slot : object.slots()) {
            const int column = int(slot) / object.height(), k = int(slot) % object.height();
            lowest[column] = std::min(lowest[column], k);
            highest[column] = std::max(highest[column], k);
        }
        for (int column = 0; column < kTileColumns; ++column)
            if (highest[column] >= 0)
                sweep(tile, object, column, lowest[column], highest[column], interior, result);
        return result;
    }

    /// The same for a capped surface. The inside lies within `box`; `window` is the tile's.
    Claim claim_capped_solid(TileVoxels& tile, TileSurface& object, uint8_t interior, const CapWinding& caps,
                             const VoxelBox& box, const Window& window) {
        Claim result;
        is_capped_ = true;
        by_volume_ = 0;
        sort_repeated(object);
        inside_.reset(caps, box, window);
        for (int column = 0; column < kTileColumns; ++column)
            record_winding(object, column);
        inside_.classify();
        for (int column = 0; column < kTileColumns; ++column)
            sweep_capped(tile, object, column, interior, result);
        return result;
    }

private:
    void sort_repeated(const TileSurface& object) {
        repeated_.assign(object.repeated_crossings().begin(), object.repeated_crossings().end());
        std::sort(repeated_.begin(), repeated_.end(),
                  [](const RepeatedCrossing& a, const RepeatedCrossing& b) { return a.brick < b.brick; });
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
    void advance(ColumnWinding& winding, const Crossings& crossings, uint32_t brick, bool has_repeated, int z) {
        if (has_repeated)
            add_repeated(winding, brick, z);
        if ((crossings.enters[z] | crossings.leaves[z]) != 0)
            winding.add(crossings.enters[z], crossings.leaves[z]);
    }

    void sweep(TileVoxels& tile, TileSurface& object, int column, int k, int highest, uint8_t interior, Claim& result) {
        count_work(20 * uint32_t(object.height()));
        ColumnWinding winding;
        const int slices = std::min(object.side(), kBrickSide);
        by_volume_ = !(lone_ ? lone_->asks_for_volumes() : rule_ && rule_->asks_for_volumes()) ? 0
                     : sheets_ ? columns_of(sheets_->doubtful, column)
                               : ~uint64_t{0};
        const bool has_volumes = by_volume_ != 0;
        sums_.clear();
        while (k < object.height()) {
            const ShellBrick* brick = object.find(column, k);
            if (brick == nullptr) {
                const int end = k > highest ? object.height() : object.next_brick(column, k, highest);
                claim_run(tile, column, k, end, winding.inside(), interior, result);
                result.note(winding, 0);
                sums_.clear();
                k = end;
                continue;
            }
            Slices within{};
            const Slices shell = slices_of(brick->shell);
            Slices surface = has_volumes ? object.all_surface(*brick, shell) : Slices{};
            for (uint64_t& slice : surface)
                slice &= by_volume_;
            const Crossings crossings(*brick);
            const uint32_t index = object.index_of(*brick);
            const PiecesOfBrick* pieces = brick->pieces == kNone ? nullptr : &object.pieces(brick->pieces);
            std::array<double, kBrickVoxels>* volumes = !has_volumes ? nullptr
                                                        : lone_      ? &lone_->volumes()
                                                                     : &rule_->room_for_volumes(column, k);
            for (int z = 0; z < slices; ++z) {
                sums_.begin(surface[z], winding);
                advance(winding, crossings, index, brick->has_repeated, z);
                within[z] = winding.inside();
                result.note(winding, shell[z]);
                if (surface[z] != 0)
                    sums_.add(object, pieces, surface[z], *volumes, z);
            }
            if (pieces)
                sums_.carry(object, *pieces, winding);
            claim_brick(tile, object, column, k, *brick, within, interior, result);
            ++k;
        }
        result.simple = result.simple && winding.simple();
    }

    /// The columns of a tile's rows that are in a brick column.
    static uint64_t columns_of(const ColumnSheets::Rows& rows, int column) {
        uint64_t found = 0;
        for (int y = 0; y < kBrickSide; ++y)
            found |= (rows[size_t(column / kTileBricks * kBrickSide + y)] >> column % kTileBricks * kBrickSide & 0xFF)
                     << kBrickSide * y;
        return found;
    }

    void claim_run(TileVoxels& tile, int column, int from, int to, uint64_t inside, uint8_t interior, Claim& result) {
        result.inside += int64_t{to - from} * kBrickSide * std::popcount(inside);
        if (inside == ~uint64_t{0}) {
            result.voxels += tile.claim_full(column, from, to, interior);
            if (rule_)
                rule_->add_full(column, from, to);
        } else if (inside != 0) {
            Slices mask;
            mask.fill(inside);
            for (int k = from; k < to; ++k) {
                result.voxels += tile.claim(column, k, mask, interior, nullptr);
                if (rule_)
                    rule_->add(column, k, mask, {}, {});
                if (lone_)
                    lone_->add(column, k, mask, mask);
            }
        }
    }

    /// Records the winding numbers of the capped surface that the classification needs.
    void record_winding(TileSurface& object, int column) {
        ColumnWinding winding;
        GeneralizedInside::Brick last;
        for (int k = 0; k < object.height(); ++k) {
            count_work(10);
            const ShellBrick* brick = object.find(column, k);
            if (brick != nullptr) {
                const Crossings crossings(*brick);
                for (int z = 0; z < kBrickSide; ++z) {
                    advance(winding, crossings, object.index_of(*brick), brick->has_repeated, z);
                    if (z == 0)
                        last.corner = winding.at(0);
                    if (z == kBrickSide / 2)
                        last.middle = winding.at(column_bit(kBrickSide / 2, kBrickSide / 2));
                }
                last.has_surface = brick->has_shell() || brick->transparent != kNone;
            }
            inside_.brick(column, k) = last;
            if (brick != nullptr)
                last = {winding.at(0), winding.at(column_bit(kBrickSide / 2, kBrickSide / 2)), false};
        }
    }

    void sweep_capped(TileVoxels& tile, TileSurface& object, int column, uint8_t interior, Claim& result) {
        static const ShellBrick no_surface;
        ColumnWinding winding;
        for (int k = 0; k < object.height(); ++k) {
            count_work(10);
            const ShellBrick* found = object.find(column, k);
            const ShellBrick& brick = found != nullptr ? *found : no_surface;
            const GeneralizedInside::Class kind = inside_.class_of(column, k);
            if (found == nullptr && (kind == GeneralizedInside::Class::outside ||
                                     (kind == GeneralizedInside::Class::capped && winding.inside() == 0)))
                continue;
            const Slices surface = object.all_surface(brick, slices_of(brick.shell));
            const Crossings crossings(brick);
            const bool mixed = GeneralizedInside::is_mixed(kind);
            Slices within{};
            if (mixed)
                numbers_.resize(kBrickVoxels);
            for (int z = 0; z < kBrickSide; ++z) {
                if (found != nullptr)
                    advance(winding, crossings, object.index_of(brick), brick.has_repeated, z);
                within[z] = kind == GeneralizedInside::Class::inside   ? ~uint64_t{0}
                            : kind == GeneralizedInside::Class::capped ? winding.inside()
                                                                       : 0;
                if (kind == GeneralizedInside::Class::capped) // caps do not change these
                    result.note(winding, surface[z]);
                for (int bit = 0; mixed && bit < 64; ++bit)
                    numbers_[z * 64 + bit] = winding.at(bit);
            }
            if (mixed)
                within = inside_.inside(column, k, surface, numbers_);
            else if (!is_empty(within))
                intersect(within, inside_.box_of(column, k));
            if (is_full(within) && is_empty(surface)) {
                claim_run(tile, column, k, k + 1, ~uint64_t{0}, interior, result);
                continue;
            }
            if (mixed && (lone_ || (rule_ && !rule_->fills_all()))) {
                const Slices holds = inside_.inside_at_surface(column, k, surface, numbers_);
                for (int z = 0; z < kBrickSide; ++z)
                    within[z] |= holds[z];
            }
            claim_brick(tile, object, column, k, brick, within, interior, result);
        }
    }

    static void intersect(Slices& within, const Slices& box) {
        for (int z = 0; z < kBrickSide; ++z)
            within[z] &= box[z];
    }

    void claim_brick(TileVoxels& tile, TileSurface& object, int column, int k, const ShellBrick& brick,
                     const Slices& within, uint8_t interior, Claim& result) {
        const Slices shell = slices_of(brick.shell), surface = object.all_surface(brick, shell);
        Slices mask, hidden;
        for (int z = 0; z < kBrickSide; ++z) {
            hidden[z] = within[z] & ~surface[z];
            mask[z] = shell[z] | hidden[z];
        }
        result.shell += count(shell);
        result.inside += count(hidden);
        if (is_empty(mask))
            return;
        if (lone_) {
            const Slices filled = lone_filled(column, k, shell, mask, hidden, within, object, brick);
            if (!is_empty(filled))
                result.voxels += tile.claim(column, k, filled, interior, nullptr);
            return;
        }
        Slices claimed;
        result.voxels += claim_cells(tile, object, column, k, brick, mask, hidden, interior, claimed);
        if (!rule_)
            return;
        const Slices held = object.held(brick);
        const bool by_volume = rule_->asks_for_volumes() && !is_capped_;
        if (by_volume)
            rule_->add_volumes(column, k, shell);
        Slices filled;
        for (int z = 0; z < kBrickSide; ++z) {
            filled[z] = rule_->fills_all() ? mask[z]
                        : by_volume        ? (hidden[z] | held[z]) & mask[z]
                                           : (within[z] | held[z]) & mask[z];
            claimed[z] &= shell[z];
        }
        rule_->add(column, k, filled, shell, claimed, object.mixed(brick));
    }

    /// What a lone part fills of a brick whose voxels `touched` it touches.
    Slices lone_filled(int column, int k, const Slices& shell, const Slices& touched, const Slices& hidden,
                       const Slices& within, const TileSurface& object, const ShellBrick& brick) {
        const Slices held = object.held(brick), on = object.on_centres(brick);
        const Slices undecided = object.undecided(brick);
        Slices filled, voxels;
        for (int z = 0; z < kBrickSide; ++z) {
            voxels[z] = shell[z] & by_volume_;
            const uint64_t by_centre = (within[z] | on[z]) & ~voxels[z] & ~undecided[z];
            filled[z] = (hidden[z] | held[z] | by_centre) & touched[z];
        }
        if (by_volume_ != 0 || brick.undecided != kNone)
            lone_->decide_halves(column, k, voxels, undecided, touched, filled);
        lone_->add(column, k, touched, filled);
        return filled;
    }

    /// Claims the shell and what is hidden behind it: `mask`. `claimed` becomes what was free, where a rule wants it.
    int64_t claim_cells(TileVoxels& tile, const TileSurface& object, int column, int k, const ShellBrick& brick,
                        const Slices& mask, const Slices& hidden, uint8_t interior, Slices& claimed) const {
        Slices* was_free = rule_ ? &claimed : nullptr;
        const bool has_shell = brick.has_shell();
        if (!has_shell || (brick.cells == kNone && (brick.material == interior || is_empty(hidden))))
            return tile.claim(column, k, mask, has_shell ? brick.material : interior, nullptr, was_free);
        const Slices shell = slices_of(brick.shell);
        Cells cells;
        for (int z = 0; z < kBrickSide; ++z)
            for (int bit = 0; bit < 64; ++bit) {
                const int i = z * 64 + bit;
                const uint8_t own = brick.cells == kNone ? brick.material : object.cells(brick.cells)[i];
                cells[i] = shell[z] >> bit & 1 ? own : hidden[z] >> bit & 1 ? interior : 0;
            }
        return tile.claim(column, k, mask, 0, &cells, was_free);
    }

    void add_repeated(ColumnWinding& winding, uint32_t brick, int z) {
        auto it = std::lower_bound(repeated_.begin(), repeated_.end(), brick,
                                   [](const RepeatedCrossing& s, uint32_t wanted) { return s.brick < wanted; });
        for (; it != repeated_.end() && it->brick == brick; ++it)
            if (it->z == z)
                winding.add(it->enters ? uint64_t{1} << it->bit : 0, it->enters ? 0 : uint64_t{1} << it->bit);
    }

    RuleTile* rule_ = nullptr;
    LoneRule* lone_ = nullptr;
    const ColumnSheets* sheets_ = nullptr;
    uint64_t by_volume_ = 0; // columns of a brick column where volumes decide
    bool is_capped_ = false;
    VolumeSums sums_;
    std::vector<RepeatedCrossing> repeated_;
    GeneralizedInside inside_;
    std::vector<int> numbers_; // winding numbers of the capped surface in a brick, by slice and bit
};

} // namespace voxrt::voxelize
