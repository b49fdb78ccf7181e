// The C interface of voxrt.wasm: the light of a sun and a sky in the colours of the memory that was built last.
#include "export.h"
#include "interface_error.h"
#include "scene.h"

#include <voxrt/bake/light/baked_light.h>
#include <voxrt/bake/surface/placed_triangles.h>
#include <voxrt/octree/words/verify.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using namespace voxrt;
using namespace voxrt::web;

sim::PlacedTriangles placed_triangles() {
    std::vector<sim::NormalMesh> meshes;
    for (const Mesh& mesh : scene.meshes)
        meshes.push_back({mesh.positions, mesh.triangles, mesh.normals, mesh.normal_rows});
    std::vector<sim::PlacedMesh> objects;
    for (const Object& object : scene.objects)
        objects.push_back({object.mesh, object.transform});
    return sim::place_triangles(meshes, objects, result.grid.origin, result.grid.voxel_size);
}

// What was baked last: the memory before, and its light.
struct {
    unsigned depth;
    std::vector<voxelize::TableMaterial> materials;
    sim::ExposedBricks bricks;
    sim::LitVoxels lit;
} baked;

} // namespace

sim::BakedMemory voxrt::web::baked_memory(int colours) {
    const sim::ExposedBricks& bricks = baked.bricks;
    return sim::bake_memory({baked.depth, bricks.brick_codes, bricks.cells, bricks.octant_codes, bricks.octant_levels,
                             bricks.octant_materials},
                            baked.lit.rows, baked.lit.colours, baked.materials, colours, 1);
}

/// Bakes: the words and materials of the memory are then those with light. `sun`: towards it, scene frame; zeros for
/// none. `sky`: linear red, green and blue. `samples`: 1 … 4096. Returns how many voxels were baked.
EXPORT(vx_bake) double vx_bake(const double* sun, const double* sky, int samples) {
    return guarded([&] {
        const sim::Daylight daylight{{sun[0], sun[1], sun[2]}, {sky[0], sky[1], sky[2]}, samples};
        const octree::VerifiedMemory memory({result.words.data(), result.words.size(), result.grid.depth});
        sim::ExposedBricks bricks = sim::exposed_bricks(memory, 1);
        const sim::SurfacePoints points = sim::surface_points(memory, bricks, placed_triangles().view(), 1);
        const sim::MeasuredLight light = sim::measure_light(memory, bricks.brick_codes, points, daylight, 1);
        sim::LitVoxels lit = sim::light_voxels(light.points, bricks.cells, light.view(), result.materials, daylight);
        baked = {result.grid.depth, result.materials, std::move(bricks), std::move(lit)};
        sim::BakedMemory made = baked_memory(sim::kMostBakedColours);
        result.is_baked = true;
        result.words = std::move(made.words);
        result.materials = std::move(made.materials);
        return static_cast<double>(baked.lit.rows.size());
    });
}
