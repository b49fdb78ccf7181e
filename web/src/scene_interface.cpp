// The C interface of voxrt.wasm: a scene in flat arrays becomes words.
//
// Images, appearances, materials and meshes are added, then surfaces of meshes, then objects. vx_scene_end() gives the
// triangles with an appearance their materials. The scene can then be voxelized again and again.
#include "export.h"
#include "interface_error.h"
#include "scene.h"

#include <voxrt/octree/build/build.h>
#include <voxrt/voxelize/colour/assign_colours.h>
#include <voxrt/voxelize/colour/assign_materials.h>
#include <voxrt/voxelize/colour/srgb.h>
#include <voxrt/voxelize/scene/grid_fit.h>
#include <voxrt/voxelize/scene/material_table.h>
#include <voxrt/voxelize/scene/object_warnings.h>
#include <voxrt/voxelize/scene/used_vertices.h>
#include <voxrt/voxelize/tiles/voxelizer.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace voxrt::web {
Scene scene;
Result result;
} // namespace voxrt::web

namespace {

using namespace voxrt;
using namespace voxrt::web;

voxelize::FittedGrid fitted(unsigned depth) {
    voxelize::Bounds bounds;
    for (const Object& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        bounds.add(std::span<const double>(mesh.positions), mesh.used, object.transform);
    }
    bounds.check(0);
    return voxelize::fit_grid(bounds.low(), bounds.high(), depth);
}

/// Refuses a choice that is not one of three.
void check_choice(const char* name, int choice, int lowest) {
    if (choice < lowest || choice > 2)
        throw std::invalid_argument(std::string("the ") + name + (lowest < 0 ? " of an object" : "") + " must be " +
                                    (lowest < 0 ? "-1, " : "") + "0, 1 or 2");
}

/// Leaves out triangles without a material.
int64_t leave_out_transparent(Mesh& mesh) {
    size_t kept = 0;
    for (size_t t = 0; t < mesh.materials.size(); ++t) {
        if (mesh.materials[t] == 0)
            continue;
        const auto keep = [&](auto& values, size_t each) {
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(each * t), each,
                        values.begin() + static_cast<ptrdiff_t>(each * kept));
        };
        keep(mesh.triangles, 3);
        keep(mesh.materials, 1);
        if (!mesh.rows.empty()) {
            keep(mesh.rows, 1);
            keep(mesh.uv, 6);
            keep(mesh.colours, 12);
        }
        if (!mesh.normal_rows.empty())
            keep(mesh.normal_rows, 3);
        ++kept;
    }
    const auto left_out = static_cast<int64_t>(mesh.materials.size() - kept);
    mesh.triangles.resize(3 * kept);
    mesh.materials.resize(kept);
    if (!mesh.rows.empty()) {
        mesh.rows.resize(kept);
        mesh.uv.resize(6 * kept);
        mesh.colours.resize(12 * kept);
    }
    if (!mesh.normal_rows.empty())
        mesh.normal_rows.resize(3 * kept);
    return left_out;
}

/// The rasters of the meshes that vary; `map_of`: each mesh's, or -1.
voxelize::Coloured coloured(double voxel_size, int colours, std::vector<int>& map_of) {
    std::vector<voxelize::VariedMesh> varied;
    std::array<uint8_t, 256> used{};
    for (const Mesh& mesh : scene.meshes) {
        for (const uint8_t id : mesh.materials)
            used[id] = 1;
        map_of.push_back(mesh.varies() ? static_cast<int>(varied.size()) : -1);
        if (mesh.varies())
            varied.push_back({std::span<const double>(mesh.positions), mesh.triangles, mesh.materials, mesh.surface()});
    }
    std::vector<voxelize::VariedObject> shown;
    for (const Object& object : scene.objects)
        if (map_of[object.mesh] >= 0)
            shown.push_back({static_cast<size_t>(map_of[object.mesh]), object.transform});
    if (shown.empty())
        return {scene.materials.entries(), {}};
    return voxelize::assign_colours(varied, shown, scene.materials.entries(), used, voxel_size, colours, 1);
}

