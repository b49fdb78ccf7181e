// Decides by fractions in which voxels of a tile the volumes add up to a half, where floating point does not.
#pragma once

#include "tile_parts.h"

namespace voxrt::voxelize {

class TileHalves : TileParts {
public:
    using TileParts::TileParts;

    /// Fills those of some voxels whose volumes add up to a half. `rule` summed them, or is null where they are of part
    /// 0 alone; `error`: of a sum; `buffer`: for vertices.
    void decide(const std::vector<HalfDoubt>& doubts, uint32_t index, const RuleTile* rule, double error,
                std::vector<Vertex>& buffer, std::vector<RuleBrick>& bricks) const {
        const int x0 = int(index) % bins_.tiles_per_side * kTileSide;
        const int y0 = int(index) / bins_.tiles_per_side * kTileSide;
        const auto at = [](const HalfDoubt& doubt, int bit) {
            return std::pair{doubt.column % kTileBricks * kBrickSide + column_x(bit),
                             doubt.column / kTileBricks * kBrickSide + column_y(bit)};
        };
        std::vector<bool> columns(size_t{kTileSide * kTileSide});
        for (const HalfDoubt& doubt : doubts)
            for (uint64_t left = any_of(doubt.voxels); left != 0; left &= left - 1) {
                const auto [u, v] = at(doubt, std::countr_zero(left));
                columns[size_t(v * kTileSide + u)] = true;
            }
        TileSolids near(columns, x0, y0);
        for_each_run(index, [&](uint32_t part, std::span<const BinnedTriangle> triangles) {
            if (parts_[part].rule != Rule::half || parts_[part].kind != PartKind::mesh || !fills(parts_[part].fill))
                return;
            const std::vector<Vertex>& vertices = vertices_of(part, buffer);
            std::optional<CappedSurface> own;
            const CappedSurface* capped = capped_of(part, vertices, own);
            if (triangles[0].triangle != kWholePart)
                for (const BinnedTriangle& binned : triangles)
                    add_closing(part, binned.triangle, capped, vertices, near);
            else
                for (uint32_t t = 0; t < parts_[part].mesh->triangle_count(); ++t)
                    add_closing(part, t, capped, vertices, near);
        });
        std::vector<SolidTriangle> column;
        for (const HalfDoubt& doubt : doubts) {
            count_work(1000);
            RuleBrick& brick = bricks[doubt.brick];
            const auto [u0, v0] = at(doubt, 0);
            const Slices sure = near.sure_halves(doubt.voxels, x0 + u0, y0 + v0, doubt.k * kBrickSide, error);
            for (int z = 0; z < kBrickSide; ++z) {
                uint64_t halves = sure[size_t(z)];
                for (uint64_t left = doubt.voxels[size_t(z)] & ~halves; left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const auto [u, v] = at(doubt, bit);
                    const std::array<int, 3> voxel{x0 + u, y0 + v, doubt.k * kBrickSide + z};
                    ExactSum sum;
                    const auto add = [&](uint32_t part) { add_exact_volume(part, voxel, near, column, sum); };
                    if (rule == nullptr)
                        add(0);
                    else
                        rule->for_each_summand(doubt, z, bit, add);
                    halves |= uint64_t{sum.at_least_half()} << bit;
                }
                brick.filled[size_t(z)] |= halves & brick.touched[size_t(z)];
            }
        }
    }

private:
    /// Adds what a part fills of a voxel. `column`: for its triangles.
    void add_exact_volume(uint32_t part, const std::array<int, 3>& voxel, TileSolids& near,
                          std::vector<SolidTriangle>& column, ExactSum& sum) const {
        const auto [x, y, z] = voxel;
        if (parts_[part].kind == PartKind::box) {
            sum.add(box_of(parts_[part]).volume_in_units(x, y, z), int128{1} << 3 * kFractionBits);
            return;
        }
        count_work(1000);
        near.find(part, x, y, column);
        voxelize::add_exact_volume(column, x, y, z, sum);
    }

    /// Adds a triangle of a part, wound as it counts, if it encloses something.
    void add_closing(uint32_t part, uint32_t t, const CappedSurface* capped, const std::vector<Vertex>& vertices,
                     TileSolids& near) const {
        const MeshAnalysis& analysis = bins_.meshes[part];
        const MeshView& mesh = *parts_[part].mesh;
        const Orientation* orientation = analysis.orientation.get();
        if (t >= mesh.triangle_count() || analysis.is_covered(mesh, t) ||
            (capped != nullptr && capped->is_shell_only(t)) || (orientation != nullptr && orientation->is_uncounted(t)))
            return;
        near.add(part, t, corners_of(part, t, vertices));
    }
};

} // namespace voxrt::voxelize
