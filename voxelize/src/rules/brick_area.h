// A rectangle of brick columns.
#pragma once

#include "../grid/morton.h"

#include <cstdint>

namespace voxrt::voxelize {

/// Bricks x0 <= x < x1, y0 <= y < y1.
struct BrickArea {
    uint32_t x0, x1, y0, y1;

    /// Whether the brick with a Morton code (of its corner / 8) is in it.
    bool holds(uint64_t code) const {
        const uint32_t x = gather_bits(code), y = gather_bits(code >> 1);
        return x >= x0 && x < x1 && y >= y0 && y < y1;
    }
};

} // namespace voxrt::voxelize
