// The parts of a scene that reach a tile.
#pragma once

#include "../holes/capped_surface.h"
#include "convex_solids.h"
#include "tile_solids.h"
#include "triangle_bins.h"
#include "voxelizer.h"

namespace voxrt::voxelize {

class TileParts {
public:
    TileParts(const std::vector<PartView>& parts, const TriangleBins& bins, int side)
        : parts_(parts), bins_(bins), side_(side) {}

protected:
    /// Calls take(part, triangles) with each part of a tile, and what the tile lists of it.
    template <class Take> void for_each_run(uint32_t index, Take take) const {
        for (uint32_t i = bins_.starts[index], end = bins_.starts[index + 1]; i < end;) {
            const uint32_t part = bins_.triangles[i].part;
            uint32_t next = i + 1;
            while (next < end && bins_.triangles[next].part == part)
                ++next;
            take(part, std::span(bins_.triangles.data() + i, next - i));
            i = next;
        }
    }

    /// The snapped vertices of a part, in `buffer` where no analysis holds them.
    const std::vector<Vertex>& vertices_of(uint32_t index, std::vector<Vertex>& buffer) const {
        if (!bins_.meshes[index].vertices.empty())
            return bins_.meshes[index].vertices;
        const PartView& part = parts_[index];
        buffer.resize(part.mesh->vertex_count());
        for (size_t v = 0; v < buffer.size(); ++v)
            buffer[v] = snap_vertex(part, v);
        return buffer;
    }

    /// A triangle of a part, wound as it counts.
    SolidTriangle corners_of(uint32_t part, uint32_t t, const std::vector<Vertex>& vertices) const {
        const Orientation* orientation = bins_.meshes[part].orientation.get();
        const int32_t* corner = parts_[part].mesh->triangles.data() + 3 * size_t{t};
        const bool reversed = orientation != nullptr && orientation->is_reversed(t);
        return {vertices[corner[0]], vertices[corner[reversed ? 2 : 1]], vertices[corner[reversed ? 1 : 2]]};
    }

    /// What closes an open part, or null. An instance makes its caps anew in each tile, in `own`: to keep those of all
    /// instances would take too much memory.
    const CappedSurface* capped_of(uint32_t index, const std::vector<Vertex>& vertices,
                                   std::optional<CappedSurface>& own) const {
        const MeshAnalysis& analysis = bins_.meshes[index];
        if (!analysis.capped && analysis.hole_caps)
            own.emplace(analysis.hole_caps, [&vertices](uint32_t v) { return vertices[v]; });
        return own ? &*own : analysis.capped.get();
    }

    static AxisBox box_of(const PartView& part) {
        const auto whole = [&part](int i) { return int64_t(snap(part.frame[i], part.object)); };
        return {{whole(0), whole(1), whole(2)}, {whole(3), whole(4), whole(5)}};
    }

    static Ball ball_of(const PartView& part) {
        const auto whole = [&part](int i) { return int64_t(snap(part.frame[i], part.object)); };
        return {{whole(0), whole(1), whole(2)}, whole(3)};
    }

    const std::vector<PartView>& parts_;
    const TriangleBins& bins_;
    int side_;
};

} // namespace voxrt::voxelize