void report(const voxelize::SparseVoxels& voxels) {
    const size_t count = scene.objects.size();
    result.object_voxels.assign(voxels.object_voxels.data(), voxels.object_voxels.data() + count);
    result.object_modes.assign(voxels.object_modes.data(), voxels.object_modes.data() + count);
    std::vector<std::string> names;
    for (const Object& object : scene.objects)
        names.push_back(object.name);
    const std::vector<uint8_t> reported(count, 1);
    result.warnings = voxelize::object_warnings(
        {result.object_voxels, result.object_modes, {voxels.object_notes.data(), count}, names, reported});
}

/// The voxelizer's view of a mesh, and the arrays that it needs.
struct PlacedMesh {
    std::vector<int64_t> starts;
    voxelize::MeshView view;
    uint8_t only_material = 0; // 0 where there are several

    PlacedMesh(const Mesh& mesh, const voxelize::MaterialMap* map) {
        const std::vector<uint8_t>& materials = map != nullptr ? map->materials : mesh.materials;
        view = {mesh.positions, mesh.triangles, materials};
        if (map == nullptr) {
            const bool one =
                !materials.empty() && std::all_of(materials.begin(), materials.end(),
                                                  [&](uint8_t material) { return material == materials[0]; });
            only_material = one ? materials[0] : 0;
            return;
        }
        int64_t total = 0;
        for (size_t t = 0; t < materials.size(); ++t) {
            starts.push_back(total);
            total += int64_t{map->sizes[2 * t]} * map->sizes[2 * t + 1];
        }
        view.rasters = {map->sizes, map->coordinates, map->cells, starts};
    }
};

} // namespace

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

/// A channel of linear light as sRGB, 0 … 255.
EXPORT(vx_srgb) int vx_srgb(double linear) { return voxelize::srgb_from_linear(linear); }
/// A code of sRGB as linear light.
EXPORT(vx_linear) double vx_linear(int code) { return voxelize::SrgbCurve::get().linear()[code & 255]; }

/// Takes over an image: 4 bytes per pixel, sRGB and alpha, row 0 at v = 0. Returns its address for vx_appearance.
EXPORT(vx_image) const uint8_t* vx_image(uint8_t* pixels) {
    scene.images.emplace_back(pixels);
    return pixels;
}

/// Adds an appearance and returns its index. `factor`: linear red, green, blue and alpha. `pixels`: null for no
/// texture. `wrap_u`, `wrap_v`: 0 repeat, 1 mirror, 2 clamp.
EXPORT(vx_appearance)
int vx_appearance(const char* name, const double* factor, const uint8_t* pixels, int width, int height, int wrap_u,
                  int wrap_v, int nearest, double cutoff, int mirror) {
    return guarded([&] {
        voxelize::Appearance made{name, {factor[0], factor[1], factor[2], factor[3]}, {}, cutoff, mirror != 0};
        if (pixels != nullptr)
            made.texture = {{pixels, width, height},
                            static_cast<voxelize::Wrap>(wrap_u),
                            static_cast<voxelize::Wrap>(wrap_v),
                            nearest != 0};
        scene.appearances.push_back(std::move(made));
        return static_cast<int>(scene.appearances.size() - 1);
    });
}

