// How much surface of each material lies in a voxel.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace voxrt::voxelize {

/// `area`: the sum of what shows along x, y and z, in 2^-24 voxels.
struct MaterialArea {
    uint8_t material;
    int64_t area;
};

/// Areas of some voxels: those of voxel i are areas[starts[i]] … areas[starts[i + 1] - 1], a row per material, in the
/// order in which their triangles are authored.
struct SurfaceAreas {
    std::vector<uint32_t> starts{0};
    std::vector<MaterialArea> areas;

    void end_voxel() { starts.push_back(uint32_t(areas.size())); }
    std::span<const MaterialArea> at(size_t i) const { return {areas.data() + starts[i], starts[i + 1] - starts[i]}; }
};

/// Finds the areas of voxels, by Morton code.
using FindAreas = std::function<SurfaceAreas(std::span<const uint64_t>)>;

} // namespace voxrt::voxelize
