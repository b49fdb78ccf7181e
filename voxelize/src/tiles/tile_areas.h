// Which materials show in voxels of a tile, by the area of their surface outside of other objects.
#pragma once

#include "../coverage/ellipsoid.h"
#include "../coverage/material_raster.h"
#include "../rules/surface_areas.h"
#include "tile_parts.h"
#include "voxel_area.h"

namespace voxrt::voxelize {

class TileAreas : TileParts {
public:
    using TileParts::TileParts;

    /// Appends the areas of surface in voxels of a tile, by Morton code. `buffer`: for vertices.
    void find_areas(uint32_t index, std::span<const uint64_t> voxels, std::vector<Vertex>& buffer,
                    SurfaceAreas& out) const {
        const int x0 = int(index) % bins_.tiles_per_side * kTileSide;
        const int y0 = int(index) / bins_.tiles_per_side * kTileSide;
        const auto place = [](uint64_t code) {
            return std::array{int(gather_bits(code)), int(gather_bits(code >> 1)), int(gather_bits(code >> 2))};
        };
        std::vector<bool> columns(size_t{kTileSide * kTileSide});
        for (const uint64_t code : voxels) {
            const auto [x, y, z] = place(code);
            columns[size_t((y - y0) * kTileSide + x - x0)] = true;
        }
        TileSolids near(columns, x0, y0);
        std::vector<uint32_t> solids;
        for_each_run(index, [&](uint32_t part, std::span<const BinnedTriangle> triangles) {
            if (parts_[part].kind != PartKind::mesh) {
                solids.push_back(part);
                return;
            }
            const std::vector<Vertex>& vertices = vertices_of(part, buffer);
            const auto add = [&](uint32_t t) {
                if (t < parts_[part].mesh->triangle_count() && !bins_.meshes[part].is_covered(*parts_[part].mesh, t))
                    near.add(part, t, corners_of(part, t, vertices));
            };
            for (const BinnedTriangle& binned : triangles)
                if (binned.triangle != kWholePart)
                    add(binned.triangle);
            for (uint32_t t = 0; triangles[0].triangle == kWholePart && t < parts_[part].mesh->triangle_count(); ++t)
                add(t);
        });
        for (const uint64_t code : voxels) {
            count_work(100);
            const std::array<int, 3> voxel = place(code);
            const auto add = [&](uint8_t material, int64_t area) {
                const auto first = out.areas.begin() + out.starts.back();
                const auto at =
                    std::find_if(first, out.areas.end(), [&](auto& one) { return one.material == material; });
                if (at != out.areas.end())
                    at->area += area;
                else if (area != 0 && material != 0)
                    out.areas.push_back({material, area});
            };
            near.for_each_at(voxel[0], voxel[1], [&](const TileSolids::Listed& one) {
                if (one.low[2] > (voxel[2] + 1) * kUnit || one.high[2] < voxel[2] * kUnit)
                    return;
                const TriangleShare share = share_of(one.triangle, voxel, bins_.meshes[one.part].inverted, side_ - 1);
                if (share.area != 0 && !is_inside_another(parts_[one.part].object, share.before, voxel, near))
                    add(material_of(one.part, one.number, one.triangle, voxel), share.area);
            });
            for (const uint32_t part : solids)
                if (passes(parts_[part], voxel))
                    add(parts_[part].material, kSolidArea);
            out.end_voxel();
        }
    }

private:
    static constexpr int64_t kSolidArea = 1 << 24; // of a solid without triangles, in a voxel

    /// Whether a point in a column of voxels is inside of an object but for one, whose surface closes.
    bool is_inside_another(uint32_t object, const std::array<double, 3>& point, const std::array<int, 3>& voxel,
                           TileSolids& near) const {
        uint32_t last = object;
        int winding = 0;
        bool found = false;
        const double x = point[0] * kUnit, y = point[1] * kUnit, z = point[2] * kUnit;
        near.for_each_around(voxel[0], voxel[1], x, y, [&](const TileSolids::Listed& one) {
            if (one.low[2] > z || one.low[0] > x || one.high[0] < x || one.low[1] > y || one.high[1] < y)
                return;
            const uint32_t of = parts_[one.part].object;
            const MeshAnalysis& analysis = bins_.meshes[one.part];
            if (of == object || !analysis.closed || !fills(parts_[one.part].fill) ||
                (analysis.orientation && analysis.orientation->is_uncounted(one.number)))
                return;
            if (of != last) {
                found = found || winding != 0;
                winding = 0;
                last = of;
            }
            winding += crossing_below(one.triangle, point);
        });
        return found || winding != 0;
    }

    /// The material of a triangle in a voxel; 0 where it is fully transparent.
    uint8_t material_of(uint32_t part, uint32_t t, const SolidTriangle& triangle, const std::array<int, 3>& at) const {
        const PartView& one = parts_[part];
        if (one.material != 0)
            return one.material;
        if (!one.mesh->rasters.has_raster(t))
            return one.mesh->materials[t];
        const Orientation* orientation = bins_.meshes[part].orientation.get();
        const bool reversed = orientation != nullptr && orientation->is_reversed(t);
        const auto& [a, b, c] = triangle;
        return TriangleRaster(a, reversed ? c : b, reversed ? b : c, one.mesh->rasters, t)
            .material(at[0], at[1], at[2]);
    }

    /// Whether the surface of a solid without triangles passes a voxel.
    bool passes(const PartView& part, const std::array<int, 3>& voxel) const {
        const auto on_shell = [&](const auto& solid) {
            const ColumnSpan s = solid.column(voxel[0], voxel[1], side_ - 1);
            return voxel[2] >= s.lo && voxel[2] <= s.hi && (voxel[2] < s.inner_lo || voxel[2] > s.inner_hi);
        };
        return part.kind == PartKind::box    ? on_shell(box_of(part))
               : part.kind == PartKind::ball ? on_shell(ball_of(part))
                                             : on_shell(Ellipsoid(part.frame));
    }
};

} // namespace voxrt::voxelize
