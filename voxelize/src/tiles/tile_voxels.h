// The voxels of one tile, after the objects have competed: the first in authored order keeps what it claims.
//
// Each slot of the tile is empty, full of one material, or a brick. The table takes 4 bytes per slot (1/128 byte per
// voxel) and is cleared column by column.
#pragma once

#include "../coverage/tile_surface.h"

namespace voxrt::voxelize {

struct VoxelBrick {
    Slices mask{};
    uint32_t cells = kNone; // row of materials where the brick has several
    uint8_t material = 0;   // the only material, else 0
};

class TileVoxels {
public:
    /// For tiles of a grid of `side` voxels.
    explicit TileVoxels(int side)
        : height_((side + kBrickSide - 1) / kBrickSide), table_(size_t(kTileColumns) * height_, 0) {}

    int height() const { return height_; }

    /// Empties the tile.
    void clear() {
        for (int column = 0; column < kTileColumns; ++column)
            if (used_ >> column & 1)
                std::fill_n(table_.begin() + size_t(column) * height_, height_, 0u);
        used_ = 0;
        bricks_.clear();
        cells_.clear();
    }

    bool empty() const { return used_ == 0; }

    /// Claims whole bricks from <= k < to of a column; returns how many were free before.
    int64_t claim_full(int column, int from, int to, uint8_t material) {
        used_ |= uint64_t{1} << column;
        uint32_t* const slots = &table_[size_t(column) * height_];
        uint32_t any = 0;
        for (int k = from; k < to; ++k)
            any |= slots[k];
        if (any == 0) {
            std::fill(slots + from, slots + to, material);
            return int64_t{to - from} * kBrickVoxels;
        }
        int64_t claimed = 0;
        for (int k = from; k < to; ++k) {
            uint32_t& slot = slots[k];
            if (slot == 0) {
                slot = material;
                claimed += kBrickVoxels;
            } else if (slot >= kFirstBrick) {
                Slices all;
                all.fill(~uint64_t{0});
                claimed += claim_in(slot, all, material, nullptr);
            }
        }
        return claimed;
    }

    /// Claims the voxels of `mask` for `material`, or for `cells` (by voxel) where given; returns how many were free.
    /// `was_free`, where given, becomes those.
    int64_t claim(int column, int k, const Slices& mask, uint8_t material, const Cells* cells,
                  Slices* was_free = nullptr) {
        used_ |= uint64_t{1} << column;
        uint32_t& slot = table_[size_t(column) * height_ + k];
        if (was_free != nullptr) {
            const Slices taken = mask_of(slot);
            for (int z = 0; z < kBrickSide; ++z)
                (*was_free)[z] = mask[z] & ~taken[z];
        }
        if (slot != 0)
            return slot < kFirstBrick ? 0 : claim_in(slot, mask, material, cells);
        if (cells == nullptr && is_full(mask)) {
            slot = material;
            return kBrickVoxels;
        }
        slot = uint32_t(bricks_.size()) + kFirstBrick;
        VoxelBrick& brick = bricks_.emplace_back();
        brick.mask = mask;
        brick.material = material;
        if (cells != nullptr) {
            brick.material = 0;
            brick.cells = uint32_t(cells_.size());
            cells_.push_back(*cells);
        }
        return count(mask);
    }

    /// The slots of a column from slot `k` on: a material below kFirstBrick (0 is empty), else kFirstBrick plus the
    /// number of a brick.
    const uint32_t* slots(int column, int k) const { return &table_[size_t(column) * height_ + k]; }
    const VoxelBrick& brick(uint32_t slot) const { return bricks_[slot - kFirstBrick]; }
    size_t bricks() const { return bricks_.size(); }

    /// The solid voxels of a slot.
    Slices mask_of(uint32_t slot) const {
        if (slot >= kFirstBrick)
            return brick(slot).mask;
        Slices all;
        all.fill(slot == 0 ? 0 : ~uint64_t{0});
        return all;
    }

    static constexpr uint32_t kFirstBrick = 256;

    bool column_used(int column) const { return used_ >> column & 1; }
    const Cells& cells(uint32_t row) const { return cells_[row]; }

private:
    int64_t claim_in(uint32_t& slot, const Slices& mask, uint8_t material, const Cells* cells) {
        VoxelBrick& brick = bricks_[slot - kFirstBrick];
        Slices fresh;
        for (int z = 0; z < kBrickSide; ++z)
            fresh[z] = mask[z] & ~brick.mask[z];
        if (is_empty(fresh))
            return 0;
        if (cells != nullptr || brick.cells != kNone || brick.material != material) {
            if (brick.cells == kNone)
                expand(brick);
            Cells& row = cells_[brick.cells];
            for (int z = 0; z < kBrickSide; ++z)
                for (uint64_t left = fresh[z]; left != 0; left &= left - 1) {
                    const int i = z * 64 + std::countr_zero(left);
                    row[i] = cells != nullptr ? (*cells)[i] : material;
                }
        }
        for (int z = 0; z < kBrickSide; ++z)
            brick.mask[z] |= fresh[z];
        if (brick.cells == kNone && is_full(brick.mask))
            slot = brick.material;
        return count(fresh);
    }

    /// Writes a brick's single material out voxel by voxel.
    void expand(VoxelBrick& brick) {
        brick.cells = uint32_t(cells_.size());
        Cells& row = cells_.emplace_back();
        for (int z = 0; z < kBrickSide; ++z)
            for (int i = 0; i < 64; ++i)
                row[z * 64 + i] = brick.mask[z] >> i & 1 ? brick.material : 0;
        brick.material = 0;
    }

    int height_;
    uint64_t used_ = 0; // brick columns that are not empty
    std::vector<uint32_t> table_;
    std::vector<VoxelBrick> bricks_;
    std::vector<Cells> cells_;
};

} // namespace voxrt::voxelize
