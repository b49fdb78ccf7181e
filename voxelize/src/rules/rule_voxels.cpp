#include "rule_voxels.h"

#include "brick_materials.h"
#include "brick_window.h"
#include "replaced_bricks.h"
#include "rule_bricks.h"
#include "thin_parts.h"

#include <span>

namespace voxrt::voxelize {
namespace {

class RuledVoxels {
public:
    RuledVoxels(const SparseVoxels& around, RuleFindings& findings)
        : voxels_(around), only_(findings.mixed.empty() ? material_of_all() : 0),
          bricks_(around, std::move(findings.bricks), only_ == 0), owned_(std::move(findings.owned)),
          mixed_(std::move(findings.mixed)) {
        std::sort(mixed_.begin(), mixed_.end(), [](const auto& a, const auto& b) { return a.code < b.code; });
        has_rivals_ = only_ == 0 && std::any_of(owned_.begin(), owned_.end(),
                                                [this](const auto& one) { return one.object != owned_[0].object; });
        if (!has_rivals_)
            return; // their order does not matter
        std::sort(owned_.begin(), owned_.end(), [](const OwnedSurface& a, const OwnedSurface& b) {
            return a.code != b.code ? a.code < b.code : a.object < b.object;
        });
    }

    RuleBricks& bricks() { return bricks_; }

    /// Finds the voxels of parts that have none of their own. The bricks must be final.
    void find_orphans(const Workers& workers) {
        orphans_.assign(bricks_.size(), Slices{});
        if (!has_rivals_)
            return; // nothing else could take a material
        for_each_brick(workers, [this](size_t i) {
            if (!is_empty(bricks_[i].removed()))
                orphans_[i] = orphans_of(i);
        });
    }

    /// Finds by areas what shows of several materials. The bricks and orphans must be final.
    void find_shown(const BrickArea& area, const FindAreas& find_areas, const Workers& workers) {
        if (mixed_.empty() && material_of_surfaces() != 0)
            return;
        std::vector<ContestedVoxels> found((bricks_.size() + kBricks - 1) / kBricks);
        for_each_brick(workers, [&](size_t i) {
            if (area.holds(bricks_[i].code))
                add_contested(i, found[i / kBricks]);
        });
        std::vector<uint64_t> codes;
        for (const ContestedVoxels& part : found)
            codes.insert(codes.end(), part.codes.begin(), part.codes.end());
        if (codes.empty())
            return;
        const SurfaceAreas areas = find_areas(codes);
        size_t next = 0;
        for (const ContestedVoxels& part : found)
            for (const ContestedVoxel& voxel : part.voxels) {
                if (const uint8_t material = largest(areas, next, voxel.codes); material != 0)
                    shown_.push_back({voxel.brick, voxel.place, material});
                next += voxel.codes;
            }
    }

    /// The bricks of an area that differ from what is touched.
    ReplacedBricks replaced(const BrickArea& area, const Workers& workers) const {
        std::vector<ReplacedBricks> found((bricks_.size() + kBricks - 1) / kBricks);
        for_each_brick(workers, [&](size_t i) {
            const RuleBrick& brick = bricks_[i];
            if (!area.holds(brick.code))
                return;
            if (only_ == 0)
                add_replaced(i, found[i / kBricks]);
            else if (!is_empty(brick.removed()))
                found[i / kBricks].bricks.push_back({brick.code, morton_order(brick.filled), only_, 0});
        });
        ReplacedBricks all;
        all.bricks.reserve(bricks_.size());
        for (ReplacedBricks& part : found) {
            for (ReplacedBrick& brick : part.bricks) {
                brick.row += uint32_t(all.cells.size());
                all.bricks.push_back(brick);
            }
            all.cells.insert(all.cells.end(), part.cells.begin(), part.cells.end());
            part = {};
        }
        return all;
    }

    void count_lost(const BrickArea& area, std::vector<int64_t>& lost) const {
        if (lost.size() == 1) // the owner of all
            for (size_t i = 0; i < bricks_.size(); ++i)
                lost[0] += area.holds(bricks_[i].code) ? count(bricks_[i].removed()) : 0;
        for (const OwnedSurface& part : owned_)
            if (area.holds(part.code))
                lost[part.object] += count(without(part.voxels, bricks_[bricks_.find(part.code)].filled));
    }

private:
    static constexpr size_t kBricks = 64; // per job

