#include "tile_surface.h"

namespace voxrt::voxelize {

void TileSurface::add_row_slowly(int column, int k, int row, ColumnBytes covered, ColumnBytes crossed, bool enters) {
    ShellBrick& brick = at(column, k);
    add_shell(brick, row, covered);
    if (crossed != 0)
        add_crossings(brick, row, crossed, enters);
}

} // namespace voxrt::voxelize
