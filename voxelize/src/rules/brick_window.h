// A brick with a margin of its neighbours, as rows of bits along x: what operations on neighbourhoods take.
#pragma once

#include "../grid/brick.h"

#include <array>
#include <cstdint>

namespace voxrt::voxelize {

/// 16 voxels per side, of which `margin` at each side of the brick are its neighbours', and the rest is empty. Voxel
/// (x, y, z) of the brick is bit x + 4 of row (y, z).
template <int margin> class BrickWindow {
public:
    static_assert(margin >= 1 && margin <= 3);
    static constexpr int kFirst = 4; // the bit of x = 0

    uint16_t& row(int y, int z) { return rows_[size_t(kPlane + (z + kFirst) * kPlane + y + kFirst)]; }
    uint16_t row(int y, int z) const { return rows_[size_t(kPlane + (z + kFirst) * kPlane + y + kFirst)]; }

    /// The 3 x 3 x 3 bricks around: `bricks[i]`, i = x + 3 y + 9 z, each 0 … 2.
    void gather(const std::array<const Slices*, 27>& bricks) {
        for (int z = -margin; z < kBrickSide + margin; ++z)
            for (int part = 0; part < 3; ++part) {
                const Slices* const* line = &bricks[size_t(9 * place(z) + 3 * part)];
                const uint64_t slices[3] = {(*line[0])[z & 7], (*line[1])[z & 7], (*line[2])[z & 7]};
                const int first = part == 0 ? -margin : part == 1 ? 0 : kBrickSide;
                const int end = part == 0 ? 0 : part == 1 ? kBrickSide : kBrickSide + margin;
                for (int y = first; y < end; ++y) {
                    const int shift = kBrickSide * (y & 7);
                    row(y, z) = uint16_t((slices[0] >> shift & 0xFF) >> (kBrickSide - margin) << (kFirst - margin) |
                                         (slices[1] >> shift & 0xFF) << kFirst |
                                         (slices[2] >> shift & ((1u << margin) - 1)) << (kFirst + kBrickSide));
                }
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
        for (uint16_t& r : rows_)
            r = uint16_t(r | r << 1 | r >> 1);
        for (const int step : {1, kPlane})
            each([step](const uint16_t* r) { return uint16_t(r[0] | r[step] | r[-step]); });
    }

    /// Leaves the voxels that a cube of 2 x 2 x 2 voxels of the set holds.
    void open() {
        for (uint16_t& r : rows_)
            r = uint16_t(r & r >> 1);
        for (const int step : {1, kPlane})
            each([step](const uint16_t* r) { return uint16_t(r[0] & r[step]); });
        for (uint16_t& r : rows_)
            r = uint16_t(r | r << 1);
        for (const int step : {1, kPlane})
            each([step](const uint16_t* r) { return uint16_t(r[0] | r[-step]); });
    }

private:
    static constexpr int kPlane = 16; // rows; one more plane stands below and above
    static constexpr int place(int i) { return i < 0 ? 0 : i < kBrickSide ? 1 : 2; }

    /// Replaces rows by what `of` makes of them and those near. The ends of neighbouring planes touch: after three such
    /// steps, rows less than three from an end of a plane may be wrong.
    template <class Of> void each(Of of) {
        const std::array<uint16_t, size_t(18) * kPlane> before = rows_;
        for (size_t i = kPlane; i < size_t(17) * kPlane; ++i)
            rows_[i] = of(&before[i]);
    }

    std::array<uint16_t, size_t(18) * kPlane> rows_{};
};

} // namespace voxrt::voxelize
