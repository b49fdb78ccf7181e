// What a rule other than `touch` must know of one tile: which voxels the rule fills, and which ones have surface.
//
// The voxels that objects touch are claimed as always (tile_voxels.h). Beside them stand two unions over all objects:
// what the rule fills, and what surfaces pass. When the tile is done, its bricks with surface are listed; rule_voxels.h
// goes on with the bricks of all tiles.
#pragma once

#include "../rules/rule.h"
#include "../rules/rule_brick.h"
#include "../rules/voxel_volume.h"
#include "tile_voxels.h"

#include <cmath>
#include <vector>

namespace voxrt::voxelize {

/// How far a sum of volumes of meshes with some triangles may be from the true one; boxes have no rounding.
///
/// u = 2^-53, N triangles, coordinates below 2^8 voxels (wider triangles are cut in TwoDoubles). Where an edge
/// meets a plane is found within 6 * 2^8 u along the plane; three cuts, one after another, give corners within
/// d = 2^-40.8 of those of the true piece. In a cell a piece has a perimeter below 6 and an area below 1.5, so the
/// area seen from above is wrong by 6 d at most and the volume by 8 d, once per triangle and column: pieces of one
/// column share the corners where planes between its voxels cut. Rounding in the cell is a few u per piece, of at
/// most 2^16. Whole cells below a plane have an error of 32 u; vector_pieces.h stays below 2^-34 (kHalfLimit). All
/// that is below 2^-32 per triangle. Sums of N numbers up to N in size add N^2 u, and those along 2^16 voxels of a
/// column N 2^-37.
inline double error_of_volumes(double triangles) { return triangles * 0x1p-31 + triangles * triangles * 0x1p-52; }

/// Voxels of a brick whose volumes add up to about a half.
struct HalfDoubt {
    size_t brick; // among those listed
    int column, k;
    Slices voxels;
};

/// Fills those of some voxels of a brick whose volumes are above a half. Returns those nearer to it than `error`.
inline Slices fill_halves(const std::array<double, kBrickVoxels>& volumes, const Slices& voxels, double error,
                          Slices& filled) {
    Slices near{};
    for (int z = 0; z < kBrickSide; ++z)
        for (uint64_t left = voxels[z] & ~filled[z]; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left);
            const double over = volumes[size_t(z * 64 + bit)] - 0.5;
            filled[z] |= uint64_t{over >= error} << bit;
            near[z] |= uint64_t{std::abs(over) < error} << bit;
        }
    return near;
}

class RuleTile {
public:
    /// For tiles of a grid of `side` voxels. `has_owners`: whether it is noted which object has which surface.
    /// `has_materials`: whether surfaces have several materials.
    RuleTile(int side, bool has_owners, bool has_materials)
        : filled_(side), surface_(side), mixed_(side), has_owners_(has_owners), has_materials_(has_materials) {}

    /// Empties it for the tile at (tile_x, tile_y), in tiles.
    void clear(int tile_x, int tile_y) {
        tile_x_ = tile_x;
        tile_y_ = tile_y;
        filled_.clear();
        surface_.clear();
        mixed_.clear();
        owned_.clear();
        for (const size_t slot : summed_)
            sum_rows_[slot] = kNone;
        summed_.clear();
        sums_.clear();
        summands_.clear();
        last_summands_.clear();
        triangles_ = 0;
    }

    /// What is added from now on belongs to a part of an object, and has its rule. `triangles`: that the tile lists of
    /// it.
    void begin(uint32_t part, uint32_t object, Rule rule, size_t triangles) {
        part_ = part;
        object_ = object;
        rule_of_part_ = rule;
        if (rule == Rule::half)
            triangles_ += double(triangles);
    }
    bool fills_all() const { return rule_of_part_ == Rule::touch; }
    bool asks_for_volumes() const { return rule_of_part_ == Rule::half; }

    /// Bricks from <= k < to of a column are filled, and have no surface.
    void add_full(int column, int from, int to) { filled_.claim_full(column, from, to, kAny); }

    /// `claimed`: those of the voxels with surface that no earlier object had. `mixed`: of the surface, what has
    /// several materials.
    void add(int column, int k, const Slices& filled, const Slices& surface, const Slices& claimed,
             const Slices& mixed = {}) {
        if (!is_empty(filled))
            filled_.claim(column, k, filled, kAny, nullptr);
        if (is_empty(surface))
            return;
        surface_.claim(column, k, surface, kAny, nullptr);
        Slices several = has_materials_ ? without(surface, claimed) : Slices{};
        for (int z = 0; z < kBrickSide; ++z)
            several[size_t(z)] |= mixed[size_t(z)];
        if (!is_empty(several))
            mixed_.claim(column, k, several, kAny, nullptr);
        if (has_owners_ && !is_empty(claimed))
            owned_.push_back({code_of(column, k), object_, claimed});
    }

