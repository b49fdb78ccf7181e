#include "lone_thin_parts.h"

#include "../grid/push_octant.h"
#include "replaced_bricks.h"
#include "thin_parts.h"

namespace voxrt::voxelize {
namespace {

/// Joins octants that make up a larger one.
void join_octants(SparseVoxels& voxels) {
    SparseVoxels joined;
    for (size_t i = 0; i < voxels.octant_codes.size(); ++i)
        push_octant(joined, voxels.octant_codes[i], voxels.octant_levels[i], voxels.octant_materials[i]);
    voxels.octant_codes = std::move(joined.octant_codes);
    voxels.octant_levels = std::move(joined.octant_levels);
    voxels.octant_materials = std::move(joined.octant_materials);
}

} // namespace

int64_t add_thin_parts(SparseVoxels& voxels, const SparseVoxels& around, std::vector<std::vector<RuleBrick>> tiles,
                       const BrickArea& area, uint8_t material, const Workers& workers) {
    const auto is_thick = [](const RuleBrick& brick) { return brick.is_thick; };
    if (std::all_of(tiles.begin(), tiles.end(),
                    [&](const auto& t) { return std::all_of(t.begin(), t.end(), is_thick); }))
        return 0;
    RuleBricks bricks(around, std::move(tiles), false);
    int64_t added = 0;
    ReplacedBricks replaced;
    std::vector<AddedVoxels> parts;
    keep_thin_parts(bricks, workers, &parts);
    for (const AddedVoxels& one : parts) {
        const RuleBrick& brick = bricks[one.brick];
        if (!area.holds(brick.code))
            continue;
        added += count(one.voxels);
        replaced.bricks.push_back({brick.code, morton_order(brick.filled), material, 0});
    }
    std::sort(replaced.bricks.begin(), replaced.bricks.end(),
              [](const ReplacedBrick& a, const ReplacedBrick& b) { return a.code < b.code; });
    replace_bricks(voxels, replaced);
    join_octants(voxels);
    return added;
}

} // namespace voxrt::voxelize
