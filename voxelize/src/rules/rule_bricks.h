// The bricks with surface of a grid under a rule, and what stands beside them.
#pragma once

#include "../grid/sparse_voxels.h"
#include "rule_brick.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace voxrt::voxelize {

/// Of 3 x 3 x 3 voxels or bricks, x + 3 y + 9 z: those at the sides of the middle one, along -x, +x, -y, +y, -z, +z.
inline constexpr int kSides[6] = {12, 14, 10, 16, 4, 22};
inline constexpr uint32_t kSideMask = 1u << 12 | 1u << 14 | 1u << 10 | 1u << 16 | 1u << 4 | 1u << 22;

/// The number of the octant that holds the brick with a code, or that of all octants.
inline size_t find_octant(const SparseVoxels& voxels, uint64_t code) {
    const auto corner = [&](size_t i) { return voxels.octant_codes[i] << 3 * (voxels.octant_levels[i] - 3); };
    size_t low = 0, high = voxels.octant_codes.size();
    while (low < high) { // octants are ordered by place: the last that begins at or before the brick
        const size_t middle = (low + high) / 2;
        if (corner(middle) <= code)
            low = middle + 1;
        else
            high = middle;
    }
    const bool holds = low > 0 && voxels.octant_codes[low - 1] == code >> 3 * (voxels.octant_levels[low - 1] - 3);
    return holds ? low - 1 : voxels.octant_codes.size();
}

class RuleBricks {
public:
    /// `voxels`: what is touched; it must outlive this. `tiles`: their bricks, by code. `adds_whole`: bricks that are
    /// solid as a whole are added where a voxel beside them is not filled.
    RuleBricks(const SparseVoxels& voxels, std::vector<std::vector<RuleBrick>> tiles, bool adds_whole)
        : voxels_(voxels), tiles_(std::move(tiles)) {
        join();
        index();
        std::vector<uint64_t> beside;
        for (const RuleBrick* brick : bricks_)
            if (adds_whole)
                add_whole_beside(*brick, beside);
        if (beside.empty())
            return;
        std::sort(beside.begin(), beside.end());
        beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
        add_whole(beside);
        index();
    }

    size_t size() const { return bricks_.size(); }
    RuleBrick& operator[](size_t i) { return *bricks_[i]; }
    const RuleBrick& operator[](size_t i) const { return *bricks_[i]; }

    static constexpr uint32_t kEmpty = 0xFFFF'FFFF, kFull = 0xFFFF'FFFE;

    /// The number of the brick with a code, or kEmpty or kFull where none is listed.
    uint32_t find(uint64_t code) const {
        const uint32_t cube = find_cube(code >> kCubeBits);
        if (cube != kEmpty)
            return cubes_[cube][size_t(code & (kCubeBricks - 1))];
        return find_octant(voxels_, code) < voxels_.octant_codes.size() ? kFull : kEmpty;
    }

    /// The 3 x 3 x 3 bricks around brick `i`, itself in the middle: x + 3 y + 9 z. Those without a bit in `wanted` are
    /// not looked for.
    std::array<uint32_t, 27> around(size_t i, uint32_t wanted = 0x7FF'FFFF) const {
        const uint64_t code = bricks_[i]->code;
        const uint32_t side = voxels_.depth > 3 ? 1u << (voxels_.depth - 3) : 1;
        uint64_t codes[3][3]; // by axis, of the coordinate before, its own and the one after
        bool is_in[3][3];
        for (int axis = 0; axis < 3; ++axis) {
            const uint32_t at = gather_bits(code >> axis);
            for (uint32_t step = 0; step < 3; ++step) {
                is_in[axis][step] = at + step > 0 && at + step <= side;
                codes[axis][step] = morton(at + step - 1, 0, 0) << axis;
            }
        }
        std::array<uint32_t, 27> found;
        for (int n = 0; n < 27; ++n) {
            const int x = n % 3, y = n / 3 % 3, z = n / 9;
            const bool looked_for = (wanted >> n & 1) != 0 && is_in[0][x] && is_in[1][y] && is_in[2][z];
            found[size_t(n)] = n == 13      ? uint32_t(i)
                               : looked_for ? find(codes[0][x] | codes[1][y] | codes[2][z])
                                            : kEmpty;
        }
        return found;
    }

