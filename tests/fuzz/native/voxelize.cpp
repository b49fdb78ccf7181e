// The voxelizer on scenes that a fuzzer makes: any triangles over any vertices, rasters of materials, boxes, balls,
// ellipsoids and hulls, placed by any matrix, on grids of up to 64 voxels per side.
#include "driver.h"

#include <voxrt/voxelize/scene/convex_hull.h>
#include <voxrt/voxelize/tiles/voxelizer.h>

#include <array>

using namespace voxrt::voxelize;

namespace {

struct FuzzMesh {
    std::vector<double> positions;
    std::vector<int32_t> triangles, sizes;
    std::vector<uint8_t> materials, cells;
    std::vector<float> coordinates;
    std::vector<int64_t> starts;

    MeshView view() const { return {positions, triangles, materials, {sizes, coordinates, cells, starts}}; }
};

/// A coordinate in voxels: on planes between voxels, between them, tiny, or any number at all.
double coordinate(FuzzBytes& bytes) {
    const unsigned kind = bytes.upto(15);
    if (kind == 0)
        return bytes.take<double>();
    if (kind == 1)
        return bytes.take<float>();
    const auto value = bytes.take<int8_t>();
    return kind < 6 ? value : kind < 12 ? value / 4.0 : value / 4096.0;
}

FuzzMesh mesh(FuzzBytes& bytes) {
    FuzzMesh made;
    const unsigned vertices = 1 + bytes.upto(20), triangles = bytes.upto(40);
    const bool rasters = bytes.upto(3) == 0;
    for (unsigned i = 0; i < 3 * vertices; ++i)
        made.positions.push_back(coordinate(bytes));
    for (unsigned t = 0; t < triangles; ++t) {
        for (int i = 0; i < 3; ++i)
            made.triangles.push_back(int32_t(bytes.upto(vertices - 1)));
        made.materials.push_back(uint8_t(1 + bytes.upto(4)));
        if (!rasters)
            continue;
        const bool plain = bytes.upto(2) == 0;
        const int32_t columns = plain ? 0 : int32_t(1 + bytes.upto(4)), rows = plain ? 0 : int32_t(1 + bytes.upto(4));
        made.sizes.insert(made.sizes.end(), {columns, rows});
        made.starts.push_back(int64_t(made.cells.size()));
        for (int i = 0; i < 6; ++i)
            made.coordinates.push_back(float(coordinate(bytes)));
        for (int32_t i = 0; i < columns * rows; ++i)
            made.cells.push_back(uint8_t(bytes.upto(5)));
    }
    return made;
}

std::array<double, 12> frame(FuzzBytes& bytes, PartKind kind) {
    std::array<double, 12> made{};
    if (kind == PartKind::mesh && bytes.upto(1) == 0)
        made = {1, 0, 0, coordinate(bytes), 0, 1, 0, coordinate(bytes), 0, 0, 1, coordinate(bytes)};
    else
        for (double& value : made)
            value = coordinate(bytes);
    for (double& value : made)
        value *= double(kUnit);
    // What the caller promises (voxelizer.py): boxes and balls are whole, the minimum is below the maximum.
    if (kind == PartKind::box || kind == PartKind::ball)
        for (double& value : made)
            value = std::nearbyint(value);
    if (kind == PartKind::box)
        for (int i = 0; i < 3; ++i)
            if (made[i] > made[3 + i])
                std::swap(made[i], made[3 + i]);
    if (kind == PartKind::ball)
        made[3] = std::max(std::abs(made[3]), 1.0);
    return made;
}

uint64_t fingerprint(const SparseVoxels& voxels) {
    uint64_t hash = 0xCBF2'9CE4'8422'2325; // FNV-1a
    auto add = [&hash](const auto& array) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(array.data());
        for (size_t i = 0; i < array.size() * sizeof(array[0]); ++i)
            hash = (hash ^ bytes[i]) * 0x100'0000'01B3;
    };
    add(voxels.brick_codes);
    add(voxels.brick_masks);
    add(voxels.cells);
    add(voxels.octant_codes);
    add(voxels.octant_levels);
    add(voxels.octant_materials);
    add(voxels.object_voxels);
    return hash;
}

} // namespace

std::vector<uint8_t> fuzz_seed() {
    std::vector<uint8_t> seed;
    for (int i = 0; i < 600; ++i)
        seed.push_back(uint8_t(i * 37 ^ i >> 3));
    return seed;
}

void fuzz_one(std::span<const uint8_t> data) {
    FuzzBytes bytes(data);
    const unsigned size = bytes.upto(31);
    const int depth = size == 0 ? 6 : size == 1 ? 5 : 1 + int(size % 4); // most grids are small, for speed
    const bool twice = bytes.upto(31) == 0;
    const Thin thin = Thin(bytes.upto(1));
    std::vector<FuzzMesh> meshes;
    for (unsigned count = 1 + bytes.upto(2); count > 0; --count)
        meshes.push_back(mesh(bytes));
    std::vector<MeshView> views;
    for (const FuzzMesh& one : meshes)
        views.push_back(one.view());
    std::vector<std::array<double, 12>> frames;
    std::vector<PartKind> kinds;
    for (unsigned count = 1 + bytes.upto(5); count > 0; --count) {
        kinds.push_back(PartKind(bytes.upto(5) < 3 ? 0 : bytes.upto(3)));
        frames.push_back(frame(bytes, kinds.back()));
    }
    std::vector<PartView> parts;
    uint32_t object = 0;
    for (size_t p = 0; p < kinds.size(); ++p) {
        const MeshView* view = kinds[p] == PartKind::mesh ? &views[bytes.upto(255) % views.size()] : nullptr;
        parts.push_back({kinds[p], view, frames[p].data(), uint8_t(view ? bytes.upto(2) : 1 + bytes.upto(2)), object,
                         Rule(bytes.upto(2)), Fill(bytes.upto(2))});
        object += bytes.upto(1);
    }
    try {
        const uint64_t alone = fingerprint(voxelize(depth, parts, object + 1, 1, thin));
        if (twice && alone != fingerprint(voxelize(depth, parts, object + 1, 2, thin)))
            fuzz_fail("the result depends on the number of threads");
        std::vector<Vertex> points;
        for (const double value : meshes[0].positions)
            if (points.empty() || points.back().z != INT32_MIN)
                points.push_back({snap(value * 16, 0), snap(value * value, 0), INT32_MIN});
            else
                points.back().z = snap(value * 4096, 0);
        if (!points.empty() && points.back().z == INT32_MIN)
            points.pop_back();
        convex_hull(points);
    } catch (const OutOfRange&) {
    } catch (const std::length_error&) {
    }
}
