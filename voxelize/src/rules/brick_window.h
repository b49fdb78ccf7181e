// A brick with a margin of its neighbours, as rows of bits along x: what operations on neighbourhoods take.
#pragma once

#include "../grid/brick.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace voxrt::voxelize {

/// 16 voxels per side: the brick, `margin` voxels of its neighbours at each side, and beyond these at most more of
/// them. Voxel (x, y, z) of the brick is bit x + 4 of row (y, z).
template <int margin> class BrickWindow {
public:
    static_assert(margin >= 1 && margin <= 3);
    static constexpr int kFirst = 4; // the bit of x = 0

    uint16_t& row(int y, int z) { return rows_[size_t((z + kFirst) * kPlane + y + kFirst)]; }
    uint16_t row(int y, int z) const { return rows_[size_t((z + kFirst) * kPlane + y + kFirst)]; }

    /// The 3 x 3 x 3 bricks around: `bricks[i]`, i = x + 3 y + 9 z, each 0 … 2.
    void gather(const std::array<const Slices*, 27>& bricks) {
        for (int z = -margin; z < kBrickSide + margin; ++z) {
            const Slices* const* plane = &bricks[size_t(z < 0 ? 0 : z < kBrickSide ? 9 : 18)];
            Eight parts[3];
            for (int part = 0; part < 3; ++part) {
                auto of = [&](int x) { return eight_of((*plane[3 * part + x])[size_t(z & 7)]); };
                parts[part] = of(0) >> (kBrickSide - margin) << (kFirst - margin) | of(1) << kFirst |
                              (of(2) & ((1 << margin) - 1)) << (kFirst + kBrickSide);
            }
            uint16_t* const to = &row(0, z);
            std::memcpy(to - kFirst, reinterpret_cast<const uint16_t*>(&parts[0]) + kFirst, kFirst * sizeof *to);
            std::memcpy(to, &parts[1], sizeof parts[1]);
            std::memcpy(to + kBrickSide, &parts[2], kFirst * sizeof *to);
        }
    }

    /// The brick without its margin.
    Slices middle() const {
        Slices found{};
        for (int z = 0; z < kBrickSide; ++z)
            for (int y = 0; y < kBrickSide; ++y)
                found[z] |= uint64_t(row(y, z) >> kFirst & 0xFF) << kBrickSide * y;
        return found;
    }

    /// Adds the 26 neighbours of each voxel.
    void dilate() {
        each([](const uint16_t* r) { return at(r) | at(r) << 1 | at(r) >> 1; });
        each([](const uint16_t* r) { return at(r) | at(r + 1) | at(r - 1); });
        each([](const uint16_t* r) { return at(r) | at(r + kPlane) | at(r - kPlane); });
    }

    /// Leaves the voxels of cubes of 2 x 2 x 2 voxels of the set, and adds the 26 neighbours of each. The margin is not
    /// right afterwards.
    void keep_near_cubes() {
        static_assert(margin == 2);
        each([](const uint16_t* r) { return at(r) & at(r) >> 1; });
        each([](const uint16_t* r) { return at(r) & at(r + 1); });
        each([](const uint16_t* r) { return at(r) & at(r + kPlane); });
        each([](const uint16_t* r) { return at(r) >> 1 | at(r) | at(r) << 1 | at(r) << 2; });
        each([](const uint16_t* r) { return at(r - 2) | at(r - 1) | at(r) | at(r + 1); });
        each<0>([](const uint16_t* r) { return at(r - 2 * kPlane) | at(r - kPlane) | at(r) | at(r + kPlane); });
    }

private:
    static constexpr int kPlane = 16; // rows
    using Rows = std::array<uint16_t, size_t(16) * kPlane>;
    typedef uint16_t Eight __attribute__((vector_size(16)));

    /// The rows of a slice, as 16 bits each.
    static Eight eight_of(uint64_t slice) {
        typedef uint8_t Bytes __attribute__((vector_size(8)));
        return __builtin_convertvector(reinterpret_cast<Bytes>(slice), Eight);
    }
    static Eight at(const uint16_t* rows) {
        Eight found;
        std::memcpy(&found, rows, sizeof found);
        return found;
    }

    /// Replaces the rows of planes up to `reach` beside the brick by what `of` makes of them and those near, eight at a
    /// time. The ends of neighbouring planes touch: after three such steps, rows less than three from an end may be
    /// wrong.
    template <int reach = margin, class Of> void each(Of of) {
        alignas(16) Rows made;
        constexpr size_t first = size_t(kFirst - reach) * kPlane, end = size_t(kFirst + kBrickSide + reach) * kPlane;
        for (size_t i = first; i < end; i += 8) {
            const Eight eight = of(&rows_[i]);
            std::memcpy(&made[i], &eight, sizeof eight);
        }
        std::memcpy(&rows_[first], &made[first], (end - first) * sizeof rows_[0]);
    }

    alignas(16) Rows rows_{};
};

} // namespace voxrt::voxelize
