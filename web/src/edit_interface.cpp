// The C interface of voxrt_edit.wasm: a world whose voxels change (octree/src/edit/world.h). One exists at a time.
// Edits return 1, and 0 where the memory has no room for the result: then nothing has changed.
#include "export.h"
#include "interface_error.h"
#include "rays.h"

#include <voxrt/octree/edit/world.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

using namespace voxrt;
using web::guarded;

namespace {

std::optional<octree::World> world;
octree::Patch patch;
octree::Words words;
std::array<int32_t, 5> picked;
std::array<double, 5> figures;

octree::World& begun() {
    if (!world)
        throw std::invalid_argument("there is no world: call vx_world first");
    return *world;
}

octree::Place place(const int32_t* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

int moved(std::optional<bool> found) { return found ? *found : -2; }

int change(const octree::Shape& shape, int material, int solid_only) {
    return guarded([&]() -> int {
        const auto id = static_cast<uint8_t>(material);
        return solid_only != 0 ? begun().paint(shape, id) : begun().fill(shape, id);
    });
}

} // namespace

/// Begins a world of words, which are verified. `most_words`: of its memory. Returns 0.
EXPORT(vx_world)
int vx_world(const octree::Word* begin, size_t count, int depth, double most_words, int undo_steps) {
    return guarded([&] {
        world.reset();
        const octree::WorldLimits limits{static_cast<size_t>(most_words), static_cast<size_t>(undo_steps)};
        world.emplace(octree::Memory{begin, count, static_cast<unsigned>(depth)}, limits);
        return 0;
    });
}

/// Ends the world, and frees its memory.
EXPORT(vx_world_end) void vx_world_end() {
    world.reset();
    patch = {};
    words = {};
}

/// The stroke of the edits from now on: those in a row of one stroke, other than 0, are one step of undo. Returns 0.
EXPORT(vx_world_stroke) int vx_world_stroke(uint32_t stroke) {
    return guarded([&] {
        begun().set_stroke(stroke);
        return 0;
    });
}

EXPORT(vx_world_set) int vx_world_set(const int32_t* points, const uint8_t* materials, size_t count) {
    return guarded([&]() -> int {
        const std::vector<int64_t> places(points, points + 3 * count);
        const int64_t side = int64_t{1} << begun().depth();
        if (std::any_of(places.begin(), places.end(), [&](int64_t at) { return at < 0 || at >= side; }))
            throw std::invalid_argument("a voxel lies beyond the world of " + std::to_string(side) +
                                        " voxels per side");
        return begun().set(places.data(), materials, count);
    });
}

/// Shapes. Corners of boxes are in voxels; places and radii of the others in 1/16 voxel, at most 2^24.
EXPORT(vx_world_box) int vx_world_box(const int32_t* low, const int32_t* high, int material, int solid_only) {
    return change(octree::Box{place(low), place(high)}, material, solid_only);
}
EXPORT(vx_world_ball) int vx_world_ball(const int32_t* centre, int radius, int material, int solid_only) {
    return change(octree::Ball{place(centre), radius}, material, solid_only);
}
EXPORT(vx_world_capsule)
int vx_world_capsule(const int32_t* start, const int32_t* end, int radius, int material, int solid_only) {
    return change(octree::Capsule{place(start), place(end), radius}, material, solid_only);
}

/// 0 where there is no step; -2 where there is no room for the word of the root: then nothing has changed.
EXPORT(vx_world_undo) int vx_world_undo() {
    return guarded([] { return moved(begun().undo()); });
}
EXPORT(vx_world_redo) int vx_world_redo() {
    return guarded([] { return moved(begun().redo()); });
}

/// The first solid voxel on a ray: material, face (its axis; 3 where the ray begins in the voxel), x, y, z. Material 0:
/// there is none.
EXPORT(vx_world_pick) const int32_t* vx_world_pick(const int32_t* origin, const int32_t* direction) {
    const int failed = guarded([&] {
        const auto hit = sim::Ray<sim::WideKey>(begun().memory(), web::line_of(origin, direction)).trace();
        picked = {hit.material, hit.face, hit.cell[0], hit.cell[1], hit.cell[2]};
        return 0;
    });
    return failed != 0 ? nullptr : picked.data();
}

/// Makes the voxels as they are a live root. Returns how many blocks memories elsewhere must write for it, and then the
/// word of the root.
EXPORT(vx_world_commit) int vx_world_commit() {
    return guarded([] {
        patch = begun().commit();
        return static_cast<int>(patch.addresses.size());
    });
}
EXPORT(vx_patch_root) size_t vx_patch_root() { return patch.root; }
EXPORT(vx_patch_root_word) octree::Word vx_patch_root_word() { return patch.root_word; }
EXPORT(vx_patch_addresses) const octree::Word* vx_patch_addresses() { return patch.addresses.data(); }
EXPORT(vx_patch_blocks) const octree::Word* vx_patch_blocks() { return patch.blocks.data()->data(); }

/// Ends a live root other than the newest. Returns 0.
EXPORT(vx_world_release) int vx_world_release(size_t root) {
    return guarded([&] {
        begun().release(root);
        return 0;
    });
}

/// The words of a build of the voxels as they are; or, for `image`, all words of the memory, those of free blocks among
/// them. Returns how many. vx_world_words_at() is valid until the next call.
EXPORT(vx_world_words) double vx_world_words(int image) {
    return guarded([&] {
        words = image != 0 ? begun().image() : begun().words();
        return static_cast<double>(words.size());
    });
}
EXPORT(vx_world_words_at) const octree::Word* vx_world_words_at() { return words.data(); }

/// Blocks of the octree, further blocks that are kept, free blocks; steps of undo and redo. Linear in the blocks.
EXPORT(vx_world_figures) const double* vx_world_figures() {
    const int failed = guarded([] {
        const octree::World::Figures blocks = begun().figures();
        figures = {static_cast<double>(blocks.blocks), static_cast<double>(blocks.kept),
                   static_cast<double>(blocks.free), static_cast<double>(begun().undo_steps(0)),
                   static_cast<double>(begun().redo_steps(0))};
        return 0;
    });
    return failed != 0 ? nullptr : figures.data();
}
