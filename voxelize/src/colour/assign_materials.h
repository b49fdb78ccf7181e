// The last step of loading: a material for each appearance, in its mean colour; fully transparent triangles get none.
#pragma once

#include "../scene/material_table.h"
#include "appearance.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace voxrt::voxelize {

/// A mesh of a file. Borrowed, but for what assign_materials() sets.
struct FileMesh {
    Numbers positions;
    std::span<const int32_t> triangles;
    std::optional<Surface> surface;

    std::vector<uint8_t> materials; // by triangle; 0: none yet, or fully transparent
    std::vector<int32_t> rows{};    // those of the surface; set to -1 where a plain material stands for the appearance
    int64_t transparent = 0;        // how many triangles with an appearance are
};

/// Gives each triangle with an appearance a material of `table`; appearances of equal names and mirrors share one. An
/// appearance of one colour becomes a plain material. Throws TooManyMaterials.
void assign_materials(std::vector<FileMesh>& meshes, MaterialTable& table, int threads);

} // namespace voxrt::voxelize
