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

    /// The brick without its margin. `moved`: how far its rows and planes are moved.
    Slices middle(int moved = 0) const {
        Slices found{};
        for (int z = 0; z < kBrickSide; ++z)
            for (int y = 0; y < kBrickSide; ++y)
                found[z] |= uint64_t(row(y + moved, z + moved) >> kFirst & 0xFF) << kBrickSide * y;
        return found;
    }

    /// Adds the 26 neighbours of each voxel.
    void dilate() {
        each([](const uint16_t* r) { return at(r) | at(r) << 1 | at(r) >> 1; });
        each([](const uint16_t* r) { return at(r) | at(r + 1) | at(r - 1); });
        each([](const uint16_t* r) { return at(r) | at(r + kPlane) | at(r - kPlane); });
    }

    /// The voxels of the brick in cubes of 2 x 2 x 2 voxels of the set, and the 26 neighbours of each. The set is lost.
    Slices near_cubes() {
        static_assert(margin == 2);
        // Rows are replaced in place, as none before them is read: of cubes, the row of their lowest corner; of what is
        // near, the row two before.
        const auto cubes = [](const uint16_t* r) {
            const Eight both = at(r) & at(r + 1) & at(r + kPlane) & at(r + kPlane + 1);
            return both & both >> 1;
        };
        const auto near_in_plane = [](const uint16_t* r) {
            const Eight any = at(r) | at(r + 1) | at(r + 2) | at(r + 3);
            return any >> 1 | any | any << 1 | any << 2;
        };
        replace<-margin, kBrickSide + 1>(cubes);
        replace<-margin, kBrickSide + 1>(near_in_plane);
        replace<-margin, kBrickSide - margin>(
            [](const uint16_t* r) { return at(r) | at(r + kPlane) | at(r + 2 * kPlane) | at(r + 3 * kPlane); });
        return middle(-margin);
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

    /// Replaces the rows of the brick and its margin by what `of` makes of them and those near, eight at a time. The
    /// ends of neighbouring planes touch: after three such steps, rows less than three from an end may be wrong.
    template <class Of> void each(Of of) {
        alignas(16) Rows made;
        constexpr size_t first = size_t(kFirst - margin) * kPlane, end = size_t(kFirst + kBrickSide + margin) * kPlane;
        for (size_t i = first; i < end; i += 8) {
            const Eight eight = of(&rows_[i]);
            std::memcpy(&made[i], &eight, sizeof eight);
        }
        std::memcpy(&rows_[first], &made[first], (end - first) * sizeof rows_[0]);
    }

    /// Replaces the rows of planes `from` ... `to` - 1 in place.
    template <int from, int to, class Of> void replace(Of of) {
        for (size_t i = size_t(kFirst + from) * kPlane; i < size_t(kFirst + to) * kPlane; i += 8) {
            const Eight eight = of(&rows_[i]);
            std::memcpy(&rows_[i], &eight, sizeof eight);
        }
    }

    alignas(16) Rows rows_{};
};

} // namespace voxrt::voxelize
