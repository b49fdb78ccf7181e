// What one object covers in one tile of columns, before objects compete: shell bricks and the crossings of its surface.
//
// A tile is kTileSide x kTileSide columns over the grid's whole height. Bricks exist where the surface is; they are
// found through a dense table of the tile (4 bytes a brick place), which is cleared entry by entry.
//
// A crossing of a column's ray is one bit in `enters` or `leaves` of the voxel it is marked at; opposite crossings in
// a voxel cancel, repeated ones spill into a list. So the winding number along a column is a running sum of bits.
#pragma once

#include "brick.h"
#include "triangle_coverage.h"

#include <vector>

namespace voxrt {

inline constexpr int kTileBricks = kTileSide / kBrickSide;
inline constexpr int kTileColumns = kTileBricks * kTileBricks; // brick columns

/// Materials of a brick voxel by voxel: index column_bit(x, y) + 64 z, 0 where empty.
using Cells = std::array<uint8_t, kBrickVoxels>;

inline constexpr uint32_t kNone = 0xFFFF'FFFF;

struct ShellBrick {
    Columns shell{}, enters{}, leaves{};
    uint32_t cells = kNone; // row of materials where the shell has several
    uint32_t cuts = kNone;  // row of voxels that surface without material is in
    uint8_t material = 0;   // the shell's only material, else 0
    bool crossed = false;   // enters or leaves may hold something
    bool has_spill = false; // crossings of this brick are in the layer's list too
    bool has_shell() const { return material != 0 || cells != kNone; }
};

struct Spill {
    uint32_t brick;
    uint8_t z, bit;
    bool enters;
};

class ObjectLayer {
public:
    /// A layer for tiles of a grid of `side` voxels.
    explicit ObjectLayer(int side)
        : side_(side), height_((side + kBrickSide - 1) / kBrickSide), table_(size_t(kTileColumns) * height_, kNone) {}

    int side() const { return side_; }
    int height() const { return height_; }

    /// Forgets the last object; the next one lies in the tile whose lowest column is (x, y).
    void start(int x, int y) {
        for (uint32_t place : places_)
            table_[place] = kNone;
        places_.clear();
        bricks_.clear();
        cells_.clear();
        cuts_.clear();
        spills_.clear();
        x_ = x;
        y_ = y;
    }

    void set_material(uint8_t material) { material_ = material; }

    /// Sink of cover_triangle.
    void cover(int x, int y, int lo, int hi) {
        const auto [column, bit] = locate(x, y);
        for (int k = lo >> kBrickBits; k <= hi >> kBrickBits; ++k) {
            ShellBrick& brick = at(column, k);
            const int from = std::max(lo - k * kBrickSide, 0), to = std::min(hi - k * kBrickSide, kBrickSide - 1);
            const uint8_t interval = column_interval(from, to);
            if (brick.material != material_) {
                if (brick.material != 0 || brick.cells != kNone)
                    cover_mixed(brick, interval, bit);
                else
                    brick.material = material_;
            }
            brick.shell[bit] |= interval;
        }
    }

    /// Takes note of surface that has no material: it is no shell, but what it is in is not inside either.
    void cut(int x, int y, int z) {
        const auto [column, bit] = locate(x, y);
        ShellBrick& brick = at(column, z >> kBrickBits);
        if (brick.cuts == kNone) {
            brick.cuts = uint32_t(cuts_.size());
            cuts_.emplace_back();
        }
        cuts_[brick.cuts][bit] |= uint8_t(1 << (z & (kBrickSide - 1)));
    }

    /// Sink of cover_triangle.
    void cross(int x, int y, int z, bool enters) {
        const auto [column, bit] = locate(x, y);
        ShellBrick& brick = at(column, z >> kBrickBits);
        const int slice = z & (kBrickSide - 1);
        const auto one = uint8_t(1 << slice);
        Columns& same = enters ? brick.enters : brick.leaves;
        Columns& opposite = enters ? brick.leaves : brick.enters;
        brick.crossed = true;
        if (opposite[bit] & one) {
            opposite[bit] ^= one;
        } else if (same[bit] & one) {
            brick.has_spill = true;
            spills_.push_back({uint32_t(&brick - bricks_.data()), uint8_t(slice), uint8_t(bit), enters});
        } else {
            same[bit] |= one;
        }
    }

    /// Brick `k` (along z) of a brick column, or null.
    ShellBrick* find(int column, int k) {
        const uint32_t index = table_[size_t(column) * height_ + k];
        return index == kNone ? nullptr : &bricks_[index];
    }

    ShellBrick& at(int column, int k) {
        uint32_t& index = table_[size_t(column) * height_ + k];
        if (index == kNone) {
            index = uint32_t(bricks_.size());
            bricks_.emplace_back();
            places_.push_back(uint32_t(size_t(column) * height_ + k));
        }
        return bricks_[index];
    }

    bool empty() const { return bricks_.empty(); }
    const std::vector<uint32_t>& places() const { return places_; }
    const std::vector<Spill>& spills() const { return spills_; }
    uint32_t index_of(const ShellBrick& brick) const { return uint32_t(&brick - bricks_.data()); }
    const Cells& cells(uint32_t row) const { return cells_[row]; }

    /// The voxels of a brick that surface is in, its shell and what is cut away.
    Slices surface(const ShellBrick& brick, const Slices& shell) const {
        Slices found = shell;
        if (brick.cuts != kNone) {
            const Slices cut = slices_of(cuts_[brick.cuts]);
            for (int z = 0; z < kBrickSide; ++z)
                found[z] |= cut[z];
        }
        return found;
    }

private:
    struct Place {
        int column, bit;
    };
    Place locate(int x, int y) const {
        const int u = x - x_, v = y - y_;
        return {(v >> kBrickBits) * kTileBricks + (u >> kBrickBits), column_bit(u, v)};
    }

    /// The first triangle keeps a voxel: only newly covered ones take the second material of a brick.
    void cover_mixed(ShellBrick& brick, uint8_t interval, int bit) {
        if (brick.cells == kNone) {
            brick.cells = uint32_t(cells_.size());
            Cells& row = cells_.emplace_back();
            for (int z = 0; z < kBrickSide; ++z)
                for (int i = 0; i < 64; ++i)
                    row[z * 64 + i] = brick.shell[i] >> z & 1 ? brick.material : 0;
            brick.material = 0;
        }
        Cells& row = cells_[brick.cells];
        for (uint32_t fresh = interval & ~uint32_t{brick.shell[bit]}; fresh != 0; fresh &= fresh - 1)
            row[std::countr_zero(fresh) * 64 + bit] = material_;
    }

    int side_, height_;
    int x_ = 0, y_ = 0;
    uint8_t material_ = 0;
    std::vector<uint32_t> table_;
    std::vector<ShellBrick> bricks_;
    std::vector<uint32_t> places_;
    std::vector<Cells> cells_;
    std::vector<Columns> cuts_;
    std::vector<Spill> spills_;
};

} // namespace voxrt
