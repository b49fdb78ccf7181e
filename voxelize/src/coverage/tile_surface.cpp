#include "tile_surface.h"

namespace voxrt::voxelize {

void TileSurface::add_row_slowly(int column, int k, int row, ColumnBytes covered, ColumnBytes crossed, bool enters) {
    ShellBrick& brick = at(column, k);
    add_shell(brick, row, covered);
    if (crossed != 0)
        add_crossings(brick, row, crossed, enters);
}

void TileSurface::cross_row(int group, int y, int k, ColumnBytes crossed, bool enters) {
    add_crossings(at((y >> kBrickBits) * kTileBricks + group, k), y & (kBrickSide - 1), crossed, enters);
}

void TileSurface::hold_in_tile(int x, int y, int z) {
    const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits);
    row_of(at(column, z >> kBrickBits).held)[z & (kBrickSide - 1)] |= uint64_t{1} << column_bit(x, y);
}

void TileSurface::add_pieces(const ColumnPieces& columns, int count, int n) {
    for (int i = 0; i < count; ++i)
        if (n < columns.voxels[i])
            add_piece(x_ + columns.x[i], y_ + columns.y[i], columns.z[i] + n, columns.areas[i], columns.volumes[i]);
}

} // namespace voxrt::voxelize