    /// A voxel whose material areas decide, and how many voxels have these.
    struct ContestedVoxel {
        uint32_t brick;
        uint16_t place; // Morton code in the brick
        uint8_t codes;
    };
    struct ContestedVoxels {
        std::vector<ContestedVoxel> voxels;
        std::vector<uint64_t> codes; // of voxels whose areas are wanted
    };
    struct ShownVoxel {
        uint32_t brick;
        uint16_t place;
        uint8_t material;
    };

    Slices mixed_in(uint64_t code) const {
        const auto at = std::lower_bound(mixed_.begin(), mixed_.end(), code,
                                         [](const MixedSurface& a, uint64_t wanted) { return a.code < wanted; });
        return at != mixed_.end() && at->code == code ? at->voxels : Slices{};
    }

    /// The only material of all bricks with surface, or 0.
    uint8_t material_of_surfaces() const {
        const auto& materials = voxels_.brick_materials;
        const uint8_t first = materials.empty() ? 0 : materials[0];
        return std::all_of(materials.begin(), materials.end(), [first](uint8_t m) { return m == first; }) ? first : 0;
    }

    /// The only material of all voxels, or 0.
    uint8_t material_of_all() const {
        const auto& insides = voxels_.octant_materials;
        const uint8_t only = material_of_surfaces();
        return std::all_of(insides.begin(), insides.end(), [only](uint8_t m) { return m == only; }) ? only : 0;
    }

    /// The material with the largest sum of areas over some voxels, the first of several; 0 where there is none.
    static uint8_t largest(const SurfaceAreas& areas, size_t from, size_t count) {
        std::vector<MaterialArea> sums;
        for (size_t i = from; i < from + count; ++i)
            for (const MaterialArea& one : areas.at(i)) {
                const auto at = std::find_if(sums.begin(), sums.end(),
                                             [&](const MaterialArea& sum) { return sum.material == one.material; });
                if (at == sums.end())
                    sums.push_back(one);
                else
                    at->area += one.area;
            }
        const auto most = std::max_element(sums.begin(), sums.end(), [](auto& a, auto& b) { return a.area < b.area; });
        return most == sums.end() ? 0 : most->material;
    }

    /// Adds the filled voxels of a brick that show surface of several materials: their own, and that of voxels beside
    /// them that are not filled.
    void add_contested(size_t i, ContestedVoxels& out) const {
        const RuleBrick& brick = bricks_[i];
        const std::array<uint32_t, 27> around = bricks_.around(i, kSideMask);
        const auto removed = [this](uint32_t n) { return bricks_[n].removed(); };
        const auto filled = [this](uint32_t n) { return bricks_[n].filled; };
        const auto removed_mixed = [this](uint32_t n) { return without(mixed_in(bricks_[n].code), bricks_[n].filled); };
        const auto orphans = [this](uint32_t n) { return orphans_[n]; };
        Slices lost[6], mixed = mixed_in(brick.code), forced{}, any = mixed, visible{};
        for (int side = 0; side < 6; ++side) {
            lost[side] = RuleBricks::shifted_by(around, side, removed, false);
            for (size_t z = 0; z < kBrickSide; ++z)
                any[z] |= lost[side][z] & brick.filled[z];
        }
        if (is_empty(any))
            return;
        const BrickMaterials own = materials_of(voxels_, brick.code);
        bool is_uniform = own.cells == nullptr;
        BrickMaterials beside[6];
        for (int side = 0; side < 6; ++side) {
            const Slices lost_mixed = RuleBricks::shifted_by(around, side, removed_mixed, false);
            const Slices lying = RuleBricks::shifted_by(around, side, orphans, false);
            const Slices hidden = RuleBricks::shifted_by(around, side, filled, true);
            for (size_t z = 0; z < kBrickSide; ++z) {
                visible[z] |= ~hidden[z];
                mixed[z] |= lost_mixed[z];
                forced[z] |= lying[z] & brick.surface[z];
            }
            const uint32_t other = around[size_t(kSides[side])];
            beside[side] =
                other < RuleBricks::kFull && !is_empty(lost[side]) ? materials_of(voxels_, bricks_[other].code) : own;
            is_uniform = is_uniform && beside[side].cells == nullptr && beside[side].only == own.only;
        }
        if (is_uniform && is_empty(mixed))
            return;
        const int corner[3] = {int(gather_bits(brick.code)) * kBrickSide,
                               int(gather_bits(brick.code >> 1)) * kBrickSide,
                               int(gather_bits(brick.code >> 2)) * kBrickSide};
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = any[size_t(z)] & visible[size_t(z)] & brick.filled[size_t(z)] & ~forced[size_t(z)];
                 left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                const int at[3] = {column_x(bit), column_y(bit), z};
                const auto place_of = [](const int* v) {
                    return morton(uint32_t(v[0]), uint32_t(v[1]), uint32_t(v[2]));
                };
                const auto code_of = [&](const int* v) {
                    return morton(uint32_t(corner[0] + v[0]), uint32_t(corner[1] + v[1]), uint32_t(corner[2] + v[2]));
                };
                const size_t begin = out.codes.size(), place = place_of(at);
                const bool has_surface = brick.surface[size_t(z)] >> bit & 1;
                bool contested = mixed[size_t(z)] >> bit & 1;
                uint8_t first = 0;
                if (has_surface) {
                    first = own.at(place);
                    out.codes.push_back(code_of(at));
                }
                for (int side = 0; side < 6; ++side) {
                    if (!(lost[side][size_t(z)] >> bit & 1))
                        continue;
                    int to[3] = {at[0], at[1], at[2]};
                    int& moved = to[side / 2];
                    moved += side % 2 == 0 ? -1 : 1;
                    out.codes.push_back(code_of(to));
                    const BrickMaterials& from = moved < 0 || moved >= kBrickSide ? beside[side] : own;
                    moved &= 7;
                    const uint8_t material = from.at(place_of(to));
                    contested = contested || (first != 0 && material != first);
                    first = first == 0 ? material : first;
                }
                if (contested)
                    out.voxels.push_back({uint32_t(i), uint16_t(place), uint8_t(out.codes.size() - begin)});
                else
                    out.codes.resize(begin);
            }
    }

