// The surface of one object in one tile of columns, before objects compete: shell voxels and crossings.
//
// A tile is kTileSide x kTileSide columns over the grid's whole height. Bricks exist where the surface is; a dense
// table of the tile finds them (4 bytes per slot of a brick) and is cleared entry by entry.
//
// A crossing of a column's ray is one bit in `enters` or `leaves` of the voxel it is marked at. Opposite crossings in a
// voxel cancel; repeated ones go to a list. So the winding number along a column is a running sum of bits.
#pragma once

#include "../grid/brick.h"
#include "covered_bytes.h"
#include "triangle_coverage.h"

#include <vector>

namespace voxrt::voxelize {

inline constexpr int kTileBricks = kTileSide / kBrickSide;
inline constexpr int kTileColumns = kTileBricks * kTileBricks; // brick columns

/// Materials of a brick voxel by voxel: index column_bit(x, y) + 64 z, 0 where empty.
using Cells = std::array<uint8_t, kBrickVoxels>;

inline constexpr uint32_t kNone = 0xFFFF'FFFF;

struct ShellBrick {
    Columns shell{}, enters{}, leaves{};
    uint32_t cells = kNone;       // row of materials where the shell has several
    uint32_t transparent = kNone; // row of voxels with fully transparent surface, where there is some
    uint32_t held = kNone;        // row of voxels that the surface fills under every rule, where there are some
    uint32_t on = kNone;          // row of voxels whose centre lies on a triangle, where volumes may decide instead
    uint32_t undecided = kNone;   // row of voxels that sums of volumes leave undecided, where crossings decide
    uint32_t mixed = kNone;       // row of voxels with surface of another material, where this is wanted
    uint32_t pieces = kNone;      // row of what triangles add to volumes, where it is wanted
    uint8_t material = 0;         // the shell's only material, else 0
    bool crossed = false;         // enters or leaves may hold something
    bool has_repeated = false;    // crossings of this brick are in the list of repeated ones too
    bool has_shell() const { return material != 0 || cells != kNone; }
};

/// What the triangles of a column of a brick add to the volume of a voxel and of all above, by slice; the last slice is
/// the lowest of the brick above.
using VolumePieces = std::array<double, kBrickSide + 1>;

/// Which columns of a brick have pieces, and where these are.
struct PiecesOfBrick {
    PiecesOfBrick() : columns(0) {} // no memory is written of columns without pieces

    uint64_t columns; // by bit
    std::array<uint32_t, 64> rows;
};

/// A crossing whose bit is already set.
struct RepeatedCrossing {
    uint32_t brick;
    uint8_t z, bit;
    bool enters;
};

/// What a triangle adds to volumes in up to eight columns of a tile, from voxel z on.
struct ColumnPieces {
    static constexpr int kLevels = 8;
    int32_t x[8], y[8], z[8], voxels[8];                       // x, y: from the tile's lowest column
    alignas(64) double areas[kLevels][8], volumes[kLevels][8]; // of voxel z + n: at n % kLevels
};

class TileSurface {
public:
    /// For tiles of a grid of `side` voxels.
    explicit TileSurface(int side)
        : side_(side), height_((side + kBrickSide - 1) / kBrickSide), table_(size_t(kTileColumns) * height_, kNone) {}

    int side() const { return side_; }
    int height() const { return height_; }

    /// Forgets the last object; the next one lies in the tile whose lowest column is (x, y).
    void reset(int x, int y) {
        for (uint32_t slot : slots_)
            table_[slot] = kNone;
        slots_.clear();
        bricks_.clear();
        cells_.clear();
        rows_.clear();
        pieces_.clear();
        bricks_with_pieces_.clear();
        repeated_.clear();
        x_ = x;
        y_ = y;
    }

    /// Whether voxels with surface of several materials are noted from now on.
    void note_mixed(bool noted) { notes_mixed_ = noted; }

    /// The material of what is covered from now on, 1 … 255.
    void set_material(uint8_t material) { material_ = material; }

    /// Receives from cover_triangle that voxels lo … hi of column (x, y) are shell. A voxel keeps its first material.
    void cover(int x, int y, int lo, int hi) {
        const Position at_column = locate(x, y);
        for (int k = lo >> kBrickBits; k <= hi >> kBrickBits; ++k) {
            const int from = std::max(lo - k * kBrickSide, 0), end = std::min(hi - k * kBrickSide + 1, kBrickSide);
            add_shell(at(at_column.column, k), at_column.row, uint64_t((1u << end) - (1u << from)) << at_column.shift);
        }
    }

    /// A triangle covers voxels of eight columns, and crosses the surface at some of them, one of a column at most: in
    /// brick `k` of group `group` of row `y` of the tile.
    [[gnu::always_inline]] void add_row(int group, int y, int k, ColumnBytes covered, ColumnBytes crossed,
                                        bool enters) {
        const int column = (y >> kBrickBits) * kTileBricks + group, row = y & (kBrickSide - 1);
        const uint32_t index = table_.data()[size_t(column) * size_t(height_) + size_t(k)];
        if (index == kNone) {
            add_row_slowly(column, k, row, covered, crossed, enters);
            return;
        }
        ShellBrick& brick = bricks_.data()[index];
        uint64_t* const shell = brick.shell.data() + row;
        uint64_t *const entered = brick.enters.data() + row, *const left = brick.leaves.data() + row;
        if (brick.material != material_ || ((*entered | *left) & crossed) != 0) {
            add_row_slowly(column, k, row, covered, crossed, enters);
            return;
        }
        *shell |= covered;
        if (crossed != 0) {
            *(enters ? entered : left) |= crossed;
            brick.crossed = true;
        }
    }

