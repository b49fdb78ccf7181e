// Sheets (column_sheets.h), eight columns at a time. A part of vector_coverage_body.h.
//
// Cost, in operations on eight numbers: 60 per row of a triangle and eight columns, 60 per sheet and eight columns.
#pragma once

#include "../vectors/floats.h"
#include "column_sheets.h"
#include "vector_plane.h"

namespace voxrt::voxelize {
namespace {

// How far heights of a sheet are wrong by rounding, per the greatest of them.
constexpr float kSheetError = 0x1p-21F;

// Notes that a triangle covers and crosses columns of a row. Returns those that its sheet had before.
inline uint64_t extend_row(ColumnSheets& sheets, bool enters, int y, uint64_t covered, uint64_t crossed) {
    const auto row = static_cast<size_t>(y);
    const uint64_t before = sheets.covered[enters][row];
    sheets.many[enters][row] |= sheets.several[enters][row] & covered;
    sheets.several[enters][row] |= before & covered;
    sheets.covered[enters][row] = before | covered;
    sheets.again[enters][row] |= sheets.crossed[enters][row] & crossed;
    sheets.crossed[enters][row] |= crossed;
    return before;
}

// Takes the heights of a triangle's plane in eight columns into its sheet. `centres`: at their centres; `before`: which
// columns had some; `crossed`: whose centre lines cross the triangle; slopes: half of z per x, and per y.
inline void extend_group(ColumnSheets& sheets, bool enters, int place, uint64_t covered, uint64_t before,
                         uint64_t crossed, const Floats& centres, double half_slope_x, double half_slope_y) {
    const auto had = static_cast<Mask>(before & covered), has = static_cast<Mask>(covered);
    for (int corner = 0; corner < 4; ++corner) {
        const double rise =
            (corner % 2 == 0 ? -half_slope_x : half_slope_x) + (corner < 2 ? -half_slope_y : half_slope_y);
        const Floats height = centres + all_floats(static_cast<float>(rise));
        float *const low = &sheets.low[enters][corner][place], *const high = &sheets.high[enters][corner][place];
        const Floats old_low = load_floats(low), old_high = load_floats(high);
        store(low, choose(has, choose(had, smaller(height, old_low), height), old_low));
        store(high, choose(has, choose(had, larger(height, old_high), height), old_high));
    }
    float *const centre = &sheets.centre[enters][place], *const other = &sheets.other[enters][place];
    store(centre, choose(static_cast<Mask>(covered & crossed), centres, load_floats(centre)));
    store(other, choose(static_cast<Mask>(covered & ~crossed), centres, load_floats(other)));
}

// Eight columns of a sheet.
struct EightOfSheet {
    Lanes from, to;    // between these, heights may be in doubt
    Lanes bottom, top; // one below where the sheet may be, and one above
    Lanes error;       // of heights

    EightOfSheet(const ColumnSheets& sheets, int sheet, int place) {
        const auto low = [&](int corner) { return load(&sheets.low[sheet][corner][place]); };
        const auto high = [&](int corner) { return load(&sheets.high[sheet][corner][place]); };
        const Lanes least = smaller(smaller(low(0), low(3)), smaller(low(1), low(2)));
        const Lanes most = larger(larger(high(0), high(3)), larger(high(1), high(2)));
        error = larger(all(0) - least, most) * all(double{kSheetError});
        bottom = least - error - all(1);
        top = most + error + all(1);
        from = smaller(low(0) + low(3), low(1) + low(2)) * all(0.5) - error;
        to = larger(high(0) + high(3), high(1) + high(2)) * all(0.5) + error;
    }
};

// Eight columns' voxels in doubt, along z.
struct EightDoubts {
    Lanes first, last;
    Mask doubted, guessed; // columns with some, and with too many

    // `two`: columns with two triangles.
    EightDoubts(const ColumnSheets& sheets, int sheet, int place, const EightOfSheet& eight, Mask two, int top) {
        const Lanes half = all(0.5 - 0x1p-20), one = all(1), none = all(0);
        const Lanes centre = load(&sheets.centre[sheet][place]), away = load(&sheets.other[sheet][place]) - centre;
        const Mask lower = two & less(eight.error + eight.error, away);
        const Mask higher = two & less(eight.error + eight.error, none - away);
        first = nearest_whole(choose(higher, centre - eight.error, eight.from) + half);
        last = nearest_whole(choose(lower, centre + eight.error, eight.to) - half);
        guessed = static_cast<Mask>(~less(last - first, all(ColumnSheets::kMostVoxels)));
        first = choose(guessed, nearest_whole(centre) - one, first);
        last = choose(guessed, nearest_whole(centre) + one, last);
        doubted = static_cast<Mask>(~less(last, first) & less(all(-1), last) & less(first, all(top + 1)));
        first = larger(smaller(first, all(kBeyond)), all(-kBeyond)); // all fit 32 bits
        last = larger(smaller(last, all(kBeyond)), all(-kBeyond));
    }
};

// Finds which voxels are in doubt.
void find_doubts(ColumnSheets& sheets, int top) {
    for (int y = 0; y < kTileSide; ++y) {
        const auto row = static_cast<size_t>(y);
        const uint64_t both = sheets.covered[0][row] & sheets.covered[1][row];
        uint64_t doubtful = sheets.doubtful[row], doubted[2] = {}, guessed[2] = {};
        for (size_t sheet = 0; sheet < 2; ++sheet)
            doubtful |= sheets.again[sheet][row] | (sheets.covered[sheet][row] & ~sheets.crossed[sheet][row]);
        for (int group = 0; group < kTileSide / kLanes; ++group) {
            const int shift = group * kLanes, place = y * kTileSide + shift;
            uint64_t wild = 0;
            Lanes bottoms[2] = {all(0), all(0)}, tops[2] = {all(0), all(0)};
            for (int sheet = 0; sheet < 2; ++sheet) {
                const uint64_t covered = sheets.covered[sheet][row] >> shift & 0xFF;
                if (covered == 0)
                    continue;
                const EightOfSheet eight(sheets, sheet, place);
                wild |= covered & less(all(top + 1.5 + 0x1p-10), eight.top);
                bottoms[sheet] = eight.bottom;
                tops[sheet] = eight.top;
                const uint64_t several = sheets.several[sheet][row] & ~doubtful;
                if ((several >> shift & 0xFF) == 0)
                    continue;
                const auto two = static_cast<Mask>(several >> shift & ~(sheets.many[sheet][row] >> shift));
                const EightDoubts doubts(sheets, sheet, place, eight, two, top);
                doubted[sheet] |= several & uint64_t{doubts.doubted} << shift;
                guessed[sheet] |= uint64_t{doubts.guessed} << shift;
                store_as_int(&sheets.first[sheet][place], doubts.first);
                store_as_int(&sheets.voxels[sheet][place], doubts.last - doubts.first + all(1));
                for (auto& volumes : sheets.volumes[sheet])
                    store(&volumes[place], all(0));
            }
            if (const uint64_t here = both >> shift & 0xFF; here != 0)
                wild |= here & ~uint64_t{static_cast<Mask>(less(tops[0], bottoms[1]) | less(tops[1], bottoms[0]))};
            doubtful |= wild << shift;
        }
        sheets.doubtful[row] = doubtful;
        for (size_t sheet = 0; sheet < 2; ++sheet) {
            sheets.halved[sheet][row] = doubted[sheet] & ~doubtful;
            sheets.guessed[sheet][row] = guessed[sheet];
        }
    }
}

} // namespace
} // namespace voxrt::voxelize
