// From a triangle mesh to a ray hit: voxelize a tetrahedron, build its octree, trace a ray into it.
//
// Build and run:
//     cmake -S examples/cpp -B build/cpp -DCMAKE_BUILD_TYPE=Release
//     cmake --build build/cpp && build/cpp/mesh_to_ray
#include <voxrt/octree/build/build.h>
#include <voxrt/octree/words/verify.h>
#include <voxrt/sim/rays/ray.h>
#include <voxrt/voxelize/tiles/voxelizer.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace voxrt;

int main() {
    constexpr unsigned depth = 7; // 128 voxels per side

    // A mesh: positions in metres, triangles counter-clockwise seen from outside, a material each.
    const std::vector<double> positions = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2};
    const std::vector<std::int32_t> triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const std::vector<std::uint8_t> materials = {1, 1, 1, 2};
    const voxelize::MeshView mesh{positions, triangles, materials};

    // Its place in the grid: 50 voxels per metre, moved by 4 voxels. The map's unit is 1/4096 voxel.
    constexpr double scale = 50 * double(voxelize::kUnit), shift = 4 * double(voxelize::kUnit);
    const double frame[12] = {scale, 0, 0, shift, 0, scale, 0, shift, 0, 0, scale, shift};
    const std::vector<voxelize::PartView> parts = {{.kind = voxelize::PartKind::mesh, .mesh = &mesh, .frame = frame}};

    const voxelize::SparseVoxels voxels = voxelize::voxelize(depth, parts, 1, 0);
    std::printf("%lld voxels, inside told by mode '%s'\n", static_cast<long long>(voxels.object_voxels[0]),
                voxelize::kObjectModeNames[voxels.object_modes[0]]);

    const octree::Words words = octree::build(voxels.view(), 0);
    std::printf("%zu words\n", words.size());

    // A ray from outside the world towards the slanted face; its origin is in 1/16 voxel.
    const octree::VerifiedMemory memory({words.data(), words.size(), depth});
    const sim::Line line{{16 * 140, 16 * 140, 16 * 140}, {-1, -1, -1}};
    const auto hit = sim::Ray<sim::WideKey>(memory, line).trace();
    std::printf("the ray hits material %u in voxel %d, %d, %d\n", unsigned{hit.material}, hit.cell[0], hit.cell[1],
                hit.cell[2]);
    return hit.material == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