/// Adds a mesh and returns its index: 3 numbers per vertex, 3 vertices per triangle, and a material per triangle, 0
/// where vx_surface() gives an appearance.
EXPORT(vx_mesh)
int vx_mesh(const double* positions, size_t vertices, const int32_t* triangles, size_t count,
            const uint8_t* materials) {
    return guarded([&] {
        if (count == 0)
            throw std::invalid_argument("a mesh has no triangles");
        for (size_t i = 0; i < 3 * count; ++i)
            if (triangles[i] < 0 || static_cast<size_t>(triangles[i]) >= vertices)
                throw std::invalid_argument("triangle " + std::to_string(i / 3) + " has vertex " +
                                            std::to_string(triangles[i]) + ", and there are " +
                                            std::to_string(vertices));
        scene.meshes.push_back({{positions, positions + 3 * vertices},
                                {triangles, triangles + 3 * count},
                                {materials, materials + count},
                                {},
                                {},
                                {},
                                {},
                                {},
                                {}});
        return static_cast<int>(scene.meshes.size() - 1);
    });
}

/// Gives triangles of the mesh that was added last appearances; returns 0. `entries`: indices of appearances. `rows`:
/// each triangle's entry, or -1. `uv`: 6 per triangle. `colours`: 12 per triangle, linear colour and alpha of corners.
EXPORT(vx_surface)
int vx_surface(const int32_t* entries, size_t count, const int32_t* rows, const double* uv, const float* colours) {
    return guarded([&] {
        Mesh& mesh = scene.meshes.back();
        const size_t triangles = mesh.materials.size();
        for (size_t i = 0; i < count; ++i)
            mesh.entries.push_back(scene.appearances.at(static_cast<size_t>(entries[i])));
        for (size_t t = 0; t < triangles; ++t)
            if (rows[t] < -1 || rows[t] >= static_cast<int32_t>(count))
                throw std::invalid_argument("triangle " + std::to_string(t) + " has no such appearance");
        mesh.rows.assign(rows, rows + triangles);
        mesh.uv.assign(uv, uv + 6 * triangles);
        mesh.colours.assign(colours, colours + 12 * triangles);
        return 0;
    });
}

/// Gives the mesh that was added last the author's normals, for baked light: 3 numbers per direction, of any length,
/// zero for none; and the direction of each corner of each triangle, or -1. Returns 0.
EXPORT(vx_normals) int vx_normals(const double* directions, size_t count, const int32_t* rows) {
    return guarded([&] {
        Mesh& mesh = scene.meshes.back();
        const size_t corners = mesh.triangles.size();
        for (size_t i = 0; i < corners; ++i)
            if (rows[i] < -1 || rows[i] >= static_cast<int64_t>(count))
                throw std::invalid_argument("corner " + std::to_string(i) + " has no such normal");
        mesh.normals.assign(directions, directions + 3 * count);
        mesh.normal_rows.assign(rows, rows + corners);
        return 0;
    });
}

/// Places a mesh. `transform`: rows of 3x4, to the scene frame in metres, y up. `name`: UTF-8. `rule`: 0 touch, 1
/// centre, 2 half; `fill`: 0 solid, 1 surface, 2 auto; -1: that of vx_voxelize.
EXPORT(vx_object) int vx_object(int mesh, const double* transform, const char* name, int rule, int fill) {
    return guarded([&] {
        if (mesh < 0 || static_cast<size_t>(mesh) >= scene.meshes.size())
            throw std::invalid_argument("there is no mesh " + std::to_string(mesh));
        check_choice("rule", rule, -1);
        check_choice("fill", fill, -1);
        Object object{static_cast<size_t>(mesh), {}, name, rule, fill};
        std::copy_n(transform, 12, object.transform.begin());
        scene.objects.push_back(std::move(object));
        return static_cast<int>(scene.objects.size() - 1);
    });
}