    template <class Work> void for_each_brick(const Workers& workers, Work work) const {
        workers.run((bricks_.size() + kBricks - 1) / kBricks, [&](size_t job, int) {
            for (size_t i = job * kBricks; i < std::min(bricks_.size(), (job + 1) * kBricks); ++i) {
                count_work(50);
                work(i);
            }
        });
    }

    std::span<const OwnedSurface> owned_in(uint64_t code) const {
        const auto [from, to] = std::equal_range(owned_.begin(), owned_.end(), OwnedSurface{code, 0, {}},
                                                 [](const auto& a, const auto& b) { return a.code < b.code; });
        return {from, to};
    }

    Slices orphans_of(size_t i) const {
        const std::span<const OwnedSurface> own = owned_in(bricks_[i].code);
        const std::array<uint32_t, 27> around = bricks_.around(i);
        bool alone = own.size() == 1;
        for (const uint32_t other : around)
            if (alone && other < RuleBricks::kFull)
                for (const OwnedSurface& part : owned_in(bricks_[other].code))
                    alone = alone && part.object == own[0].object;
        if (alone)
            return {}; // nothing else could take the material
        Slices bare =
            beside(around, [this](uint32_t n) { return without(bricks_[n].filled, bricks_[n].surface); }, true);
        Slices found{};
        for (const OwnedSurface& part : own) {
            std::array<Slices, 27> sets{};
            std::array<const Slices*, 27> near;
            for (size_t n = 0; n < 27; ++n) {
                near[n] = &sets[n];
                if (around[n] >= RuleBricks::kFull)
                    continue;
                for (const OwnedSurface& other : owned_in(bricks_[around[n]].code))
                    if (other.object == part.object)
                        for (int z = 0; z < kBrickSide; ++z)
                            sets[n][z] |= other.voxels[z] & bricks_[around[n]].filled[z];
            }
            BrickWindow<1> window;
            window.gather(near);
            window.dilate();
            const Slices lost = without(without(part.voxels, bricks_[i].filled), window.middle());
            for (int z = 0; z < kBrickSide; ++z)
                found[z] |= lost[z] & ~bare[z];
        }
        return found;
    }

    /// The voxels of a brick with one of a set beside them. `of`: the set in a listed brick; `whole`: whether all of a
    /// brick that is solid as a whole belongs to it.
    template <class Of> Slices beside(const std::array<uint32_t, 27>& around, Of of, bool whole) const {
        Slices found{};
        for (int side = 0; side < 6; ++side) {
            const Slices shifted = RuleBricks::shifted_by(around, side, of, whole);
            for (int z = 0; z < kBrickSide; ++z)
                found[z] |= shifted[z];
        }
        return found;
    }

