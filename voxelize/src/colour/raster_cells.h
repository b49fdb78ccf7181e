// The colours of the cells of rasters: each has that of the appearance at its centre. Textures that are finer than
// cells are reduced first.
#pragma once

#include "appearance.h"
#include "palette.h"
#include "raster_layout.h"

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace voxrt::voxelize {

/// Images with 2, 4, 8, ... pixels averaged into one per side. They are made when they are first asked for.
class ReducedImages {
public:
    explicit ReducedImages(int threads) : threads_(threads) {}

    /// An image with `step` pixels averaged into one; `step` is a power of two.
    Image reduced(const Image& image, int64_t step);

private:
    int threads_;
    std::map<std::pair<const uint8_t*, int64_t>, std::pair<std::vector<uint8_t>, Image>> made_;
};

/// The cells of the rasters of one mesh, triangle by triangle, row by row.
struct RasterCells {
    std::vector<Srgb> colours;
    std::vector<uint8_t> solid;  // 0: cut away
    std::vector<float> weights;  // how much of the surface each covers
    std::vector<uint8_t> owners; // the materials of their triangles
    std::vector<int64_t> starts; // by triangle: its first cell
};

/// Colours the rasters of a mesh, which `objects` objects show. `materials`: by triangle.
RasterCells colour_rasters(const Surface& surface, std::span<const TriangleLayout> layouts,
                           std::span<const uint8_t> materials, int64_t objects, ReducedImages& images, int threads);

} // namespace voxrt::voxelize
