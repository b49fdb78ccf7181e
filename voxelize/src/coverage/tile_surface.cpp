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

void TileSurface::forget_on_centre(int x, int y, int z) {
    const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits);
    const ShellBrick* brick = z >= 0 && z < side_ ? find(column, z >> kBrickBits) : nullptr;
    if (brick != nullptr && brick->on != kNone)
        rows_[brick->on][z & (kBrickSide - 1)] &= ~(uint64_t{1} << column_bit(x, y));
}

void TileSurface::leave_undecided(int x, int y, int z) {
    const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits);
    if (z >= 0 && z < side_)
        row_of(at(column, z >> kBrickBits).undecided)[z & (kBrickSide - 1)] |= uint64_t{1} << column_bit(x, y);
}

void TileSurface::move_crossing(int x, int y, int first, int last, int to, bool enters) {
    const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits), row = y & (kBrickSide - 1);
    const auto crossings = [&](ShellBrick& brick) -> ColumnBytes& {
        return (enters ? brick.enters : brick.leaves)[row];
    };
    const auto voxel = [&](int z) { return ColumnBytes{1} << ((x & (kBrickSide - 1)) * 8 + (z & (kBrickSide - 1))); };
    for (int z = std::max(first, 0); z <= std::min(last, side_ - 1); ++z)
        if (ShellBrick* brick = find(column, z >> kBrickBits))
            crossings(*brick) &= ~voxel(z);
    to = std::max(to, 0);
    if (to >= side_)
        return;
    ShellBrick& brick = at(column, to >> kBrickBits);
    crossings(brick) |= voxel(to);
    brick.crossed = true;
}

void TileSurface::add_piece(int x, int y, int z, double area, double volume) {
    const int slice = z & (kBrickSide - 1), bit = column_bit(x - x_, y - y_);
    double* const slices = &pieces_of(at(locate(x, y).column, z >> kBrickBits), bit)[size_t(slice)];
    slices[0] += volume;
    slices[1] += area - volume;
}

void TileSurface::add_pieces(const ColumnPieces& columns, int count, int from, int to) {
    for (int i = 0; i < count; ++i) {
        const int x = columns.x[i], y = columns.y[i], end = columns.z[i] + std::min(to, columns.voxels[i]);
        const int column = (y >> kBrickBits) * kTileBricks + (x >> kBrickBits), bit = column_bit(x, y);
        for (int z = columns.z[i] + from, level = 0; z < end;) {
            const int slice = z & (kBrickSide - 1), count_here = std::min(end - z, kBrickSide - slice);
            double* at = &pieces_of(this->at(column, z >> kBrickBits), bit)[size_t(slice)];
            for (z += count_here; level < z - columns.z[i] - from; ++level, ++at) {
                const double volume = columns.volumes[level][i];
                at[0] += volume;
                at[1] += columns.areas[level][i] - volume;
            }
        }
    }
}

} // namespace voxrt::voxelize
