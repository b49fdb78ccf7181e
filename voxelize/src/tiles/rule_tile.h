// What a rule other than `touch` must know of one tile: which voxels the rule fills, and which ones have surface.
//
// The voxels that objects touch are claimed as always (tile_voxels.h). Beside them stand two unions over all objects:
// what the rule fills, and what surfaces pass. When the tile is done, its bricks with surface are listed; rule_voxels.h
// goes on with the bricks of all tiles.
#pragma once

#include "../rules/rule.h"
#include "../rules/rule_brick.h"
#include "../rules/voxel_volume.h"
#include "tile_voxels.h"

#include <vector>

namespace voxrt::voxelize {

class RuleTile {
public:
    /// For tiles of a grid of `side` voxels.
    explicit RuleTile(int side) : filled_(side), surface_(side) {}

    /// Empties it for the tile at (tile_x, tile_y), in tiles.
    void clear(int tile_x, int tile_y) {
        tile_x_ = tile_x;
        tile_y_ = tile_y;
        filled_.clear();
        surface_.clear();
        owned_.clear();
        for (const size_t slot : summed_)
            sum_rows_[slot] = kNone;
        summed_.clear();
        sums_.clear();
    }

    /// What is added from now on belongs to an object, and has its rule.
    void begin(uint32_t object, Rule rule) {
        object_ = object;
        rule_of_part_ = rule;
    }
    bool fills_all() const { return rule_of_part_ == Rule::touch; }
    bool asks_for_volumes() const { return rule_of_part_ == Rule::half; }

    /// Bricks from <= k < to of a column are filled, and have no surface.
    void add_full(int column, int from, int to) { filled_.claim_full(column, from, to, kAny); }

    /// `claimed`: those of the voxels with surface that no earlier object had.
    void add(int column, int k, const Slices& filled, const Slices& surface, const Slices& claimed) {
        if (!is_empty(filled))
            filled_.claim(column, k, filled, kAny, nullptr);
        if (is_empty(surface))
            return;
        surface_.claim(column, k, surface, kAny, nullptr);
        if (!is_empty(claimed))
            owned_.push_back({code_of(column, k), object_, claimed});
    }

    /// Adds volumes of the part in voxels of a brick, by slice and bit.
    void add_volumes(int column, int k, const Slices& voxels, const std::array<double, kBrickVoxels>& volumes) {
        const size_t slot = size_t(column) * size_t(filled_.height()) + size_t(k);
        if (sum_rows_.empty())
            sum_rows_.assign(size_t(kTileColumns) * size_t(filled_.height()), kNone);
        uint32_t& row = sum_rows_[slot];
        if (row == kNone) {
            row = uint32_t(sums_.size());
            sums_.emplace_back();
            summed_.push_back(slot);
        }
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = voxels[z]; left != 0; left &= left - 1) {
                const auto place = size_t(z * 64 + std::countr_zero(left));
                sums_[row][place] += volumes[place];
            }
    }

    /// Appends the bricks of the tile, and who owns their surface.
    void list(const TileVoxels& tile, std::vector<RuleBrick>& bricks, std::vector<OwnedSurface>& owned) const {
        for (int column = 0; column < kTileColumns; ++column) {
            if (!tile.column_used(column))
                continue;
            for (int k = 0; k < tile.height(); ++k) {
                const uint32_t slot = *tile.slots(column, k), surface = *surface_.slots(column, k);
                if (slot == 0 || (slot < TileVoxels::kFirstBrick && surface == 0))
                    continue;
                const Slices touched = tile.mask_of(slot);
                Slices filled = filled_.mask_of(*filled_.slots(column, k));
                const size_t place = size_t(column) * size_t(tile.height()) + size_t(k);
                if (!summed_.empty() && sum_rows_[place] != kNone)
                    add_halves(filled, sums_[sum_rows_[place]]);
                for (int z = 0; z < kBrickSide; ++z)
                    filled[z] &= touched[z];
                bricks.push_back({code_of(column, k), touched, filled, surface_.mask_of(surface)});
            }
        }
        owned.insert(owned.end(), owned_.begin(), owned_.end());
    }

    /// Appends the volumes of the last object, and forgets it.
    void take_volumes(std::vector<VoxelVolume>& volumes) {
        for (const size_t slot : summed_) {
            const auto column = int(slot / size_t(filled_.height())), k = int(slot % size_t(filled_.height()));
            const uint64_t code = code_of(column, k) << 9;
            const Slices surface = surface_.mask_of(*surface_.slots(column, k));
            const Slices whole = filled_.mask_of(*filled_.slots(column, k)); // by another part
            for (int z = 0; z < kBrickSide; ++z)
                for (uint64_t left = surface[z] & ~whole[z]; left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const uint64_t place = morton(uint32_t(column_x(bit)), uint32_t(column_y(bit)), uint32_t(z));
                    const double volume = sums_[sum_rows_[slot]][size_t(z * 64 + bit)];
                    volumes.push_back({object_, code | place, std::min(volume, 1.0)});
                }
        }
        clear(tile_x_, tile_y_);
    }

private:
    static constexpr uint8_t kAny = 1; // a material: all voxels here have the same
    // Sums are exact to 2^-41. Volumes whose corners are on the lattice of 1/4096 voxel are 1/2, or differ by 2^-39.
    static constexpr double kHalf = 0.5 - 0x1p-40;

    static void add_halves(Slices& filled, const std::array<double, kBrickVoxels>& volumes) {
        for (int z = 0; z < kBrickSide; ++z)
            for (int bit = 0; bit < 64; ++bit)
                filled[z] |= uint64_t{volumes[size_t(z * 64 + bit)] >= kHalf} << bit;
    }

    uint64_t code_of(int column, int k) const {
        return morton(uint32_t(tile_x_ * kTileBricks + column % kTileBricks),
                      uint32_t(tile_y_ * kTileBricks + column / kTileBricks), uint32_t(k));
    }

    TileVoxels filled_, surface_;
    std::vector<uint32_t> sum_rows_; // by slot: where the sums of volumes stand
    std::vector<size_t> summed_;     // the slots that have some
    std::vector<std::array<double, kBrickVoxels>> sums_;
    uint32_t object_ = 0;
    Rule rule_of_part_ = Rule::touch;
    int tile_x_ = 0, tile_y_ = 0;
    std::vector<OwnedSurface> owned_;
};

} // namespace voxrt::voxelize
