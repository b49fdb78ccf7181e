// Where the triangles of a mesh lie in their rasters (material_raster.h). Cells are about one voxel wide. Columns run
// along one side of the triangle, rows towards the opposite corner, so there are about two cells per covered voxel,
// also on slivers.
#pragma once

#include "numbers.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::voxelize {

struct TriangleLayout {
    double length = 0, height = 0; // the side along the columns and the height above it, voxels
    double foot = 0;               // where the height stands on that side, 0 … 1
    int base = 0;                  // the corner at which that side begins
    int32_t columns = 0, rows = 0; // 0: the triangle has no raster

    int64_t cells() const { return int64_t{columns} * rows; }
};

/// The layout of each triangle with an appearance (a row that is not below 0), its raster of one cell yet. `linear`:
/// rows of the 3x3 map from the mesh to voxels.
std::vector<TriangleLayout> lay_out(const Numbers& positions, std::span<const int32_t> triangles,
                                    std::span<const int32_t> rows, const std::array<double, 9>& linear);

/// Gives the rasters of all meshes their sizes. Cells are larger than voxels where there were too many.
void fit_rasters(std::vector<std::vector<TriangleLayout>>& meshes);

/// Raster coordinates (column, row) of the triangle's corners.
std::array<std::array<float, 2>, 3> raster_corners(const TriangleLayout& layout);

} // namespace voxrt::voxelize
