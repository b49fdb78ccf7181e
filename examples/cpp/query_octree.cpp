// From a dense array to an octree memory, and queries of it: counts, bounds, hidden voxels, differences, a ray.
//
// Build and run:
//     cmake -S examples/cpp -B build/cpp -DCMAKE_BUILD_TYPE=Release
//     cmake --build build/cpp && build/cpp/query_octree
#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/query/diff.h>
#include <voxrt/octree/query/query.h>
#include <voxrt/octree/sight/hidden.h>
#include <voxrt/octree/sight/interior.h>
#include <voxrt/octree/words/validate.h>
#include <voxrt/octree/words/verify.h>
#include <voxrt/sim/rays/ray.h>

#include <cstdio>
#include <cstdlib>

using namespace voxrt;

namespace {

constexpr unsigned kDepth = 6;
constexpr int kSide = 1 << kDepth;

// A ball of three materials in layers, indexed [x][y][z].
std::vector<std::uint8_t> ball() {
    std::vector<std::uint8_t> cells;
    for (int x = 0; x < kSide; ++x)
        for (int y = 0; y < kSide; ++y)
            for (int z = 0; z < kSide; ++z) {
                const int dx = 2 * x + 1 - kSide, dy = 2 * y + 1 - kSide, dz = 2 * z + 1 - kSide;
                const bool inside = dx * dx + dy * dy + dz * dz < kSide * kSide * 4 / 5;
                cells.push_back(static_cast<std::uint8_t>(inside ? 1 + z % 3 : 0));
            }
    return cells;
}

} // namespace

int main() {
    const octree::Words words = octree::build_dense(ball().data(), kSide, kSide, kSide, kDepth);
    const octree::Memory memory{words.data(), words.size(), kDepth};
    if (octree::validate(words.data(), words.size(), kDepth).fault != octree::Fault::none)
        return EXIT_FAILURE;
    std::printf("%zu words\n", words.size());

    const auto counts = octree::count_in_box(memory, {{0, 0, 0}, {kSide, kSide, kSide / 2}});
    std::printf("lower half: %llu voxels of material 1\n", static_cast<unsigned long long>(counts[1]));
    if (const auto bounds = octree::solid_bounds(memory))
        std::printf("solid from %lld to %lld along x\n", static_cast<long long>(bounds->low[0]),
                    static_cast<long long>(bounds->high[0]));

    const octree::Words hidden = octree::hidden_voxels(memory);
    const octree::Words shared = octree::share_hidden(memory, {hidden.data(), hidden.size(), kDepth});
    const octree::Difference difference = octree::diff(memory, {shared.data(), shared.size(), kDepth});
    std::printf("%zu words once hidden voxels may be anything: %llu are of another material\n", shared.size(),
                static_cast<unsigned long long>(difference.recoloured));

    const octree::VerifiedMemory verified(memory);
    const sim::Line line{{-16 * 10, 16 * kSide / 2, 16 * kSide / 2}, {16, 1, -1}}; // positions in 1/16 voxel
    const auto hit = sim::Ray<sim::WideKey>(verified, line).trace();
    std::printf("the ray hits material %u in voxel %d, %d, %d\n", unsigned{hit.material}, hit.cell[0], hit.cell[1],
                hit.cell[2]);
    return difference.appeared + difference.vanished == 0 && hit.material != 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
