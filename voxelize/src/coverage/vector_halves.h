// How much of the voxels that are in doubt (column_sheets.h) lies above a triangle, eight columns at a time. A part of
// vector_coverage_body.h.
//
// Cost: 45 operations on eight doubles per edge; eight edges per column.
#pragma once

#include "column_sheets.h"
#include "vector_pieces.h"

namespace voxrt::voxelize {
namespace {

// Which columns a triangle covers, seen along z: its edges as half planes, exact in doubles.
class CoveredColumns {
public:
    CoveredColumns(const double (&x)[3], const double (&y)[3], bool clockwise) {
        for (int i = 0; i < 3; ++i) {
            const int a = clockwise ? 2 - i : i, b = (a + (clockwise ? 2 : 1)) % 3;
            const double u = x[b] - x[a], v = y[b] - y[a];
            // The corner of the column that is furthest inside.
            sides_[i] = {u * kUnit, v * kUnit, (u > 0 ? u * kUnit : 0) - (v < 0 ? v * kUnit : 0) - u * y[a] + v * x[a]};
        }
    }
    bool has(int x, int y) const {
        bool covered = true;
        for (const Side& side : sides_)
            covered &= side.along * y - side.across * x + side.start > 0;
        return covered;
    }

private:
    struct Side {
        double along, across, start;
    };
    Side sides_[3];
};

// Adds to the volumes of a sheet.
class HalvedVoxels {
public:
    HalvedVoxels(const CutTriangle& triangle, ColumnSheets& sheets, bool sheet)
        : triangle_(triangle), sheets_(sheets), sheet_(sheet) {}

    void add_column(int x, int y) {
        const int place = y * kTileSide + x, voxels = sheets_.voxels[sheet_][place];
        x_[count_] = x;
        y_[count_] = y;
        first_[count_] = sheets_.first[sheet_][place];
        most_ = voxels > most_ ? voxels : most_;
        if (++count_ == kLanes)
            finish();
    }

    // Adds the columns that are left.
    void finish() {
        if (count_ == 0)
            return;
        for (int i = count_; i < kLanes; ++i) {
            x_[i] = x_[0];
            y_[i] = y_[0];
            first_[i] = first_[0];
        }
        const CutTriangle::View view = triangle_.seen_from(load_ints(x_), load_ints(y_));
        const Lanes heights = triangle_.heights(view), first = load_ints(first_);
        for (int n = 0; n <= most_; ++n) {
            const Lanes level = first + all(n);
            alignas(64) double volumes[kLanes];
            store(volumes, triangle_.volume_below(triangle_.below(view, level), level - heights));
            for (int i = 0; i < count_; ++i)
                sheets_.volumes[sheet_][n][y_[i] * kTileSide + x_[i]] += sheet_ ? volumes[i] : -volumes[i];
        }
        count_ = most_ = 0;
    }

private:
    const CutTriangle& triangle_;
    ColumnSheets& sheets_;
    bool sheet_;
    int count_ = 0, most_ = 0;
    alignas(32) int32_t x_[kLanes], y_[kLanes], first_[kLanes];
};

} // namespace
} // namespace voxrt::voxelize
