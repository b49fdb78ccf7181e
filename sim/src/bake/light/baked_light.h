// The light of a sun and a sky on the surface of a memory, and the memory with their colours.
//
// The exposed voxels, the normal of each, and the voxel before the surface from whose centre rays go towards the sun
// and the sky are found (surface_points.h), and which of the rays hit nothing (received_light.h). The sum over the sky
// is weighted by the cosine (Lambert's law). A voxel that is exposed on both sides, as in a sheet, takes the side with
// more light. Its colour is the material's in linear light times the light; the quantizer chooses a palette for all of
// them, and the octree is built again. Voxels that are not exposed keep their materials.
#pragma once

#include "../surface/exposed_bricks.h"
#include "../surface/surface_points.h"
#include "daylight.h"

#include <voxrt/octree/words/memory.h>
#include <voxrt/voxelize/colour/palette.h>
#include <voxrt/voxelize/scene/material_table.h>

#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::sim {

// The most colours of baked light in one memory.
inline constexpr int kMostBakedColours = 254;

// The exposed voxels that are baked, in the order of their bricks; mirrors are not among them.
struct LitVoxels {
    std::vector<std::uint64_t> rows; // kBrickVoxels * brick + index in the brick
    std::vector<double> sun;         // 0 ... kSunLight
    std::vector<double> sky;         // 0 ... 1: the share of an open sky
    std::vector<voxelize::Srgb> colours;
};

// What points receive becomes light: `sun` and `sky` are as receive_light() gives them for `points`, from
// sun_direction() and sky_directions().
struct ReceivedLight {
    std::span<const std::int64_t> sun;
    std::span<const std::int64_t> sky;
    std::span<const std::int64_t> open_sky; // what they would receive if nothing were in the way
};

// The light of all points of a surface. A voxel that gets less than a tenth of the light of the sun and an open sky has
// further points: half of the light beyond each of its exposed faces. For where surfaces crowd, as pebbles do, the
// normals of those near a voxel may face the ground although the voxel is open to the sky.
struct MeasuredLight {
    std::vector<std::uint64_t> points; // the voxel of each, ascending
    std::vector<std::int64_t> sun, sky, open_sky;
    ReceivedLight view() const { return {sun, sky, open_sky}; }

    // Adds a point of another, with its light divided by `part`.
    void add(const MeasuredLight& other, std::size_t i, std::int64_t part) {
        points.push_back(other.points[i]);
        sun.push_back(other.sun[i] / part);
        sky.push_back(other.sky[i] / part);
        open_sky.push_back(other.open_sky[i]);
    }
};
MeasuredLight measure_light(const octree::VerifiedMemory& memory, std::span<const std::uint64_t> brick_codes,
                            const SurfacePoints& points, const Daylight& daylight, int threads);

LitVoxels light_voxels(std::span<const std::uint64_t> points, std::span<const std::uint8_t> cells,
                       const ReceivedLight& received, const std::vector<voxelize::TableMaterial>& materials,
                       const Daylight& daylight);

// A memory of the surface's bricks and octants, with the colours of `lit` in it.
struct BakedMemory {
    octree::Words words;
    std::vector<voxelize::TableMaterial> materials;
};

// ExposedBricks whose arrays are borrowed.
struct BricksView {
    unsigned depth;
    std::span<const std::uint64_t> codes;
    std::span<const std::uint8_t> cells;
    std::span<const std::uint64_t> octant_codes;
    std::span<const std::uint8_t> octant_levels, octant_materials;
};

// `colours`: the most of them, 1 ... kMostBakedColours; there are fewer where voxels that are not exposed, and mirrors,
// need more than one material. `threads`: 0 takes as many as the machine has; the result does not depend on it.
BakedMemory bake_memory(const BricksView& bricks, std::span<const std::uint64_t> rows,
                        std::span<const voxelize::Srgb> lit, const std::vector<voxelize::TableMaterial>& materials,
                        int colours, int threads);

} // namespace voxrt::sim
