// Colours per voxel: one palette for the textures and vertex colours of a scene, as finely as a grid can show them.
// Each triangle with an appearance gets a raster of materials (raster_layout.h, raster_cells.h), and all cells of the
// scene share one palette. The voxelizer gives each voxel of the shell the material of the cell nearest to its centre
// (material_raster.h).
#pragma once

#include "../scene/material_table.h"
#include "appearance.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::voxelize {

/// A mesh whose colours vary over triangles. Borrowed.
struct VariedMesh {
    Numbers positions;
    std::span<const int32_t> triangles;
    std::span<const uint8_t> materials; // by triangle
    Surface surface;
};

/// An object that shows such a mesh: rows of the 3x4 map from the mesh to the scene frame, metres.
struct VariedObject {
    size_t mesh;
    std::array<double, 12> transform;
};

/// The rasters of one mesh, as MaterialRasters (parts.h) has them, and what stands for them where one material must do.
struct MaterialMap {
    std::vector<int32_t> sizes;     // (T, 2)
    std::vector<float> coordinates; // (T, 3, 2)
    std::vector<uint8_t> cells;
    std::vector<uint8_t> materials; // by triangle: the inside of an object takes that of its first triangle
};

struct Coloured {
    std::vector<TableMaterial> materials; // those of the scene, and the palette
    std::vector<MaterialMap> meshes;
};

/// Gives the triangles of `meshes`, each shown by one of `objects` or more, materials that vary. `materials`: those of
/// the scene, by id. `used`: flags of the ids that any triangle or collider of the scene has; materials that are not
/// authored and not used give their ids away. `colours`: the most to add, 1 … 254. Throws TooManyMaterials.
Coloured assign_colours(std::span<const VariedMesh> meshes, std::span<const VariedObject> objects,
                        std::vector<TableMaterial> materials, const std::array<uint8_t, 256>& used, double voxel_size,
                        int colours, int threads);

} // namespace voxrt::voxelize
