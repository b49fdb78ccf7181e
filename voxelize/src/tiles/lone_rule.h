// What a rule other than `touch` fills of one tile where a single part of one material is all there is: then the tile's
// voxels are those that are filled, and neither sums over parts nor materials are asked for.
#pragma once

#include "../rules/thin_voxels.h"
#include "rule_tile.h"

#include <vector>

namespace voxrt::voxelize {

class LoneRule {
public:
    /// `thin`: whether bricks are listed, too.
    LoneRule(Rule rule, Thin thin) : rule_(rule), lists_(thin == Thin::keep) {}

    /// Empties it for the tile at (tile_x, tile_y), in tiles, which lists some triangles of the part.
    void clear(int tile_x, int tile_y, size_t triangles) {
        tile_x_ = tile_x;
        tile_y_ = tile_y;
        error_ = error_of_volumes(double(triangles));
        bricks_.clear();
        doubts_.clear();
    }

    bool asks_for_volumes() const { return rule_ == Rule::half; }

    /// Where the volumes of a brick are to be written, by slice and bit, before it is added.
    std::array<double, kBrickVoxels>& volumes() { return volumes_; }

    /// Fills those of some voxels whose volumes are a half or more. `undecided`: others that may be.
    void decide_halves(int column, int k, const Slices& voxels, const Slices& undecided, const Slices& touched,
                       Slices& filled) {
        Slices near = fill_halves(volumes_, voxels, error_, filled);
        for (int z = 0; z < kBrickSide; ++z)
            near[z] |= undecided[z] & touched[z];
        if (is_empty(near))
            return;
        doubts_.push_back({bricks_.size(), column, k, near});
        if (!lists_)
            list(column, k, touched, filled);
    }

    /// Adds a brick with voxels that are touched, some of which are filled.
    void add(int column, int k, const Slices& touched, const Slices& filled) {
        if (lists_)
            list(column, k, touched, filled);
    }

    /// The voxels that volumes do not decide. They stand in bricks().
    const std::vector<HalfDoubt>& doubts() const { return doubts_; }
    std::vector<RuleBrick>& bricks() { return bricks_; }
    double error_bound() const { return error_; }

    /// Marks the bricks that are thick whatever other tiles hold, and appends all. `tile`: what is filled.
    void take_bricks(const TileVoxels& tile, std::vector<RuleBrick>& out) {
        if (!lists_)
            return;
        static constexpr Slices none{};
        static constexpr Slices all = [] {
            Slices s{};
            s.fill(~uint64_t{0});
            return s;
        }();
        for (RuleBrick& brick : bricks_) {
            const int x = int(gather_bits(brick.code)) - tile_x_ * kTileBricks;
            const int y = int(gather_bits(brick.code >> 1)) - tile_y_ * kTileBricks,
                      z = int(gather_bits(brick.code >> 2));
            const auto filled_at = [&](int u, int v, int k) {
                if (u < 0 || v < 0 || k < 0 || u >= kTileBricks || v >= kTileBricks || k >= tile.height())
                    return &none;
                const uint32_t slot = *tile.slots(v * kTileBricks + u, k);
                return slot == 0 ? &none : slot < TileVoxels::kFirstBrick ? &all : &tile.brick(slot).mask;
            };
            const Slices alone = thin_in_column(brick, *filled_at(x, y, z - 1), *filled_at(x, y, z + 1));
            brick.is_thick = is_empty(thin_voxels(alone, [&](uint32_t wanted) {
                std::array<const Slices*, 27> around;
                around.fill(&none);
                for (; wanted != 0; wanted &= wanted - 1) {
                    const int n = std::countr_zero(wanted);
                    around[size_t(n)] = filled_at(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
                }
                return around;
            }));
        }
        // Cube by cube, as they are joined with those of other tiles.
        const auto cube_of = [](const RuleBrick& brick) { return gather_bits(brick.code >> 2) / kTileBricks; };
        std::vector<uint32_t> places(size_t(tile.height() / kTileBricks) + 2), order(bricks_.size());
        for (const RuleBrick& brick : bricks_)
            ++places[cube_of(brick) + 1];
        for (size_t cube = 1; cube < places.size(); ++cube)
            places[cube] += places[cube - 1];
        for (uint32_t i = 0; i < bricks_.size(); ++i)
            order[places[cube_of(bricks_[i])]++] = i;
        out.reserve(bricks_.size());
        for (const uint32_t i : order)
            out.push_back(bricks_[i]);
    }

private:
    void list(int column, int k, const Slices& touched, const Slices& filled) {
        const uint64_t code = morton(uint32_t(tile_x_ * kTileBricks + column % kTileBricks),
                                     uint32_t(tile_y_ * kTileBricks + column / kTileBricks), uint32_t(k));
        bricks_.push_back({code, touched, filled, {}});
    }

    Rule rule_;
    bool lists_;
    double error_ = 0;
    std::array<double, kBrickVoxels> volumes_;
    std::vector<RuleBrick> bricks_;
    std::vector<HalfDoubt> doubts_;
    int tile_x_ = 0, tile_y_ = 0; // in tiles
};

} // namespace voxrt::voxelize
