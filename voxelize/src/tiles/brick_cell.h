// A cube of voxels in a brick, and regions of voxels in it.
#pragma once

#include "../grid/brick.h"

namespace voxrt::voxelize {

struct BrickCell {
    int x, y, z, side; // in the brick
};

inline constexpr uint64_t kFirstColumn = 0x0101'0101'0101'0101; // x = 0

/// The columns of a cell.
inline uint64_t square_of(const BrickCell& cell) {
    // A byte per row of columns.
    const uint64_t rows = ~uint64_t{0} >> 8 * (kBrickSide - cell.side) & kFirstColumn * ((1 << cell.side) - 1);
    return rows << column_bit(cell.x, cell.y);
}

/// The columns of a slice beside those of `columns`, along x (axis 0) or y (axis 1).
inline uint64_t beside_columns(uint64_t columns, int axis) {
    if (axis == 1)
        return columns << kBrickSide | columns >> kBrickSide;
    return (columns & ~(kFirstColumn << (kBrickSide - 1))) << 1 | (columns & ~kFirstColumn) >> 1;
}

/// Adds the voxels of `free` in a cell that are reached from `region` through common sides.
inline void grow(Slices& region, const Slices& free, const BrickCell& cell) {
    for (bool grown = true; grown;) {
        grown = false;
        for (int z = cell.z; z < cell.z + cell.side; ++z) {
            uint64_t next =
                region[z] | (z > cell.z ? region[z - 1] : 0) | (z + 1 < cell.z + cell.side ? region[z + 1] : 0);
            next |= beside_columns(next, 0) | beside_columns(next, 1);
            next &= free[z];
            grown = grown || next != region[z];
            region[z] = next;
        }
    }
}

} // namespace voxrt::voxelize
