// The C interface of voxrt.wasm: a scene in flat arrays becomes words, and words become pictures.
//
// One scene, one memory and one frame exist at a time; calls replace them. A call that returns a number below 0 has
// failed: vx_error() is the reason, one line. Buffers come from vx_alloc. Pointers that calls return are valid until
// the next call that replaces what they show.
//
//     vx_scene_begin(); vx_material(...); vx_mesh(...); vx_object(...); vx_voxelize(...);
//     vx_memory(...); vx_shading(...); vx_render(...);
#include "interface_error.h"

#include <voxrt/octree/breadth_first.h>
#include <voxrt/octree/build.h>
#include <voxrt/octree/coarsen.h>
#include <voxrt/octree/leaves.h>
#include <voxrt/octree/query.h>
#include <voxrt/octree/validate.h>
#include <voxrt/octree/verify.h>
#include <voxrt/sim/frame.h>
#include <voxrt/sim/frame_tile.h>
#include <voxrt/sim/ray.h>
#include <voxrt/voxelize/grid_fit.h>
#include <voxrt/voxelize/material_table.h>
#include <voxrt/voxelize/object_warnings.h>
#include <voxrt/voxelize/srgb.h>
#include <voxrt/voxelize/used_vertices.h>
#include <voxrt/voxelize/voxelizer.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#define EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

using namespace voxrt;
using web::guarded;

struct Free {
    void operator()(void* buffer) const { std::free(buffer); }
};
template <class T> using Buffer = std::unique_ptr<T[], Free>;

struct Mesh {
    Buffer<double> positions;
    Buffer<int32_t> triangles;
    Buffer<uint8_t> materials;
    voxelize::MeshView view;
    std::vector<uint8_t> used;
    uint8_t only_material; // 0 where there are several
};

struct Object {
    const Mesh* mesh;
    std::array<double, 12> transform;
    std::string name;
};

struct Scene {
    voxelize::MaterialTable materials{{"empty", {24, 28, 36}}};
    std::deque<Mesh> meshes;
    std::vector<Object> objects;
};

struct Result {
    std::vector<octree::Word> words;
    voxelize::FittedGrid grid;
    std::vector<int64_t> object_voxels;
    std::vector<uint8_t> object_modes;
    std::vector<voxelize::ObjectWarning> warnings;
};

struct Frame {
    int32_t width = 0, height = 0;
    std::vector<uint8_t> colour, material, face;
};

struct Shading {
    uint8_t materials[256 * 3] = {};
    uint8_t mirrors[256] = {};
    sim::Shading shading{materials, mirrors, 0, false, {}, {}};
};

Scene scene;
Result result;
std::vector<octree::Word> memory_words;
std::optional<octree::VerifiedMemory> memory;
Shading shading;
Frame frame;
std::vector<int32_t> readings;
std::vector<int32_t> outline;

const octree::VerifiedMemory& loaded() {
    if (!memory)
        throw std::invalid_argument("no memory is loaded: call vx_memory first");
    return *memory;
}

voxelize::FittedGrid fitted(unsigned depth) {
    voxelize::Bounds bounds;
    for (const Object& object : scene.objects)
        bounds.add(object.mesh->view.positions, object.mesh->used, object.transform);
    bounds.check(0);
    return voxelize::fit_grid(bounds.low(), bounds.high(), depth);
}

voxelize::Fill fill_of(int fill) {
    return fill == 0 ? voxelize::Fill::surface : fill == 1 ? voxelize::Fill::solid : voxelize::Fill::automatic;
}

void report(const voxelize::SparseVoxels& voxels) {
    const size_t count = scene.objects.size();
    result.object_voxels.assign(voxels.object_voxels.data.get(), voxels.object_voxels.data.get() + count);
    result.object_modes.assign(voxels.object_modes.data.get(), voxels.object_modes.data.get() + count);
    std::vector<std::string> names;
    for (const Object& object : scene.objects)
        names.push_back(object.name);
    const std::vector<uint8_t> reported(count, 1);
    result.warnings = voxelize::object_warnings({result.object_voxels,
                                                 result.object_modes,
                                                 {voxels.object_flipped.data.get(), count},
                                                 {voxels.object_mostly_filled.data.get(), count},
                                                 names,
                                                 reported});
}

} // namespace

