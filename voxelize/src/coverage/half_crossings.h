// Where sheets (column_sheets.h) cross columns so that what is inside there is inside by half.
#pragma once

#include "column_sheets.h"
#include "tile_surface.h"
#include "volume_pieces.h"

#include <cmath>

namespace voxrt::voxelize {

/// Receiver of add_pieces for a triangle of a sheet: adds to the volumes of the columns with voxels in doubt, or takes
/// pieces in doubtful columns to the surface.
class SheetPieces {
public:
    SheetPieces(ColumnSheets& sheets, bool sheet, bool halves, const Window& window, TileSurface& surface)
        : sheets_(sheets), sheet_(sheet), halves_(halves), columns_(halves ? sheets.halved[sheet] : sheets.doubtful),
          window_(window), surface_(surface) {}
    bool wants(int y) const { return columns_[size_t(y - window_.y0)] != 0; }
    bool wants(int x, int y) const { return columns_[size_t(y - window_.y0)] >> (x - window_.x0) & 1; }
    void add_piece(int x, int y, int z, double area, double volume) {
        if (!halves_) {
            surface_.add_piece(x, y, z, area, volume);
            return;
        }
        const int place = (y - window_.y0) * kTileSide + x - window_.x0;
        for (int n = 0; n <= sheets_.voxels[sheet_][place]; ++n)
            if (const int above = sheets_.first[sheet_][place] + n - z - 1; above >= 0)
                sheets_.volumes[sheet_][n][place] += (sheet_ ? 1 : -1) * (volume + area * above);
    }

private:
    ColumnSheets& sheets_;
    bool sheet_, halves_;
    const ColumnSheets::Rows& columns_;
    const Window& window_;
    TileSurface& surface_;
};

/// Moves the crossings of columns with voxels in doubt. Those whose volumes are nearer to a half than `error` are left
/// undecided. Columns where a guess was wrong become doubtful.
inline void place_half_crossings(ColumnSheets& sheets, double error, TileSurface& surface) {
    const auto place_one = [&](bool sheet, int x, int y) {
        const int place = y * kTileSide + x, first = sheets.first[sheet][place];
        const int end = first + sheets.voxels[sheet][place];
        const auto over = [&](int z) { // how much more than half of a voxel lies above the sheet
            const auto volume = [&](int n) { return sheets.volumes[sheet][n][place]; };
            return volume(z + 1 - first) - volume(z - first) - 0.5;
        };
        if (sheets.guessed[sheet][size_t(y)] >> x & 1 && (over(first) > -error || over(end - 1) < error)) {
            sheets.doubtful[size_t(y)] |= uint64_t{1} << x;
            return;
        }
        int crossing = end;
        for (int z = end - 1; z >= first; --z) {
            const double more = over(z);
            crossing = more > 0 ? z : crossing;
            surface.forget_on_centre(x, y, z);
            if (std::abs(more) < error)
                surface.leave_undecided(x, y, z);
        }
        surface.move_crossing(x, y, first, end, crossing, sheet);
    };
    for (const bool sheet : {false, true})
        for (int y = 0; y < kTileSide; ++y)
            for (uint64_t left = sheets.halved[sheet][size_t(y)]; left != 0; left &= left - 1)
                place_one(sheet, std::countr_zero(left), y);
}

} // namespace voxrt::voxelize