    /// A triangle crosses columns of a row at voxels that it does not cover.
    void cross_row(int group, int y, int k, ColumnBytes crossed, bool enters);

    /// A voxel has fully transparent surface: that alone makes it no shell, and keeps it out of the inside.
    void cover_transparent(int x, int y, int z) {
        const Position at_column = locate(x, y);
        row_of(at(at_column.column, z >> kBrickBits).transparent)[z & (kBrickSide - 1)] |=
            uint64_t{1} << column_bit(x - x_, y - y_);
    }

    /// Receives from find_centres that the centres of voxels lo … hi of column (x, y) lie on the surface.
    void hold(int x, int y, int lo, int hi) {
        for (int z = lo; z <= hi; ++z)
            hold_in_tile(x - x_, y - y_, z);
    }
    /// The same for a voxel; x and y from the tile's lowest column.
    void hold_in_tile(int x, int y, int z);
    /// The same for on_centres().
    void note_on_centre(int x, int y, int z);

    /// Receives from cover_triangle that the ray of column (x, y) crosses the surface at voxel z.
    void cross(int x, int y, int z, bool enters) {
        const Position at_column = locate(x, y);
        add_crossings(at(at_column.column, z >> kBrickBits), at_column.row,
                      uint64_t{1} << (at_column.shift + (z & (kBrickSide - 1))), enters);
    }

    /// Takes note_on_centre() back. As below, x and y are from the tile's lowest column; z may be outside the grid.
    void forget_on_centre(int x, int y, int z);
    /// Sums of volumes leave a voxel undecided where crossings tell of the others.
    void leave_undecided(int x, int y, int z);
    /// Moves a column's only crossing among voxels `first` … `last` to voxel `to`.
    void move_crossing(int x, int y, int first, int last, int to, bool enters);

    /// Receives from add_pieces which columns have pieces.
    bool wants(int) const { return true; }
    bool wants(int, int) const { return true; }
    /// The same for what a triangle adds to the volume of voxel z, and to each above.
    void add_piece(int x, int y, int z, double area, double volume);

    /// The same for voxels z + from … z + to - 1 of the first `count` columns. In a file of its own, as add_row_slowly.
    void add_pieces(const ColumnPieces& columns, int count, int from, int to);

    /// Brick `k` (along z) of a brick column, or null.
    ShellBrick* find(int column, int k) {
        const uint32_t index = table_[size_t(column) * height_ + k];
        return index == kNone ? nullptr : &bricks_[index];
    }

    /// The first k of `from` ... `to` - 1 where the column has a brick, or `to`.
    int next_brick(int column, int from, int to) const {
        const uint32_t* slots = &table_[size_t(column) * height_];
        constexpr int kSlots = 16; // that are looked at together
        for (; from + kSlots <= to; from += kSlots) {
            uint32_t all = kNone;
            for (int i = 0; i < kSlots; ++i)
                all &= slots[from + i];
            if (all != kNone)
                break;
        }
        while (from < to && slots[from] == kNone)
            ++from;
        return from;
    }

    /// Brick `k` of a brick column, made where there is none.
    ShellBrick& at(int column, int k) {
        uint32_t& index = table_[size_t(column) * height_ + k];
        if (index == kNone) {
            index = uint32_t(bricks_.size());
            bricks_.emplace_back();
            slots_.push_back(uint32_t(size_t(column) * height_ + k));
        }
        return bricks_[index];
    }

    bool empty() const { return bricks_.empty(); }
    /// Slots of all bricks: column * height() + k.
    const std::vector<uint32_t>& slots() const { return slots_; }
    const std::vector<RepeatedCrossing>& repeated_crossings() const { return repeated_; }
    uint32_t index_of(const ShellBrick& brick) const { return uint32_t(&brick - bricks_.data()); }
    const Cells& cells(uint32_t row) const { return cells_[row]; }
    const PiecesOfBrick& pieces(uint32_t row) const { return bricks_with_pieces_[row]; }
    const VolumePieces& pieces(const PiecesOfBrick& brick, int bit) const { return pieces_[brick.rows[size_t(bit)]]; }

    /// The voxels of a brick that have surface: its shell, and what is fully transparent.
    Slices all_surface(const ShellBrick& brick, const Slices& shell) const {
        Slices found = shell;
        if (brick.transparent != kNone)
            for (int z = 0; z < kBrickSide; ++z)
                found[z] |= rows_[brick.transparent][z];
        return found;
    }

    /// The voxels of a brick that hold() has received.
    Slices held(const ShellBrick& brick) const { return brick.held == kNone ? Slices{} : rows_[brick.held]; }