EXPORT(vx_alloc) void* vx_alloc(size_t bytes) { return std::malloc(bytes > 0 ? bytes : 1); }
EXPORT(vx_free) void vx_free(void* buffer) { std::free(buffer); }
EXPORT(vx_error) const char* vx_error() { return web::last_error().c_str(); }

// The scene.

EXPORT(vx_scene_begin) void vx_scene_begin() {
    scene = {};
    result = {};
}

/// Adds a material and returns its id. `name`: UTF-8. `srgb`: 0xRRGGBB.
EXPORT(vx_material) int vx_material(const char* name, uint32_t srgb, int mirror, int authored) {
    return guarded([&] {
        const auto channel = [&](int shift) { return static_cast<uint8_t>(srgb >> shift); };
        return int{scene.materials.add({name, {channel(16), channel(8), channel(0)}, mirror != 0, authored != 0})};
    });
}

/// The name of material `id`, with the number that made it unique.
EXPORT(vx_material_name) const char* vx_material_name(int id) {
    return scene.materials.entries()[static_cast<size_t>(id)].name.c_str();
}

/// A channel of linear light as sRGB, 0 … 255.
EXPORT(vx_srgb) int vx_srgb(double linear) { return voxelize::srgb_from_linear(linear); }

/// Adds a mesh and returns its index. Takes over the buffers: 3 doubles per vertex, 3 vertices per triangle, and a
/// material per triangle.
EXPORT(vx_mesh) int vx_mesh(double* positions, size_t vertices, int32_t* triangles, size_t count, uint8_t* materials) {
    Mesh mesh{Buffer<double>(positions), Buffer<int32_t>(triangles), Buffer<uint8_t>(materials), {}, {}, 0};
    return guarded([&] {
        std::set<uint8_t> ids(materials, materials + count);
        if (count == 0)
            throw std::invalid_argument("a mesh has no triangles");
        for (size_t i = 0; i < 3 * count; ++i)
            if (triangles[i] < 0 || static_cast<size_t>(triangles[i]) >= vertices)
                throw std::invalid_argument("triangle " + std::to_string(i / 3) + " has vertex " +
                                            std::to_string(triangles[i]) + ", and there are " +
                                            std::to_string(vertices));
        if (ids.contains(0))
            throw std::invalid_argument("material 0 is empty space");
        mesh.only_material = ids.size() == 1 ? *ids.begin() : 0;
        mesh.used = voxelize::used_vertices({triangles, 3 * count}, vertices);
        voxelize::move_unused_vertices({positions, 3 * vertices}, {triangles, 3 * count});
        mesh.view = {{positions, 3 * vertices}, {triangles, 3 * count}, {materials, count}};
        scene.meshes.push_back(std::move(mesh));
        return static_cast<int>(scene.meshes.size() - 1);
    });
}

/// Places a mesh. `transform`: rows of 3x4, to the scene frame in metres, y up. `name`: UTF-8.
EXPORT(vx_object) int vx_object(int mesh, const double* transform, const char* name) {
    return guarded([&] {
        Object object{&scene.meshes.at(static_cast<size_t>(mesh)), {}, name};
        std::copy_n(transform, 12, object.transform.begin());
        scene.objects.push_back(std::move(object));
        return static_cast<int>(scene.objects.size() - 1);
    });
}

/// Voxelizes the scene and builds its octree; returns 0. `fill`: 0 surface, 1 solid, 2 auto.
EXPORT(vx_voxelize) int vx_voxelize(int depth, int fill) {
    return guarded([&] {
        if (depth < 1 || depth > 16)
            throw std::invalid_argument("depth must be 1 … 16");
        result = {};
        result.grid = fitted(static_cast<unsigned>(depth));
        std::deque<std::array<double, 12>> frames;
        std::vector<voxelize::PartView> parts;
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const Object& object = scene.objects[i];
            frames.push_back(result.grid.frame(object.transform));
            parts.push_back({voxelize::PartKind::mesh, &object.mesh->view, frames.back().data(),
                             object.mesh->only_material, static_cast<uint32_t>(i)});
        }
        const voxelize::SparseVoxels voxels = voxelize::voxelize(depth, parts, scene.objects.size(), fill_of(fill), 1);
        report(voxels);
        result.words = octree::build(voxels.view(), 1);
        return 0;
    });
}

