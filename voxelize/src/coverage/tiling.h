// Tiles of columns, and which of them a piece of geometry may touch.
#pragma once

#include "../scene/parts.h"
#include "triangle_coverage.h"

namespace voxrt::voxelize {

/// In BinnedTriangle: all triangles of the part.
inline constexpr uint32_t kWholePart = 0xFFFF'FFFF;

/// One entry of a tile: a triangle of a part, or the part as a whole. The numbers of a mesh's triangles are followed by
/// those of its caps (CappedSurface), and these by one number without geometry: it brings the tile to look for inside.
struct BinnedTriangle {
    uint32_t part, triangle;
};

/// The same with its tile, before sorting by tile.
struct TileEntry {
    uint32_t tile;
    BinnedTriangle triangle;
};

/// A box in grid space, 1/4096 voxel, both ends included; empty at first.
struct Bounds {
    int64_t min[3] = {INT64_MAX, INT64_MAX, INT64_MAX}, max[3] = {INT64_MIN, INT64_MIN, INT64_MIN};

    void add(const Vertex& v) {
        const int64_t at[3] = {v.x, v.y, v.z};
        for (int i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], at[i]);
            max[i] = std::max(max[i], at[i]);
        }
    }
    void add(const Bounds& b) {
        for (int i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], b.min[i]);
            max[i] = std::max(max[i], b.max[i]);
        }
    }
};

/// Tiles x0 … x1, y0 … y1 (inclusive).
struct TileRange {
    int x0 = 0, x1 = -1, y0 = 0, y1 = -1;
    size_t count() const { return x0 > x1 || y0 > y1 ? 0 : size_t(x1 - x0 + 1) * size_t(y1 - y0 + 1); }
};

/// How a grid of `side` voxels is cut into tiles of kTileSide columns per side.
class Tiling {
public:
    explicit Tiling(int side) : side_(side), tiles_((side + kTileSide - 1) / kTileSide) {}

    int tiles_per_side() const { return tiles_; }

    /// Tiles that geometry within some bounds may cover or, where it lies below the grid, enclose. A surface in the
    /// plane below a voxel may belong to the voxel on either side, and on the grid's border to its last.
    TileRange touched(const Bounds& b) const {
        const int64_t end = side_ * kUnit;
        for (int i = 0; i < 3; ++i)
            if (b.min[i] > end || (i < 2 && b.max[i] < 0))
                return {};
        auto tile = [this](int64_t v) { return std::clamp(voxel_floor(v), 0, side_ - 1) / kTileSide; };
        return {tile(b.min[0] - 1), tile(b.max[0]), tile(b.min[1] - 1), tile(b.max[1])};
    }

    /// Appends an entry for each tile of a range.
    void list(std::vector<TileEntry>& out, const TileRange& range, BinnedTriangle triangle) const {
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x)
                out.push_back({uint32_t(y * tiles_ + x), triangle});
    }

private:
    int side_, tiles_;
};

} // namespace voxrt::voxelize