/// Ends the scene: triangles with an appearance get materials. Those that are fully transparent are left out, and so
/// are objects without others; returns how many triangles there were.
EXPORT(vx_scene_end) double vx_scene_end() {
    return guarded([&] {
        std::vector<voxelize::FileMesh> meshes;
        for (Mesh& mesh : scene.meshes) {
            for (size_t t = 0; t < mesh.materials.size(); ++t)
                if (mesh.materials[t] == 0 && (mesh.rows.empty() || mesh.rows[t] < 0))
                    throw std::invalid_argument("material 0 is empty space");
            voxelize::FileMesh one{std::span<const double>(mesh.positions), mesh.triangles, {}, mesh.materials};
            if (!mesh.rows.empty())
                one.surface = mesh.surface();
            meshes.push_back(std::move(one));
        }
        voxelize::assign_materials(meshes, scene.materials, 1);
        int64_t left_out = 0;
        for (size_t i = 0; i < meshes.size(); ++i) {
            Mesh& mesh = scene.meshes[i];
            mesh.materials = std::move(meshes[i].materials);
            mesh.rows = std::move(meshes[i].rows);
            left_out += leave_out_transparent(mesh);
            if (mesh.materials.empty())
                continue;
            mesh.used = voxelize::spanning_vertices<double>(mesh.triangles, mesh.positions);
            voxelize::move_unused_vertices(mesh.positions, mesh.triangles, mesh.used);
        }
        std::erase_if(scene.objects, [](const Object& object) { return scene.meshes[object.mesh].materials.empty(); });
        return static_cast<double>(left_out);
    });
}

/// Voxelizes the scene and builds its octree; returns 0. `fill`: 0 solid, 1 surface, 2 auto. `rule`: 0 touch, 1 centre,
/// 2 half. `colours`: 1 … 254.
EXPORT(vx_voxelize) int vx_voxelize(int depth, int fill, int rule, int colours) {
    return guarded([&] {
        if (depth < 1 || depth > 16)
            throw std::invalid_argument("depth must be 1 … 16");
        check_choice("rule", rule, 0);
        check_choice("fill", fill, 0);
        if (colours < 1 || colours > 254)
            throw std::invalid_argument("colours must be 1 … 254");
        result = {};
        result.grid = fitted(static_cast<unsigned>(depth));
        std::vector<int> map_of;
        voxelize::Coloured maps = coloured(result.grid.voxel_size, colours, map_of);
        result.materials = std::move(maps.materials);
        std::deque<PlacedMesh> meshes;
        for (size_t i = 0; i < scene.meshes.size(); ++i)
            meshes.emplace_back(scene.meshes[i], map_of[i] < 0 || maps.meshes.empty()
                                                     ? nullptr
                                                     : &maps.meshes[static_cast<size_t>(map_of[i])]);
        std::deque<std::array<double, 12>> frames;
        std::vector<voxelize::PartView> parts;
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const Object& object = scene.objects[i];
            const PlacedMesh& mesh = meshes[object.mesh];
            frames.push_back(result.grid.frame(object.transform));
            parts.push_back({voxelize::PartKind::mesh, &mesh.view, frames.back().data(), mesh.only_material,
                             static_cast<uint32_t>(i),
                             static_cast<voxelize::Rule>(object.rule < 0 ? rule : object.rule),
                             static_cast<voxelize::Fill>(object.fill < 0 ? fill : object.fill)});
        }
        const voxelize::SparseVoxels voxels = voxelize::voxelize(depth, parts, scene.objects.size(), 1);
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

/// The materials of the words, the palette with them.
EXPORT(vx_material_count) size_t vx_material_count() { return result.materials.size(); }
EXPORT(vx_material_name) const char* vx_material_name(size_t id) { return result.materials.at(id).name.c_str(); }
/// 0xRRGGBB, and 1 << 24 for mirrors, 1 << 25 for those that are authored.
EXPORT(vx_material_look) uint32_t vx_material_look(size_t id) {
    const voxelize::TableMaterial& one = result.materials.at(id);
    return uint32_t{one.colour[0]} << 16 | uint32_t{one.colour[1]} << 8 | one.colour[2] | uint32_t{one.mirror} << 24 |
           uint32_t{one.authored} << 25;
}

EXPORT(vx_object_count) size_t vx_object_count() { return scene.objects.size(); }
EXPORT(vx_object_name) const char* vx_object_name(size_t object) { return scene.objects.at(object).name.c_str(); }
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