    /// The voxels of a brick whose centres lie on triangles that are in sheets.
    Slices on_centres(const ShellBrick& brick) const { return brick.on == kNone ? Slices{} : rows_[brick.on]; }

    /// The voxels of a brick that leave_undecided() has got.
    Slices undecided(const ShellBrick& brick) const {
        return brick.undecided == kNone ? Slices{} : rows_[brick.undecided];
    }

    /// The voxels of a brick with surface of several materials.
    Slices mixed(const ShellBrick& brick) const { return brick.mixed == kNone ? Slices{} : rows_[brick.mixed]; }

private:
    /// The pieces of a column of a brick, made where there are none.
    VolumePieces& pieces_of(ShellBrick& brick, int bit) {
        if (brick.pieces == kNone) {
            brick.pieces = uint32_t(bricks_with_pieces_.size());
            bricks_with_pieces_.emplace_back();
        }
        PiecesOfBrick& own = bricks_with_pieces_[brick.pieces];
        uint32_t& row = own.rows[size_t(bit)];
        if ((own.columns >> bit & 1) == 0) {
            own.columns |= uint64_t{1} << bit;
            row = uint32_t(pieces_.size());
            pieces_.emplace_back();
        }
        return pieces_[row];
    }

    Slices& row_of(uint32_t& row) {
        if (row == kNone) {
            row = uint32_t(rows_.size());
            rows_.emplace_back();
        }
        return rows_[row];
    }

    /// A column of voxels: its brick column, its row there, and where its byte begins.
    struct Position {
        int column, row, shift;
    };
    Position locate(int x, int y) const {
        const int u = x - x_, v = y - y_;
        return {(v >> kBrickBits) * kTileBricks + (u >> kBrickBits), v & (kBrickSide - 1), (u & (kBrickSide - 1)) * 8};
    }

    void add_shell(ShellBrick& brick, int row, ColumnBytes voxels) {
        if (brick.material != material_) {
            if (brick.has_shell())
                add_other_material(brick, row, voxels);
            else
                brick.material = material_;
        }
        brick.shell[row] |= voxels;
    }

    /// What add_row does. In a file of its own: callers are compiled for instructions that the processor may lack.
    void add_row_slowly(int column, int k, int row, ColumnBytes covered, ColumnBytes crossed, bool enters);

    /// The first triangle keeps a voxel: only newly covered ones take the second material of a brick.
    [[gnu::noinline]] void add_other_material(ShellBrick& brick, int row, ColumnBytes voxels) {
        if (brick.cells == kNone) {
            brick.cells = uint32_t(cells_.size());
            Cells& cells = cells_.emplace_back();
            const Slices shell = slices_of(brick.shell);
            for (int z = 0; z < kBrickSide; ++z)
                for (int i = 0; i < 64; ++i)
                    cells[z * 64 + i] = shell[z] >> i & 1 ? brick.material : 0;
            brick.material = 0;
        }
        Cells& cells = cells_[brick.cells];
        for (ColumnBytes fresh = voxels & ~brick.shell[row]; fresh != 0; fresh &= fresh - 1) {
            const int bit = std::countr_zero(fresh);
            cells[(bit & 7) * 64 + row * kBrickSide + (bit >> 3)] = material_;
        }
        for (ColumnBytes again = notes_mixed_ ? voxels & brick.shell[row] : 0; again != 0; again &= again - 1) {
            const int bit = std::countr_zero(again), column = row * kBrickSide + (bit >> 3);
            if (cells[(bit & 7) * 64 + column] != material_)
                row_of(brick.mixed)[bit & 7] |= uint64_t{1} << column;
        }
    }

    /// Rays cross the surface at voxels of a row, one of a column at most.
    void add_crossings(ShellBrick& brick, int row, ColumnBytes voxels, bool enters) {
        ColumnBytes& same = (enters ? brick.enters : brick.leaves)[row];
        ColumnBytes& opposite = (enters ? brick.leaves : brick.enters)[row];
        brick.crossed = true;
        const ColumnBytes cancelled = voxels & opposite;
        opposite ^= cancelled;
        voxels ^= cancelled;
        for (ColumnBytes repeated = voxels & same; repeated != 0; repeated &= repeated - 1) {
            const int bit = std::countr_zero(repeated);
            brick.has_repeated = true;
            repeated_.push_back({index_of(brick), uint8_t(bit & 7), uint8_t(row * kBrickSide + (bit >> 3)), enters});
        }
        same |= voxels;
    }

    int side_, height_;
    int x_ = 0, y_ = 0;
    uint8_t material_ = 0;
    bool notes_mixed_ = false;
    std::vector<uint32_t> table_;
    std::vector<ShellBrick> bricks_;
    std::vector<uint32_t> slots_;
    std::vector<Cells> cells_;
    std::vector<PiecesOfBrick> bricks_with_pieces_;
    std::vector<VolumePieces> pieces_;
    std::vector<Slices> rows_; // of some of a brick's voxels
    std::vector<RepeatedCrossing> repeated_;
};

} // namespace voxrt::voxelize
