#include "tile_surface.h"

namespace voxrt::voxelize {

void TileSurface::add_row_slowly(int column, int k, int row, ColumnBytes covered, ColumnBytes crossed, bool enters) {
    ShellBrick& brick = at(column, k);
    add_shell(brick, row, covered);
    if (crossed != 0)
        add_crossings(brick, row, crossed, enters);
}

void TileSurface::add_pieces(const ColumnPieces& columns, int count, int n) {
    for (int i = 0; i < count; ++i)
        if (n < columns.voxels[i])
            add_piece(x_ + columns.x[i], y_ + columns.y[i], columns.z[i] + n, columns.areas[i], columns.volumes[i]);
}

} // namespace voxrt::voxelize
