// The voxels of one tile, after the objects have competed: the first in authored order keeps what it claims.
//
// Every brick place of the tile is empty, full of one material, or a brick; the table takes 4 bytes a place (1/128 of a
// byte a voxel) and is cleared column by column.
#pragma once

#include "object_layer.h"

namespace voxrt {

struct OwnedBrick {
    Slices mask{};
    uint32_t cells = kNone; // row of materials where the brick has several
    uint8_t material = 0;   // the only material, else 0
};

class TileVoxels {
public:
    explicit TileVoxels(int side)
        : height_((side + kBrickSide - 1) / kBrickSide), table_(size_t(kTileColumns) * height_, 0) {}

    int height() const { return height_; }

    void clear() {
        for (int column = 0; column < kTileColumns; ++column)
            if (used_ >> column & 1)
                std::fill_n(table_.begin() + size_t(column) * height_, height_, 0u);
        used_ = 0;
        bricks_.clear();
        cells_.clear();
    }

    bool empty() const { return used_ == 0; }

    /// Claims whole bricks from <= k < to of a column; returns how many voxels were free.
    int64_t claim_full(int column, int from, int to, uint8_t material) {
        used_ |= uint64_t{1} << column;
        int64_t claimed = 0;
        for (int k = from; k < to; ++k) {
            uint32_t& place = table_[size_t(column) * height_ + k];
            if (place == 0) {
                place = material;
                claimed += kBrickVoxels;
            } else if (place >= kFirstBrick) {
                Slices all;
                all.fill(~uint64_t{0});
                claimed += claim_in(place, all, material, nullptr);
            }
        }
        return claimed;
    }

    /// Claims the voxels of `mask` for `material`, or for `cells` (by voxel) where given; returns how many were free.
    int64_t claim(int column, int k, const Slices& mask, uint8_t material, const Cells* cells) {
        used_ |= uint64_t{1} << column;
        uint32_t& place = table_[size_t(column) * height_ + k];
        if (place != 0)
            return place < kFirstBrick ? 0 : claim_in(place, mask, material, cells);
        if (cells == nullptr && is_full(mask)) {
            place = material;
            return kBrickVoxels;
        }
        place = uint32_t(bricks_.size()) + kFirstBrick;
        OwnedBrick& brick = bricks_.emplace_back();
        brick.mask = mask;
        brick.material = material;
        if (cells != nullptr) {
            brick.material = 0;
            brick.cells = uint32_t(cells_.size());
            cells_.push_back(*cells);
        }
        return count(mask);
    }

    /// What stands at the places of a column from place `k` on: a material below kFirstBrick (0 is empty), else
    /// kFirstBrick plus the number of a brick.
    const uint32_t* places(int column, int k) const { return &table_[size_t(column) * height_ + k]; }
    const OwnedBrick& brick(uint32_t place) const { return bricks_[place - kFirstBrick]; }

    static constexpr uint32_t kFirstBrick = 256;

    bool column_used(int column) const { return used_ >> column & 1; }
    const Cells& cells(uint32_t row) const { return cells_[row]; }

private:
    int64_t claim_in(uint32_t& place, const Slices& mask, uint8_t material, const Cells* cells) {
        OwnedBrick& brick = bricks_[place - kFirstBrick];
        Slices fresh;
        for (int z = 0; z < kBrickSide; ++z)
            fresh[z] = mask[z] & ~brick.mask[z];
        if (is_empty(fresh))
            return 0;
        if (cells != nullptr || brick.cells != kNone || brick.material != material) {
            if (brick.cells == kNone)
                spread(brick);
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
            place = brick.material;
        return count(fresh);
    }

    /// Writes a brick's one material out voxel by voxel.
    void spread(OwnedBrick& brick) {
        brick.cells = uint32_t(cells_.size());
        Cells& row = cells_.emplace_back();
        for (int z = 0; z < kBrickSide; ++z)
            for (int i = 0; i < 64; ++i)
                row[z * 64 + i] = brick.mask[z] >> i & 1 ? brick.material : 0;
        brick.material = 0;
    }

    int height_;
    uint64_t used_ = 0; // brick columns that hold something
    std::vector<uint32_t> table_;
    std::vector<OwnedBrick> bricks_;
    std::vector<Cells> cells_;
};

} // namespace voxrt