    /// Where the volumes of the part in a brick are to be written, by slice and bit. Only those count whose voxels
    /// add_volumes() adds.
    std::array<double, kBrickVoxels>& room_for_volumes(int column, int k) {
        Sums& sums = sums_[row_of_sums(column, k)];
        return sums.empty() ? sums.values() : more_volumes_;
    }

    /// Adds the volumes in voxels of a brick, which room_for_volumes() has got.
    void add_volumes(int column, int k, const Slices& voxels) {
        const uint32_t row = row_of_sums(column, k);
        summands_.push_back({voxels, part_, last_summands_[row]});
        last_summands_[row] = uint32_t(summands_.size() - 1);
        sums_[row].add(voxels, more_volumes_);
    }

    /// Appends the bricks of the tile, by code, and who owns their surface. Returns the voxels that volumes do not
    /// decide.
    std::vector<HalfDoubt> list(const TileVoxels& tile, std::vector<RuleBrick>& bricks,
                                std::vector<OwnedSurface>& owned, std::vector<MixedSurface>& mixed) const {
        std::vector<HalfDoubt> doubts;
        bricks.reserve(tile.bricks());
        for (int base = 0; base < tile.height(); base += kTileBricks) {
            const Slices listed = listed_in(tile, base);
            for (size_t word = 0; word < listed.size(); ++word)
                for (uint64_t left = listed[word]; left != 0; left &= left - 1) {
                    const uint64_t at = word * 64 + uint64_t(std::countr_zero(left));
                    const int column = int(gather_bits(at) + gather_bits(at >> 1) * kTileBricks);
                    add_brick(tile, column, base + int(gather_bits(at >> 2)), bricks, mixed, doubts);
                }
        }
        owned.insert(owned.end(), owned_.begin(), owned_.end());
        return doubts;
    }

    /// How far a sum of volumes may be from the true one.
    double error_bound() const { return error_of_volumes(triangles_); }

    /// Calls take(part) with the parts whose volumes a voxel of a brick sums.
    template <class Take> void for_each_summand(const HalfDoubt& brick, int z, int bit, Take take) const {
        const size_t slot = size_t(brick.column) * size_t(filled_.height()) + size_t(brick.k);
        for (uint32_t i = last_summands_[sum_rows_[slot]]; i != kNone; i = summands_[i].before)
            if (summands_[i].voxels[size_t(z)] >> bit & 1)
                take(summands_[i].part);
    }

    /// Appends the volumes of the last object, and forgets it.
    void take_volumes(TileVolumes& volumes) {
        for (const size_t slot : summed_) {
            const auto column = int(slot / size_t(filled_.height())), k = int(slot % size_t(filled_.height()));
            const Slices whole = filled_.mask_of(*filled_.slots(column, k)); // by another part
            const Slices voxels = without(surface_.mask_of(*surface_.slots(column, k)), whole);
            volumes.bricks.push_back({object_, code_of(column, k), voxels});
            sums_[sum_rows_[slot]].append(voxels, volumes.values);
        }
        clear(tile_x_, tile_y_);
    }

private:
    static constexpr uint8_t kAny = 1; // a material: all voxels here have the same

    /// The sums of a brick's voxels; no memory is written of those that have none.
    class Sums {
    public:
        Sums() : summed_{} {} // without the values

        bool empty() const { return is_empty(summed_); }
        std::array<double, kBrickVoxels>& values() { return values_; }

        /// Adds to what there is; the first volumes are among the values already.
        void add(const Slices& voxels, const std::array<double, kBrickVoxels>& volumes) {
            const bool is_first = empty();
            for (int z = 0; z < kBrickSide; ++z) {
                for (uint64_t left = is_first ? 0 : voxels[z]; left != 0; left &= left - 1) {
                    const auto place = size_t(z * 64 + std::countr_zero(left));
                    const bool has_sum = (summed_[z] & left & (~left + 1)) != 0;
                    values_[place] = has_sum ? values_[place] + volumes[place] : volumes[place];
                }
                summed_[z] |= voxels[z];
            }
        }

