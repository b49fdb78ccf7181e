// What is known of a solid's surface in the columns of a tile, so that most voxels need no volume to tell whether half
// of them is filled.
//
// Half of a voxel lies on either side of a plane through its centre. Where all surface in the voxel lies on one side,
// the other half is inside or outside as the centre is. So a voxel with one triangle alone is filled where its centre
// is, and so are most others: there is such a plane where the centre is far enough below or above all triangles.
//
// A column's triangles that face upwards are a sheet, and those that face downwards are one. For each sheet there are
// the least and the greatest height of its planes at each corner of the column. A plane through a voxel's centre, with
// any slopes, is below a sheet where it is below the least heights. Its own height at two opposite corners is that of
// the centre on average. So there is such a plane where the centre is below the average of the least heights at either
// two opposite corners. The same holds above, with the greatest heights. All other voxels are in doubt.
//
// A sheet with two triangles in a column lies along the lower of their planes everywhere, or along the upper one. The
// centre line shows which: it crosses the triangle whose plane is lower there, or the other triangle. In the first case
// no voxel is in doubt whose centre is above the lower plane; in the second, none whose centre is below the upper
// plane.
//
// All that holds where the sheet passes each line of the column once. Edges where it turns back belong to both sheets,
// or stand upright. So all of a column is doubtful where both sheets come near each other, where an upright triangle
// stands, and where the centre line meets a sheet more than once.
//
// Elsewhere the part of a voxel that lies above the sheet grows from voxel to voxel upwards. So one crossing per sheet
// decides the column by half: it moves to the first voxel of which at least half lies above the sheet. That is one of
// the voxels in doubt, or the voxel above all of them. The part of a voxel is the difference of two volumes: those
// above the sheet and below the voxel's top, and below its bottom. Each is a sum over the sheet's triangles.
//
// Where many voxels are in doubt, three near the centre line's crossing are taken. If the lowest of these has a half,
// or the highest has none, the whole column is doubtful.
#pragma once

#include "../grid/brick.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace voxrt::voxelize {

/// Columns x0 ... x1 of rows y0 ... y1 of a tile, or none.
struct ColumnBox {
    int x0, x1, y0, y1;

    uint64_t columns() const { return x0 > x1 ? 0 : ~uint64_t{0} << x0 & ~uint64_t{0} >> (kTileSide - 1 - x1); }
};

/// By sheet: 0 faces upwards, 1 downwards. By row: columns are bits.
struct ColumnSheets {
    using Rows = std::array<uint64_t, kTileSide>;

    static constexpr int kMostVoxels = 3; // in doubt

    /// By corner (x + 2 y) and column, of those with a triangle; half a voxel less: a voxel's centre is at its number.
    alignas(64) float low[2][4][kTileSide * kTileSide], high[2][4][kTileSide * kTileSide];
    /// Heights of planes at the column's centre: of the triangle that the centre line crosses, and of another one.
    alignas(64) float centre[2][kTileSide * kTileSide], other[2][kTileSide * kTileSide];
    std::array<Rows, 2> covered, several; // columns with triangles, and with several
    std::array<Rows, 2> many;             // columns with more than two
    std::array<Rows, 2> crossed, again;   // columns whose centre lines cross triangles, and several
    Rows doubtful;                        // columns where all voxels with surface need volumes
    std::array<Rows, 2> halved;           // other columns with voxels in doubt
    std::array<Rows, 2> guessed;          // of these, where more are in doubt than are taken

    /// By column of `halved`: the first voxel in doubt, how many there are, and the volumes above the sheet that lie
    /// below the bottom of each and the top of the last.
    alignas(64) int32_t first[2][kTileSide * kTileSide], voxels[2][kTileSide * kTileSide];
    alignas(64) double volumes[2][kMostVoxels + 1][kTileSide * kTileSide];

    static bool has_any(const Rows& rows, const ColumnBox& box) {
        uint64_t any = 0;
        for (int y = box.y0; y <= box.y1; ++y)
            any |= rows[size_t(y)];
        return (any & box.columns()) != 0;
    }

    void clear() {
        for (Rows* rows :
             {&covered[0], &covered[1], &several[0], &several[1], &many[0], &many[1], &crossed[0], &crossed[1],
              &again[0], &again[1], &doubtful, &halved[0], &halved[1], &guessed[0], &guessed[1]})
            rows->fill(0);
    }

    /// All columns of a box are doubtful.
    void doubt(const ColumnBox& box) {
        for (int y = box.y0; y <= box.y1; ++y)
            doubtful[size_t(y)] |= box.columns();
    }

    bool has_doubtful() const {
        return std::any_of(doubtful.begin(), doubtful.end(), [](uint64_t row) { return row != 0; });
    }
};

} // namespace voxrt::voxelize
