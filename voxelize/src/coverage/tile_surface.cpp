#include "tile_surface.h"

#include "../rules/rule.h"

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

void TileSurface::note_on_centre(int x, int y, int z) {
    const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits);
    row_of(at(column, z >> kBrickBits).on)[z & (kBrickSide - 1)] |= uint64_t{1} << column_bit(x, y);
}

void TileSurface::add_piece(int x, int y, int z, double area, double volume) {
    const int slice = z & (kBrickSide - 1), bit = column_bit(x - x_, y - y_);
    double* const slices = pieces_at(locate(x, y).column, z >> kBrickBits).column(bit) + slice;
    slices[0] += volume;
    slices[1] += area - volume;
}

void TileSurface::add_pieces(const ColumnPieces& columns, int count, int from, int to) {
    for (int i = 0; i < count; ++i) {
        const int x = columns.x[i], y = columns.y[i], end = columns.z[i] + std::min(to, columns.voxels[i]);
        const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits), bit = column_bit(x, y);
        for (int z = columns.z[i] + from, level = 0; z < end;) {
            const int slice = z & (kBrickSide - 1), count_here = std::min(end - z, kBrickSide - slice);
            ShellBrick& brick = this->at(column, z >> kBrickBits);
            if (notes_asked_)
                for (uint64_t *row = &row_of(brick.asked)[size_t(slice)], *last = row + count_here; row != last; ++row)
                    *row |= uint64_t{1} << bit;
            double* at = pieces_of(brick).column(bit) + slice;
            for (z += count_here; level < z - columns.z[i] - from; ++level, ++at) {
                const double volume = columns.volumes[level][i];
                at[0] += volume;
                at[1] += columns.areas[level][i] - volume;
            }
        }
    }
}

} // namespace voxrt::voxelize