        /// Appends those of some voxels, slice by slice, 1 at most.
        void append(const Slices& voxels, std::vector<double>& to) const {
            for (int z = 0; z < kBrickSide; ++z)
                for (uint64_t left = voxels[z]; left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    to.push_back(summed_[z] >> bit & 1 ? std::min(values_[size_t(z * 64 + bit)], 1.0) : 0);
                }
        }

        /// Fills the voxels whose sums are above a half. Returns those nearer to it than `error`.
        Slices add_halves(Slices& filled, double error) const { return fill_halves(values_, summed_, error, filled); }

    private:
        Slices summed_;
        std::array<double, kBrickVoxels> values_;
    };

    /// What one part adds to the sums of a brick.
    struct Summand {
        Slices voxels;
        uint32_t part, before; // of the brick
    };

    uint32_t row_of_sums(int column, int k) {
        const size_t slot = size_t(column) * size_t(filled_.height()) + size_t(k);
        if (sum_rows_.empty())
            sum_rows_.assign(size_t(kTileColumns) * size_t(filled_.height()), kNone);
        uint32_t& row = sum_rows_[slot];
        if (row == kNone) {
            row = uint32_t(sums_.size());
            sums_.emplace_back();
            last_summands_.push_back(kNone);
            summed_.push_back(slot);
        }
        return row;
    }

    /// Which bricks of a cube are solid in part, or solid with surface: bits by Morton code.
    Slices listed_in(const TileVoxels& tile, int base) const {
        Slices listed{};
        const int levels = std::min(kTileBricks, tile.height() - base);
        for (int column = 0; column < kTileColumns; ++column) {
            const uint32_t *slots = tile.slots(column, base), *surfaces = surface_.slots(column, base);
            uint32_t any = 0, any_surface = 0;
            for (int z = 0; z < levels; ++z) {
                any |= slots[z];
                any_surface |= surfaces[z];
            }
            if (any < TileVoxels::kFirstBrick && any_surface == 0)
                continue;
            const uint64_t lowest = morton(uint32_t(column % kTileBricks), uint32_t(column / kTileBricks), 0);
            for (int z = 0; z < levels; ++z)
                if (slots[z] >= TileVoxels::kFirstBrick || (slots[z] != 0 && surfaces[z] != 0)) {
                    const uint64_t at = lowest | morton(0, 0, uint32_t(z));
                    listed[at / 64] |= uint64_t{1} << at % 64;
                }
        }
        return listed;
    }

    void add_brick(const TileVoxels& tile, int column, int k, std::vector<RuleBrick>& bricks,
                   std::vector<MixedSurface>& mixed, std::vector<HalfDoubt>& doubts) const {
        const Slices touched = tile.mask_of(*tile.slots(column, k));
        Slices filled = filled_.mask_of(*filled_.slots(column, k));
        const size_t place = size_t(column) * size_t(tile.height()) + size_t(k);
        if (!summed_.empty() && sum_rows_[place] != kNone)
            if (const Slices near = sums_[sum_rows_[place]].add_halves(filled, error_bound()); !is_empty(near))
                doubts.push_back({bricks.size(), column, k, near});
        for (int z = 0; z < kBrickSide; ++z)
            filled[z] &= touched[z];
        bricks.push_back({code_of(column, k), touched, filled, surface_.mask_of(*surface_.slots(column, k))});
        if (const uint32_t several = *mixed_.slots(column, k); several != 0)
            mixed.push_back({code_of(column, k), mixed_.mask_of(several)});
    }

    uint64_t code_of(int column, int k) const {
        return morton(uint32_t(tile_x_ * kTileBricks + column % kTileBricks),
                      uint32_t(tile_y_ * kTileBricks + column / kTileBricks), uint32_t(k));
    }

    TileVoxels filled_, surface_, mixed_;
    bool has_owners_, has_materials_;
    std::vector<uint32_t> sum_rows_; // by slot: where the sums of volumes stand
    std::vector<size_t> summed_;     // the slots that have some
    std::vector<Sums> sums_;
    std::vector<Summand> summands_;
    std::vector<uint32_t> last_summands_;           // by row of sums_
    std::array<double, kBrickVoxels> more_volumes_; // of a part, where another one has some
    double triangles_ = 0;                          // of parts that ask for volumes
    uint32_t part_ = 0, object_ = 0;
    Rule rule_of_part_ = Rule::touch;
    int tile_x_ = 0, tile_y_ = 0; // in tiles
    std::vector<OwnedSurface> owned_;
};

} // namespace voxrt::voxelize