EXPORT(vx_words) const octree::Word* vx_words() { return result.words.data(); }
EXPORT(vx_word_count) size_t vx_word_count() { return result.words.size(); }
/// Voxel size and origin, metres: 4 doubles.
EXPORT(vx_voxel_size) double vx_voxel_size() { return result.grid.voxel_size; }
EXPORT(vx_origin) const double* vx_origin() { return result.grid.origin.data(); }
EXPORT(vx_object_voxels) const int64_t* vx_object_voxels() { return result.object_voxels.data(); }
EXPORT(vx_object_mode) const char* vx_object_mode(size_t object) {
    return voxelize::kObjectModeNames[result.object_modes.at(object)];
}
EXPORT(vx_warning_count) size_t vx_warning_count() { return result.warnings.size(); }
EXPORT(vx_warning_kind) const char* vx_warning_kind(size_t i) { return result.warnings.at(i).kind.c_str(); }
EXPORT(vx_warning_message) const char* vx_warning_message(size_t i) { return result.warnings.at(i).message.c_str(); }
EXPORT(vx_warning_objects) double vx_warning_objects(size_t i) {
    return static_cast<double>(result.warnings.at(i).count);
}

// The memory.

/// Copies and verifies the words of an octree memory; returns 0.
EXPORT(vx_memory) int vx_memory(const octree::Word* words, size_t count, int depth) {
    return guarded([&] {
        memory.reset();
        memory_words.assign(words, words + count);
        memory.emplace(octree::Memory{memory_words.data(), memory_words.size(), static_cast<unsigned>(depth)});
        return 0;
    });
}

/// The least depth of the world that words describe.
EXPORT(vx_depth) int vx_depth(const octree::Word* words, size_t count) {
    return guarded([&] {
        const octree::Verdict verdict = octree::validate(words, count, 0);
        if (verdict.fault != octree::Fault::none) // which says what is wrong
            (void)octree::VerifiedMemory({words, count, octree::kMaxDepth});
        return std::max(1, static_cast<int>(verdict.least_depth));
    });
}

/// Voxels by material: 256 numbers.
EXPORT(vx_voxel_counts) const double* vx_voxel_counts() {
    static std::array<double, 256> voxels;
    voxels = {};
    const std::vector<uint64_t> leaves = octree::leaf_counts(loaded().memory());
    for (size_t i = 0; i < leaves.size(); ++i)
        voxels[i % 256] += static_cast<double>(leaves[i]) * static_cast<double>(octree::voxels_at(unsigned(i / 256)));
    return voxels.data();
}

/// The solid leaves of the memory at 1/64 of its side: x, y, z of the lowest corner and the side, each. Returns how
/// many.
EXPORT(vx_outline) int vx_outline() {
    return guarded([&] {
        const unsigned depth = loaded().depth();
        octree::BlockPool pool;
        const octree::Node root = octree::coarsen(loaded().memory(), depth > 6 ? depth - 6 : 0, pool);
        const std::vector<octree::Word> words = octree::breadth_first_words(pool, root);
        const int64_t side = int64_t{1} << depth;
        octree::LeafWalk walk({words.data(), words.size(), depth}, {{0, 0, 0}, {side, side, side}}, true);
        outline.clear();
        for (auto leaves = walk.next(4096); !leaves.empty(); leaves = walk.next(4096))
            for (const octree::Leaf& leaf : leaves)
                outline.insert(outline.end(), {leaf.corner[0], leaf.corner[1], leaf.corner[2], 1 << leaf.level});
        return static_cast<int>(outline.size() / 4);
    });
}
EXPORT(vx_outline_leaves) const int32_t* vx_outline_leaves() { return outline.data(); }

// Pictures.