    /// One set of voxels of the bricks around; `of` gives it of a listed brick.
    template <class Of> std::array<const Slices*, 27> sets(const std::array<uint32_t, 27>& around, Of of) const {
        static constexpr Slices none{};
        static constexpr Slices all = [] {
            Slices s{};
            s.fill(~uint64_t{0});
            return s;
        }();
        std::array<const Slices*, 27> found;
        for (size_t n = 0; n < 27; ++n)
            found[n] = around[n] == kEmpty ? &none : around[n] == kFull ? &all : &of(*bricks_[around[n]]);
        return found;
    }

    /// The voxels of a brick whose neighbour at a side belongs to a set. `of`: the set in a listed brick;
    /// `whole`: whether all of a brick that is solid as a whole belongs to it.
    template <class Of> static Slices shifted_by(const std::array<uint32_t, 27>& around, int side, Of of, bool whole) {
        auto set = [&](uint32_t n) {
            if (n < kFull)
                return of(n);
            Slices all;
            all.fill(n == kFull && whole ? ~uint64_t{0} : 0);
            return all;
        };
        constexpr uint64_t first = 0x0101'0101'0101'0101;
        const Slices here = set(around[13]), there = set(around[size_t(kSides[side])]);
        Slices found;
        for (int z = 0; z < kBrickSide; ++z)
            switch (side) {
            case 0:
                found[z] = (here[z] & ~(first << 7)) << 1 | (there[z] & first << 7) >> 7;
                break;
            case 1:
                found[z] = (here[z] & ~first) >> 1 | (there[z] & first) << 7;
                break;
            case 2:
                found[z] = here[z] << 8 | there[z] >> 56;
                break;
            case 3:
                found[z] = here[z] >> 8 | there[z] << 56;
                break;
            case 4:
                found[z] = z > 0 ? here[z - 1] : there[kBrickSide - 1];
                break;
            default:
                found[z] = z + 1 < kBrickSide ? here[z + 1] : there[0];
            }
        return found;
    }

private:
    static constexpr int kCubeBits = 9; // of the code of a brick in its cube of 8 x 8 x 8 bricks
    static constexpr size_t kCubeBricks = size_t{1} << kCubeBits;
    struct Entry {
        uint64_t code = 0;
        uint32_t cube = kEmpty;
    };

