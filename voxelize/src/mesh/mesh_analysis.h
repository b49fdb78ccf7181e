// What the voxelizer needs to know of a mesh part before it fills it: how its faces are wound, whether it closes, what
// closes its holes and which components are inside out.
//
// Instances of one mesh share what they have in common, so that millions of instanced triangles cost nothing here.
// Cost: about 30 ns per triangle.
#pragma once

#include "../coverage/tiling.h"
#include "../holes/capped_surface.h"
#include "../scene/fill.h"
#include "flipped_components.h"

#include <memory>

namespace voxrt::voxelize {

/// Voxels that a part may cover or enclose, inclusive.
struct VoxelBox {
    int low[3], high[3];
};

/// The result for one mesh part.
struct MeshAnalysis {
    std::vector<Vertex> vertices; // snapped; empty where tiles snap the vertices themselves
    bool closed = false;
    bool inverted = false; // closed, but for seams, with normals that point inwards
    VoxelBox box{};
    std::shared_ptr<const HoleCaps> hole_caps; // where the part does not close and is to be filled
    std::unique_ptr<CappedSurface> capped;     // of `hole_caps`; null in an instance whose tiles make it themselves
    std::shared_ptr<const Orientation> orientation; // null where faces count as the file says, but for `inverted`
    /// Whether a triangle changes no voxel, since an earlier one covers the same.
    bool is_covered(const MeshView& mesh, size_t triangle) const {
        return orientation && mesh.rasters.sizes.empty() && orientation->is_repeated(triangle);
    }
};

/// Sums over triangles.
struct TriangleSums {
    uint64_t boundary = 0;  // the sum of boundary_key(): zero where they close
    uint64_t odd_edges = 0; // the XOR of undirected edges: zero where an even number of triangles meets at each
    double volume6 = 0;     // six times the signed volume
    Bounds bounds;

    void add(const TriangleSums& t) {
        boundary += t.boundary;
        odd_edges ^= t.odd_edges;
        volume6 += t.volume6;
        bounds.add(t.bounds);
    }
};

/// Sums over triangles from … to-1 of a mesh with snapped vertices.
TriangleSums sum_triangles(const MeshView& mesh, const std::vector<Vertex>& vertices, size_t from, size_t to);

/// What all instances of a mesh have in common, found from its own positions: equal positions are snapped to equal
/// ones.
struct SharedMesh {
    Point low{}, high{};
    bool closed = false;
    double volume6 = 0;
    std::shared_ptr<const HoleCaps> hole_caps; // where it does not close
    std::shared_ptr<const Orientation> orientation;
};

/// Analyses a mesh with triangles. `fill`: find what an open mesh needs to be filled. Throws OutOfRange with `object`
/// where a position is not a number.
SharedMesh analyze_shared(const MeshView& mesh, uint32_t object, Fill fill);

/// The sums of an instance, from its mesh's; the bounds are never too small.
TriangleSums instance_sums(const SharedMesh& shared, const PartView& part);

/// Completes the analysis of a part whose sums are known: all but `vertices` and `capped`. `shared` is null where the
/// part is the only one of its mesh; `analysis.vertices` must then be there.
void analyze_part(MeshAnalysis& analysis, const PartView& part, const TriangleSums& sums, const SharedMesh* shared,
                  Fill fill);

} // namespace voxrt::voxelize