/// How hits are coloured (sim/src/model/pixel.h). `materials`: 256 sRGB triples. `mirrors`: 256 flags. `faces`: 6, or
/// null. `light`: x, y, z in 1/16 voxel, or null.
EXPORT(vx_shading)
void vx_shading(const uint8_t* materials, const uint8_t* mirrors, int bounces, int flat, const uint8_t* faces,
                const int32_t* light, int ambient) {
    std::copy_n(materials, sizeof shading.materials, shading.materials);
    std::copy_n(mirrors, sizeof shading.mirrors, shading.mirrors);
    shading.shading.bounces = bounces;
    shading.shading.flat = flat != 0;
    shading.shading.faces.reset();
    shading.shading.light.reset();
    if (faces != nullptr)
        std::copy_n(faces, 6, shading.shading.faces.emplace().begin());
    if (light != nullptr)
        shading.shading.light = sim::Light{{light[0], light[1], light[2]}, static_cast<uint8_t>(ambient)};
}

/// How many rows of tiles a frame has; a tile is 16 pixels high.
EXPORT(vx_tile_rows) int vx_tile_rows(int height) { return sim::tile_rows(height); }

/// Renders rows of tiles, from `first` up to and without `end`, into the frame; returns how many words were read.
/// `registers`: position (1/16 voxel), look, right, up.
EXPORT(vx_render)
double vx_render(const int32_t* registers, int width, int height, int first, int end) {
    return guarded([&] {
        if (width < 1 || height < 1 || width > 1 << 14 || height > 1 << 14)
            throw std::invalid_argument("a frame of " + std::to_string(width) + "x" + std::to_string(height) +
                                        " pixels is not 1x1 ... 16384x16384");
        if (first < 0 || end < first || end > sim::tile_rows(height))
            throw std::invalid_argument("the frame has no such rows of tiles");
        sim::Camera camera;
        std::copy_n(registers, 3, camera.position);
        std::copy_n(registers + 3, 3, camera.look);
        std::copy_n(registers + 6, 3, camera.right);
        std::copy_n(registers + 9, 3, camera.up);
        sim::check_directions(camera, width, height);
        if (frame.width != width || frame.height != height) {
            const size_t pixels = static_cast<size_t>(width) * height;
            frame = {width, height, std::vector<uint8_t>(3 * pixels), std::vector<uint8_t>(pixels),
                     std::vector<uint8_t>(pixels)};
        }
        return static_cast<double>(
            sim::render(loaded(), shading.shading, sim::Lod{}, camera,
                        {width, height, frame.colour.data(), frame.material.data(), frame.face.data()}, {first, end}, 1,
                        sim::tile_engines()[0].render_tile));
    });
}
EXPORT(vx_colour) const uint8_t* vx_colour() { return frame.colour.data(); }
EXPORT(vx_frame_material) const uint8_t* vx_frame_material() { return frame.material.data(); }
EXPORT(vx_frame_face) const uint8_t* vx_frame_face() { return frame.face.data(); }

/// Follows one ray: origin in 1/16 voxel, direction below 2^20. Returns how many words it reads; vx_readings() has 7
/// numbers for each (address, word, level, x, y, z of the octant's lowest voxel, axis crossed last or 3) and then the
/// hit: material, face, x, y, z.
EXPORT(vx_follow) int vx_follow(const int32_t* origin, const int32_t* direction) {
    return guarded([&] {
        sim::Line line{};
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] <= -sim::kDirectionLimit || direction[axis] >= sim::kDirectionLimit)
                throw std::invalid_argument("the direction is not below 2**20");
            line.origin[axis] = origin[axis];
            line.direction[axis] = direction[axis];
        }
        readings.clear();
        const auto hit = sim::Ray<sim::WideKey>(loaded(), line).trace([](const sim::Reading<sim::WideKey>& reading) {
            readings.insert(readings.end(),
                            {static_cast<int32_t>(reading.address), static_cast<int32_t>(reading.word), reading.level,
                             reading.corner[0], reading.corner[1], reading.corner[2], reading.face});
        });
        const int count = static_cast<int>(readings.size() / 7);
        readings.insert(readings.end(), {hit.material, hit.face, hit.cell[0], hit.cell[1], hit.cell[2]});
        return count;
    });
}
EXPORT(vx_readings) const int32_t* vx_readings() { return readings.data(); }
