// Sheets (column_sheets.h), eight columns at a time. A part of vector_coverage_body.h.
//
// Cost, in operations on eight doubles: 35 per row of a triangle and eight columns, 30 per sheet and eight columns.
#pragma once

#include "../vectors/lanes.h"
#include "column_sheets.h"
#include "vector_plane.h"

namespace voxrt::voxelize {
namespace {

// Heights of sheets are wrong by rounding, in voxels per slope: below 2^17 voxels, with errors of a few 2^-53.
constexpr double kSheetError = 0x1p-30;

// Notes that a triangle covers and crosses columns of a row. Returns those that its sheet had before.
inline uint64_t extend_row(ColumnSheets& sheets, bool enters, int y, uint64_t covered, uint64_t crossed) {
    const auto row = static_cast<size_t>(y);
    const uint64_t before = sheets.covered[enters][row];
    sheets.several[enters][row] |= before & covered;
    sheets.covered[enters][row] = before | covered;
    sheets.again[enters][row] |= sheets.crossed[enters][row] & crossed;
    sheets.crossed[enters][row] |= crossed;
    return before;
}

// Takes the heights of a triangle's plane in eight columns into its sheet. `heights`: at the columns' centres;
// `before`: which columns had some; slopes: half of z per x, and per y.
inline void extend_group(ColumnSheets& sheets, bool enters, int place, uint64_t covered, uint64_t before,
                         const Lanes& heights, double half_slope_x, double half_slope_y) {
    const auto had = static_cast<Mask>(before & covered), has = static_cast<Mask>(covered);
    for (int corner = 0; corner < 4; ++corner) {
        const Lanes height = heights + all((corner % 2 == 0 ? -half_slope_x : half_slope_x) +
                                           (corner < 2 ? -half_slope_y : half_slope_y));
        double *const low = &sheets.low[enters][corner][place], *const high = &sheets.high[enters][corner][place];
        const Lanes old_low = load(low), old_high = load(high);
        store(low, choose(has, choose(had, smaller(height, old_low), height), old_low));
        store(high, choose(has, choose(had, larger(height, old_high), height), old_high));
    }
}

// Eight columns of a sheet.
struct EightOfSheet {
    Lanes middle, reach; // heights that may be doubtful are that far from the middle
    Lanes bottom, top;   // one below where the sheet may be, and one above

    EightOfSheet(const ColumnSheets& sheets, int sheet, int place) {
        const auto low = [&](int corner) { return load(&sheets.low[sheet][corner][place]); };
        const auto high = [&](int corner) { return load(&sheets.high[sheet][corner][place]); };
        const Lanes from = smaller(low(0) + low(3), low(1) + low(2)), to = larger(high(0) + high(3), high(1) + high(2));
        bottom = smaller(smaller(low(0), low(3)), smaller(low(1), low(2))) - all(1);
        top = larger(larger(high(0), high(3)), larger(high(1), high(2))) + all(1);
        middle = (from + to) * all(0.25);
        reach = (to - from) * all(0.25) + (top - bottom) * all(kSheetError);
    }
    // Columns without a voxel whose centre may be within reach.
    Mask decided() const {
        const Lanes from = middle - nearest_whole(middle);
        return less(reach, larger(from, all(0) - from));
    }
};

void find_needed(ColumnSheets& sheets, int top) {
    for (int y = 0; y < kTileSide; ++y) {
        const auto row = static_cast<size_t>(y);
        const uint64_t both = sheets.covered[0][row] & sheets.covered[1][row];
        uint64_t doubtful = sheets.doubtful[row], needed[2] = {};
        for (size_t sheet = 0; sheet < 2; ++sheet)
            doubtful |= sheets.again[sheet][row] | (sheets.covered[sheet][row] & ~sheets.crossed[sheet][row]);
        for (int group = 0; group < kTileSide / kLanes; ++group) {
            const int shift = group * kLanes;
            uint64_t wild = 0;
            Lanes bottoms[2] = {all(0), all(0)}, tops[2] = {all(0), all(0)};
            for (int sheet = 0; sheet < 2; ++sheet) {
                const uint64_t covered = sheets.covered[sheet][row] >> shift & 0xFF;
                if (covered == 0)
                    continue;
                const EightOfSheet eight(sheets, sheet, y * kTileSide + shift);
                needed[sheet] |= (sheets.several[sheet][row] >> shift & 0xFF & ~uint64_t{eight.decided()}) << shift;
                wild |= covered & less(all(top + 1.5 + 0x1p-10), eight.top);
                bottoms[sheet] = eight.bottom;
                tops[sheet] = eight.top;
            }
            if (const uint64_t here = both >> shift & 0xFF; here != 0)
                wild |= here & ~uint64_t{static_cast<Mask>(less(tops[0], bottoms[1]) | less(tops[1], bottoms[0]))};
            doubtful |= wild << shift;
        }
        sheets.doubtful[row] = doubtful;
        for (size_t sheet = 0; sheet < 2; ++sheet)
            sheets.needed[sheet][row] = needed[sheet] | doubtful;
    }
}

} // namespace
} // namespace voxrt::voxelize
