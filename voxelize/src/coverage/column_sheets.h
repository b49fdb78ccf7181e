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
// two opposite corners. The same holds above, with the greatest heights. All other voxels of the column are doubtful.
//
// That holds where the sheet passes each line of the column once. Edges where it turns back belong to both sheets, or
// stand upright. So both sheets are doubtful where they come near each other, where an upright triangle stands, and
// where the centre line meets a sheet more than once.
#pragma once

#include "../grid/brick.h"

#include <array>
#include <cstdint>

namespace voxrt::voxelize {

/// By sheet: 0 faces upwards, 1 downwards. By row: columns are bits.
struct ColumnSheets {
    using Rows = std::array<uint64_t, kTileSide>;

    /// By corner (x + 2 y) and column, of those with a triangle; half a voxel less: a voxel's centre is at its number.
    alignas(64) double low[2][4][kTileSide * kTileSide], high[2][4][kTileSide * kTileSide];
    std::array<Rows, 2> covered, several; // columns with triangles, and with several
    std::array<Rows, 2> crossed, again;   // columns whose centre lines cross triangles, and several
    Rows doubtful;                        // columns where both sheets need volumes
    std::array<Rows, 2> needed;           // columns whose voxels need volumes

    void clear() {
        for (Rows* rows : {&covered[0], &covered[1], &several[0], &several[1], &crossed[0], &crossed[1], &again[0],
                           &again[1], &doubtful, &needed[0], &needed[1]})
            rows->fill(0);
    }

    /// All columns x0 ... x1 of rows y0 ... y1 of the tile are doubtful.
    void doubt(int x0, int x1, int y0, int y1) {
        for (int y = y0; y <= y1; ++y)
            doubtful[size_t(y)] |= ~uint64_t{0} << x0 & ~uint64_t{0} >> (kTileSide - 1 - x1);
    }
};

} // namespace voxrt::voxelize