    size_t place_of(uint64_t code) const { return size_t(code * 0x9E37'79B9'7F4A'7C15 >> shift_); }

    /// The number of the cube with a code, or kEmpty where none of its bricks is listed.
    uint32_t find_cube(uint64_t code) const {
        for (size_t at = place_of(code);; at = (at + 1) & (table_.size() - 1))
            if (table_[at].cube == kEmpty || table_[at].code == code)
                return table_[at].cube;
    }

    /// Puts the bricks of tiles in order, cube by cube.
    void join() {
        std::vector<std::span<RuleBrick>> cubes;
        size_t count = 0;
        for (std::vector<RuleBrick>& tile : tiles_) {
            for (auto at = tile.begin(); at != tile.end();) {
                const auto end = std::find_if(
                    at, tile.end(), [&](auto& one) { return one.code >> kCubeBits != at->code >> kCubeBits; });
                cubes.emplace_back(at, end);
                at = end;
            }
            count += tile.size();
        }
        std::sort(cubes.begin(), cubes.end(), [](auto& a, auto& b) { return a.front().code < b.front().code; });
        bricks_.reserve(count);
        for (const auto& cube : cubes)
            for (RuleBrick& brick : cube)
                bricks_.push_back(&brick);
    }

    /// Adds bricks that are solid as a whole, with codes in ascending order.
    void add_whole(const std::vector<uint64_t>& codes) {
        std::vector<RuleBrick>& added = tiles_.emplace_back(codes.size());
        for (size_t i = 0; i < codes.size(); ++i) {
            added[i].code = codes[i];
            added[i].touched.fill(~uint64_t{0});
            added[i].filled.fill(~uint64_t{0});
        }
        const size_t listed = bricks_.size();
        for (RuleBrick& brick : added)
            bricks_.push_back(&brick);
        std::inplace_merge(bricks_.begin(), bricks_.begin() + ptrdiff_t(listed), bricks_.end(),
                           [](auto* a, auto* b) { return a->code < b->code; });
    }

    void index() {
        size_t cubes = 0;
        for (size_t i = 0; i < bricks_.size(); ++i)
            cubes += i == 0 || bricks_[i]->code >> kCubeBits != bricks_[i - 1]->code >> kCubeBits;
        int bits = 4;
        while (size_t{1} << bits < 2 * cubes)
            ++bits;
        shift_ = 64 - bits;
        table_.assign(size_t{1} << bits, Entry{});
        cubes_.clear();
        cubes_.reserve(cubes);
        for (size_t i = 0; i < bricks_.size(); ++i) {
            const uint64_t code = bricks_[i]->code >> kCubeBits;
            if (i == 0 || code != bricks_[i - 1]->code >> kCubeBits) {
                size_t at = place_of(code);
                while (table_[at].cube != kEmpty)
                    at = (at + 1) & (table_.size() - 1);
                table_[at] = {code, uint32_t(cubes_.size())};
                const size_t octant = find_octant(voxels_, code << kCubeBits);
                cubes_.emplace_back().fill(
                    octant < voxels_.octant_codes.size() && bits_of(octant) >= kCubeBits ? kFull : kEmpty);
            }
            cubes_.back()[size_t(bricks_[i]->code & (kCubeBricks - 1))] = uint32_t(i);
        }
        mark_full();
    }

    /// Bits of the codes of bricks in an octant.
    int bits_of(size_t octant) const { return 3 * (voxels_.octant_levels[octant] - kBrickBits); }

    /// Marks the bricks of octants in the cubes.
    void mark_full() {
        for (size_t i = 0; i < voxels_.octant_codes.size(); ++i) {
            const int bits = bits_of(i);
            if (bits >= kCubeBits)
                continue; // its cubes are full from the beginning
            const uint64_t first = voxels_.octant_codes[i] << bits;
            const uint32_t cube = find_cube(first >> kCubeBits);
            for (uint64_t code = first; cube != kEmpty && code < first + (uint64_t{1} << bits); ++code)
                if (uint32_t& number = cubes_[cube][size_t(code & (kCubeBricks - 1))]; number == kEmpty)
                    number = kFull;
        }
    }

    uint32_t find_at(int x, int y, int z) const {
        const int side = voxels_.depth > 3 ? 1 << (voxels_.depth - 3) : 1;
        if (x < 0 || y < 0 || z < 0 || x >= side || y >= side || z >= side)
            return kEmpty;
        return find(morton(uint32_t(x), uint32_t(y), uint32_t(z)));
    }

    void add_whole_beside(const RuleBrick& brick, std::vector<uint64_t>& beside) const {
        const Slices removed = brick.removed();
        uint64_t any = 0;
        for (const uint64_t slice : removed)
            any |= slice;
        if (any == 0)
            return;
        constexpr uint64_t first_column = 0x0101'0101'0101'0101;
        const bool reaches[6] = {(any & first_column) != 0, (any & first_column << 7) != 0,
                                 (any & 0xFF) != 0,         (any >> 56) != 0,
                                 removed[0] != 0,           removed[7] != 0};
        const int at[3] = {int(gather_bits(brick.code)), int(gather_bits(brick.code >> 1)),
                           int(gather_bits(brick.code >> 2))};
        for (int side = 0; side < 6; ++side) {
            int to[3] = {at[0], at[1], at[2]};
            to[side / 2] += side % 2 == 0 ? -1 : 1;
            if (!reaches[side] || find_at(to[0], to[1], to[2]) != kFull)
                continue;
            beside.push_back(morton(uint32_t(to[0]), uint32_t(to[1]), uint32_t(to[2])));
        }
    }

    const SparseVoxels& voxels_;
    std::vector<std::vector<RuleBrick>> tiles_; // and one more of bricks that are added
    std::vector<RuleBrick*> bricks_;            // by code
    std::vector<std::array<uint32_t, kCubeBricks>> cubes_;
    std::vector<Entry> table_; // of cubes, by open addressing
    int shift_ = 60;
};

} // namespace voxrt::voxelize
