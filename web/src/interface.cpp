// The C interface of voxrt.wasm: memories and pictures. scene_interface.cpp has the scene from which memories are
// built.
//
// One scene, one memory and one frame exist at a time; calls replace them. A call that returns a number below 0 has
// failed: vx_error() is the reason, one line. Buffers come from vx_alloc. Pointers that calls return are valid until
// the next call that replaces what they show.
//
//     vx_scene_begin(); vx_material(...); vx_mesh(...); vx_object(...); vx_scene_end(); vx_voxelize(...);
//     vx_memory(...); vx_shading(...); vx_render(...);
#include "export.h"
#include "interface_error.h"
#include "memory.h"
#include "rays.h"

#include <voxrt/octree/build/coarsen.h>
#include <voxrt/octree/query/leaves.h>
#include <voxrt/octree/query/query.h>
#include <voxrt/octree/words/validate.h>
#include <voxrt/octree/words/verify.h>
#include <voxrt/sim/frames/frame.h>
#include <voxrt/sim/frames/frame_tile.h>
#include <voxrt/sim/rays/ray.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace voxrt;
using web::guarded;
using web::loaded;

struct Frame {
    int32_t width = 0, height = 0;
    std::vector<uint8_t> colour, material, face;
};

struct Shading {
    uint8_t materials[256 * 3] = {};
    uint8_t mirrors[256] = {};
    sim::Shading shading{materials, mirrors, 0, false, {}, {}};
};

octree::Words memory_words;
std::optional<octree::VerifiedMemory> memory;
Shading shading;
Frame frame;
std::vector<int32_t> readings;
std::vector<int32_t> outline;

} // namespace

const octree::VerifiedMemory& voxrt::web::loaded() {
    if (!memory)
        throw std::invalid_argument("no memory is loaded: call vx_memory first");
    return *memory;
}

EXPORT(vx_alloc) void* vx_alloc(size_t bytes) { return std::malloc(bytes > 0 ? bytes : 1); }
EXPORT(vx_free) void vx_free(void* buffer) { std::free(buffer); }
EXPORT(vx_error) const char* vx_error() { return web::last_error().c_str(); }

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

/// Writes the blocks of a patch (edit_interface.cpp) and the word of its root, from where the memory is read then, and
/// verifies the memory anew. Returns 0. `addresses`: of the blocks. `blocks`: 8 * count words.
EXPORT(vx_patch)
int vx_patch(const octree::Word* addresses, const octree::Word* blocks, size_t count, size_t root,
             octree::Word root_word) {
    return guarded([&] {
        const unsigned depth = loaded().depth();
        size_t end = root + 1;
        for (size_t i = 0; i < count; ++i)
            end = std::max<size_t>(end, size_t{addresses[i]} + 8);
        if (end > octree::memory_size(octree::kBlockLimit))
            throw std::invalid_argument("the patch lies beyond the memory that words can address");
        memory.reset();
        if (end > memory_words.size())
            memory_words.resize(octree::memory_size((end + 6) / 8), octree::kEmpty);
        for (size_t i = 0; i < count; ++i)
            std::copy_n(blocks + 8 * i, 8, memory_words.data() + addresses[i]);
        memory_words[root] = root_word;
        memory.emplace(octree::Memory{memory_words.data(), memory_words.size(), depth, root_word});
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

/// The least level to which the memory can be coarsened so that it has at most so many words.
EXPORT(vx_level_that_fits) int vx_level_that_fits(size_t words) {
    return guarded([&] {
        unsigned level = 0;
        while (level < loaded().depth() && octree::coarsened(loaded().memory(), level).size() > words)
            ++level;
        return static_cast<int>(level);
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
        const octree::Words words = octree::coarsened(loaded().memory(), depth > 6 ? depth - 6 : 0);
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

/// How hits are coloured (sim/src/model/rays/pixel.h). `materials`: 256 sRGB triples. `mirrors`: 256 flags. `faces`: 6,
/// or null. `light`: x, y, z in 1/16 voxel, or null.
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
        const sim::Line line = web::line_of(origin, direction);
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
