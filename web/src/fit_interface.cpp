// The C interface of voxrt.wasm: the memory that was built last, made to fit a budget of words.
#include "export.h"
#include "interface_error.h"
#include "scene.h"

#include <voxrt/octree/budget/fit_candidates.h>
#include <voxrt/octree/budget/sight_costs.h>
#include <voxrt/octree/build/coarsen.h>
#include <voxrt/octree/query/diff.h>
#include <voxrt/octree/sight/surface.h>
#include <voxrt/octree/words/verify.h>
#include <voxrt/sim/frames/frame_tile.h>
#include <voxrt/sim/views/fit_views.h>
#include <voxrt/sim/views/framing.h>
#include <voxrt/sim/views/similarity.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace {

using namespace voxrt;
using namespace voxrt::web;
using octree::Words;

// Colours that are tried where baked light does not fit with all of them, and the default picture:
// voxrt/building/baking.py.
constexpr int kPalettes[] = {sim::kMostBakedColours, 64, 16};
constexpr int kWidth = 640, kHeight = 480;

std::array<double, 6> figures; // words shared; surface, changed, appeared, recoloured voxels; colours of baked light

octree::Memory memory_of(const Words& words) { return {words.data(), words.size(), result.grid.depth}; }

octree::VerifiedMemory verified(const Words& words) { return octree::VerifiedMemory(memory_of(words)); }

std::array<uint8_t, 768> palette_of(const std::vector<voxelize::TableMaterial>& materials) {
    std::array<uint8_t, 768> palette{};
    for (size_t id = 0; id < materials.size(); ++id)
        std::copy_n(materials[id].colour.begin(), 3, palette.begin() + 3 * id);
    return palette;
}

Words fit(const Words& whole, const std::vector<voxelize::TableMaterial>& materials, size_t limit, bool flat) {
    const Words shared = octree::coarsened(memory_of(whole), 0);
    Words chosen = shared;
    if (shared.size() > limit) {
        std::vector<octree::Colour> colours;
        for (const voxelize::TableMaterial& material : materials)
            colours.push_back(material.colour);
        std::vector<Words> candidates = octree::fit_candidates(memory_of(shared), limit, *octree::sight_costs(colours));
        const std::array<uint8_t, 768> palette = palette_of(materials);
        const sim::FitViews views(verified(whole), palette.data(), flat, 1);
        std::vector<sim::FitFigures> found;
        for (const Words& candidate : candidates)
            found.push_back(
                {static_cast<double>(octree::surface_change(memory_of(whole), memory_of(candidate)).changed),
                 views.likeness(verified(candidate))});
        chosen = std::move(candidates[sim::choose_fit(found)]);
    }
    const octree::SurfaceChange seen = octree::surface_change(memory_of(whole), memory_of(chosen));
    const octree::Difference difference = octree::diff(memory_of(whole), memory_of(chosen));
    figures = {static_cast<double>(shared.size()),         static_cast<double>(seen.surface),
               static_cast<double>(seen.changed),          static_cast<double>(difference.appeared),
               static_cast<double>(difference.recoloured), 0};
    return chosen;
}

std::vector<uint8_t> picture(const Words& words, const std::vector<voxelize::TableMaterial>& materials,
                             const sim::Camera& camera) {
    static constexpr uint8_t kNoMirrors[256] = {};
    const std::array<uint8_t, 768> palette = palette_of(materials);
    std::vector<uint8_t> colour(3 * kWidth * kHeight), material(kWidth * kHeight), face(kWidth * kHeight);
    sim::render(verified(words), {palette.data(), kNoMirrors, 0, true, {}, {}}, sim::Lod{}, camera,
                {kWidth, kHeight, colour.data(), material.data(), face.data()}, 1, sim::tile_engines()[0].render_tile);
    return colour;
}

// With all colours of baked light or with fewer, whichever looks most like the memory with all.
void fit_baked(size_t limit) {
    const sim::Camera camera = sim::frame_points(sim::outline_points(verified(result.words)), kWidth, kHeight);
    const std::vector<uint8_t> whole = picture(result.words, result.materials, camera);
    double best = -1;
    sim::BakedMemory chosen;
    std::array<double, 6> chosen_figures{};
    for (const int colours : kPalettes) {
        sim::BakedMemory one = baked_memory(colours);
        one.words = fit(one.words, one.materials, limit, true);
        figures[5] = colours;
        const double psnr =
            sim::peak_signal_to_noise(whole.data(), picture(one.words, one.materials, camera).data(), whole.size() / 3);
        const bool unchanged = figures[2] == 0;
        if (psnr > best) {
            best = psnr;
            chosen = std::move(one);
            chosen_figures = figures;
        }
        if (unchanged)
            break;
    }
    figures = chosen_figures;
    result.words = std::move(chosen.words);
    result.materials = std::move(chosen.materials);
}

} // namespace

/// Fits the memory to `limit` words; returns 0. What changed: vx_fit_figures().
EXPORT(vx_fit) int vx_fit(size_t limit) {
    return guarded([&] {
        if (result.is_baked)
            fit_baked(limit);
        else
            result.words = fit(result.words, result.materials, limit, false);
        return 0;
    });
}
/// Words with equal blocks shared; voxels of the surface, changed, that became solid, of another material; the most
/// colours of baked light. 6 numbers.
EXPORT(vx_fit_figures) const double* vx_fit_figures() { return figures.data(); }
