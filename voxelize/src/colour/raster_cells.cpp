#include "raster_cells.h"

#include "../work/workers.h"
#include "srgb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxrt::voxelize {
namespace {

constexpr int64_t kCellsOfAJob = 1 << 15;

/// The width of a triangle's cells in pixels of the texture, rounded down to a power of two.
int64_t step_of(const Surface& surface, size_t t, const Image& image, const TriangleLayout& layout) {
    const auto uv = [&](size_t corner, size_t axis) {
        return surface.uv[6 * t + 2 * corner + axis] * double(axis == 0 ? image.width : image.height);
    };
    const double one[2] = {uv(1, 0) - uv(0, 0), uv(1, 1) - uv(0, 1)};
    const double other[2] = {uv(2, 0) - uv(0, 0), uv(2, 1) - uv(0, 1)};
    double pixels = std::abs(one[0] * other[1] - one[1] * other[0]);
    if (!std::isfinite(pixels))
        pixels = std::isnan(pixels) ? 0 : std::numeric_limits<double>::max();
    // A texture laid out to be just as wide is not taken for a narrower one by the rounding of its coordinates.
    const double across = std::sqrt(pixels / double(layout.cells())) * (1 + 1e-15);
    const int64_t largest = std::max(image.width, image.height);
    int64_t step = 1;
    while (2 * step <= largest && 2 * double(step) <= across)
        step *= 2;
    return step;
}

/// The centre of a cell, moved into the triangle.
struct CellCentre {
    Barycentric shares;
    bool inside; // no move was needed
};

CellCentre centre_of(const TriangleLayout& layout, int64_t column, int64_t row) {
    const double height = (double(row) + 0.5) / layout.rows;
    double along = (double(column) + 0.5) / layout.columns;
    const double lowest = height * layout.foot, highest = 1.0 - height * (1.0 - layout.foot);
    const bool inside = along >= lowest && along <= highest;
    along = std::min(std::max(along, lowest), highest);
    CellCentre centre{{}, inside};
    centre.shares[layout.base] = highest - along;
    centre.shares[(layout.base + 1) % 3] = along - lowest;
    centre.shares[(layout.base + 2) % 3] = height;
    return centre;
}

} // namespace

Image ReducedImages::reduced(const Image& image, int64_t step) {
    if (step == 1)
        return image;
    const auto found = made_.find({image.pixels, step});
    if (found != made_.end())
        return found->second.second;
    const Image finer = reduced(image, step / 2);
    std::vector<uint8_t> pixels = halved(finer, threads_);
    const Image made{pixels.data(), (finer.width + 1) / 2, (finer.height + 1) / 2};
    made_.emplace(std::pair(image.pixels, step), std::pair(std::move(pixels), made));
    return made;
}

RasterCells colour_rasters(const Surface& surface, std::span<const TriangleLayout> layouts,
                           std::span<const uint8_t> materials, int64_t objects, ReducedImages& images, int threads) {
    RasterCells cells;
    int64_t total = 0;
    for (const TriangleLayout& layout : layouts) {
        cells.starts.push_back(total);
        total += layout.cells();
    }
    cells.colours.resize(static_cast<size_t>(total));
    cells.solid.resize(static_cast<size_t>(total));
    cells.weights.resize(static_cast<size_t>(total));
    cells.owners.resize(static_cast<size_t>(total));

    std::vector<Texture> textures; // by number: an appearance's texture, reduced
    std::map<std::pair<int32_t, int64_t>, int> numbers;
    std::vector<int> texture_of(layouts.size(), -1);
    std::vector<size_t> jobs{0}; // runs of triangles
    int64_t job_start = 0;
    for (size_t t = 0; t < layouts.size(); ++t) {
        if (cells.starts[t] - job_start >= kCellsOfAJob) {
            jobs.push_back(t);
            job_start = cells.starts[t];
        }
        if (layouts[t].cells() == 0)
            continue;
        const Appearance& appearance = surface.entries[static_cast<size_t>(surface.rows[t])];
        if (!appearance.texture)
            continue;
        const int64_t step = step_of(surface, t, appearance.texture->image, layouts[t]);
        const auto [place, fresh] = numbers.try_emplace({surface.rows[t], step}, static_cast<int>(textures.size()));
        if (fresh) {
            Texture texture = *appearance.texture;
            texture.image = images.reduced(texture.image, step);
            texture.nearest = texture.nearest && step == 1;
            textures.push_back(texture);
        }
        texture_of[t] = place->second;
    }
    jobs.push_back(layouts.size());

    Workers(threads).run(jobs.size() - 1, [&](size_t job, int) {
        const SrgbCurve& curve = SrgbCurve::get();
        for (size_t t = jobs[job]; t < jobs[job + 1]; ++t) {
            const TriangleLayout& layout = layouts[t];
            if (layout.cells() == 0)
                continue;
            const Appearance& appearance = surface.entries[static_cast<size_t>(surface.rows[t])];
            const TrianglePaint paint(surface, t, appearance,
                                      texture_of[t] < 0 ? nullptr : &textures[static_cast<size_t>(texture_of[t])]);
            const auto area =
                static_cast<float>(layout.length * layout.height / double(layout.cells()) * double(objects));
            size_t at = static_cast<size_t>(cells.starts[t]);
            for (int32_t row = 0; row < layout.rows; ++row) {
                count_work(static_cast<uint32_t>(4 * layout.columns));
                for (int32_t column = 0; column < layout.columns; ++column, ++at) {
                    const CellCentre centre = centre_of(layout, column, row);
                    const Light light = paint.at(centre.shares);
                    cells.colours[at] = {curve.encode(light[0]), curve.encode(light[1]), curve.encode(light[2])};
                    cells.solid[at] = !(appearance.cutoff > 0) || light[3] >= appearance.cutoff;
                    cells.weights[at] = centre.inside ? area : 0;
                    cells.owners[at] = materials[t];
                }
            }
        }
    });
    return cells;
}

} // namespace voxrt::voxelize