    void add_replaced(size_t i, ReplacedBricks& out) const {
        const RuleBrick& brick = bricks_[i];
        const std::array<uint32_t, 27> around = bricks_.around(i, kSideMask);
        const auto removed = [this](uint32_t n) { return bricks_[n].removed(); };
        const auto orphans = [this](uint32_t n) { return orphans_[n]; };
        const Slices bare = without(brick.filled, brick.surface);
        Slices takers[6], done{};
        for (int side = 0; side < 6; ++side) {
            const Slices shown = RuleBricks::shifted_by(around, side, removed, false);
            const Slices lying = RuleBricks::shifted_by(around, side, orphans, false);
            for (int z = 0; z < kBrickSide; ++z) {
                takers[side][z] = ((shown[z] & bare[z]) | (lying[z] & brick.filled[z] & brick.surface[z])) & ~done[z];
                done[z] |= takers[side][z];
            }
        }
        const auto [shown_from, shown_to] =
            std::equal_range(shown_.begin(), shown_.end(), ShownVoxel{uint32_t(i), 0, 0},
                             [](const ShownVoxel& a, const ShownVoxel& b) { return a.brick < b.brick; });
        if (is_empty(done) && is_empty(removed(uint32_t(i))) && shown_from == shown_to)
            return;
        ReplacedBrick& replaced = out.bricks.emplace_back();
        replaced = {brick.code, morton_order(brick.filled), 0, 0};
        if (is_empty(brick.filled))
            return;
        const BrickMaterials own = materials_of(voxels_, brick.code);
        bool is_uniform = own.cells == nullptr;
        BrickMaterials beside[6];
        for (int side = 0; side < 6; ++side) {
            if (is_empty(takers[side]))
                continue;
            const uint32_t other = around[size_t(kSides[side])];
            beside[side] = other < RuleBricks::kFull ? materials_of(voxels_, bricks_[other].code) : own;
            is_uniform = is_uniform && beside[side].cells == nullptr && beside[side].only == own.only;
        }
        if (is_uniform && shown_from == shown_to) {
            replaced.material = own.only;
            return;
        }
        std::array<uint8_t, 512> cells{};
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = brick.filled[z]; left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                int at[3] = {column_x(bit), column_y(bit), z};
                const size_t place = morton(uint32_t(at[0]), uint32_t(at[1]), uint32_t(at[2]));
                if (!(done[z] >> bit & 1)) {
                    cells[place] = own.at(place);
                    continue;
                }
                int side = 0;
                while (!(takers[side][z] >> bit & 1))
                    ++side;
                int& moved = at[side / 2];
                moved += side % 2 == 0 ? -1 : 1;
                const BrickMaterials& from = moved < 0 || moved >= kBrickSide ? beside[side] : own;
                moved &= 7;
                cells[place] = from.at(morton(uint32_t(at[0]), uint32_t(at[1]), uint32_t(at[2])));
            }
        for (auto shown = shown_from; shown != shown_to; ++shown)
            cells[shown->place] = shown->material;
        replaced.material = only_material(cells);
        if (replaced.material == 0) {
            replaced.row = uint32_t(out.cells.size());
            out.cells.push_back(cells);
        }
    }

    const SparseVoxels& voxels_;
    uint8_t only_; // the material of all voxels and surfaces, or 0
    RuleBricks bricks_;
    std::vector<OwnedSurface> owned_; // by code and object, where there are several
    bool has_rivals_ = false;         // several objects, and materials
    std::vector<MixedSurface> mixed_; // by code
    std::vector<Slices> orphans_;
    std::vector<ShownVoxel> shown_; // by brick
};

} // namespace

void apply_rule(SparseVoxels& voxels, const SparseVoxels& around, RuleFindings findings, const BrickArea& area,
                Thin thin, const FindAreas& find_areas, std::vector<int64_t>& lost, const Workers& workers) {
    RuledVoxels ruled(around, findings);
    if (thin == Thin::keep)
        keep_thin_parts(ruled.bricks(), workers, nullptr);
    ruled.find_orphans(workers);
    ruled.find_shown(area, find_areas, workers);
    ruled.count_lost(area, lost);
    replace_bricks(voxels, ruled.replaced(area, workers));
}

} // namespace voxrt::voxelize
