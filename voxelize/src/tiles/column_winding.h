// The winding numbers of 64 columns at once, as bit planes (bit-sliced counters), swept upwards through the crossings
// of a surface.
//
// A voxel that the surface does not cover lies wholly inside or outside, so the winding number at its column's ray
// decides it. Cost: two word operations per slice and changed bit plane; slices without crossings cost nothing.
#pragma once

#include "../grid/brick.h"

namespace voxrt::voxelize {

class ColumnWinding {
public:
    /// Adds one to the columns of `up`, subtracts one from those of `down`.
    void add(uint64_t up, uint64_t down) {
        for (int i = 0; up != 0 && i < kPlanes; ++i) {
            const uint64_t carry = planes_[i] & up;
            planes_[i] ^= up;
            up = carry;
            used_ = i + 1 > used_ ? i + 1 : used_;
        }
        for (int i = 0; down != 0 && i < kPlanes; ++i) {
            const uint64_t borrow = ~planes_[i] & down;
            planes_[i] ^= down;
            down = borrow;
            used_ = i + 1 > used_ ? i + 1 : used_;
        }
        inside_ = 0;
        for (int i = 0; i < used_; ++i)
            inside_ |= planes_[i];
        if (inside_ == 0)
            used_ = 0;
        const uint64_t sign = planes_[kPlanes - 1];
        positive_ |= inside_ & ~sign;
        negative_ |= inside_ & sign;
        uint64_t beyond = sign & ~planes_[0]; // +1 has no plane above the lowest, -1 has all of them
        for (int i = 1; i < used_; ++i)
            beyond |= planes_[i] ^ sign;
        overlap_ |= beyond;
    }

    /// Columns whose winding number is not zero.
    uint64_t inside() const { return inside_; }

    /// Columns whose winding number is below zero.
    uint64_t below_zero() const { return inside_ & planes_[kPlanes - 1]; }

    /// The winding number of one column.
    int at(int bit) const {
        uint32_t value = 0;
        for (int i = 0; i < used_; ++i)
            value |= uint32_t(planes_[i] >> bit & 1) << i;
        return static_cast<int>(value);
    }

    /// Whether all numbers since construction were 0 and 1, or 0 and -1.
    bool simple() const { return overlap_ == 0 && (positive_ == 0 || negative_ == 0); }

private:
    static constexpr int kPlanes = 32;

    uint64_t planes_[kPlanes] = {};
    uint64_t inside_ = 0;
    int used_ = 0;
    uint64_t positive_ = 0, negative_ = 0, overlap_ = 0;
};

} // namespace voxrt::voxelize
