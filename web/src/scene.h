// The scene of the C interface, from which memories are built, and what was built last.
#pragma once

#include <voxrt/bake/light/baked_light.h>
#include <voxrt/octree/words/memory.h>
#include <voxrt/voxelize/colour/assign_colours.h>
#include <voxrt/voxelize/scene/grid_fit.h>
#include <voxrt/voxelize/scene/material_table.h>
#include <voxrt/voxelize/scene/object_warnings.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace voxrt::web {

struct Free {
    void operator()(void* buffer) const { std::free(buffer); }
};
template <class T> using Buffer = std::unique_ptr<T[], Free>;

struct Mesh {
    std::vector<double> positions;
    std::vector<int32_t> triangles;
    std::vector<uint8_t> materials;
    // The appearances of triangles; all are empty where no triangle has one.
    std::vector<voxelize::Appearance> entries;
    std::vector<int32_t> rows;
    std::vector<double> uv;
    std::vector<float> colours;
    // The author's normals; empty where there are none. `normal_rows`: the row of each corner, or -1.
    std::vector<double> normals;
    std::vector<int32_t> normal_rows;

    std::vector<uint8_t> used{}; // by vertex: whether a triangle uses it

    bool varies() const {
        return std::any_of(rows.begin(), rows.end(), [](int32_t row) { return row >= 0; });
    }
    voxelize::Surface surface() const {
        return {entries, rows, std::span<const double>(uv), std::span<const float>(colours)};
    }
};

struct Object {
    size_t mesh;
    std::array<double, 12> transform;
    std::string name;
    int rule; // 0 touch, 1 centre, 2 half, -1 that of the build
    int fill; // 0 solid, 1 surface, 2 auto, -1 that of the build
};

struct Scene {
    voxelize::MaterialTable materials{{"empty", {24, 28, 36}}};
    std::deque<Buffer<uint8_t>> images;
    std::vector<voxelize::Appearance> appearances;
    std::deque<Mesh> meshes;
    std::vector<Object> objects;
};

struct Result {
    octree::Words words;
    voxelize::FittedGrid grid;
    std::vector<voxelize::TableMaterial> materials;
    std::vector<int64_t> object_voxels;
    std::vector<uint8_t> object_modes;
    std::vector<voxelize::ObjectWarning> warnings;
    bool is_baked = false;
};

extern Scene scene;
extern Result result;

/// The memory that was baked last, with at most so many colours.
sim::BakedMemory baked_memory(int colours);

} // namespace voxrt::web
