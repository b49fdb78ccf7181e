#include "assign_materials.h"

#include "palette.h"
#include "srgb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace voxrt::voxelize {
namespace {

constexpr size_t kSampledTriangles = 1 << 10;
constexpr size_t kSamples = 1 << 12;
constexpr double kLittle = 1e-9, kLeast = 1e-300; // shares of what has no area, or is cut away

/// The triangles whose appearances have one name.
struct Usage {
    std::string name;
    bool mirror;
    std::vector<std::pair<size_t, std::vector<size_t>>> faces; // a mesh, and its triangles
    std::optional<Srgb> colour;                                // that of all of them
    bool varies = false;
    std::array<double, 3> light{}; // the sum of mean colour times area
    double area = 0;
};

/// The colour of an appearance on some triangles; none where it varies over them.
std::optional<Srgb> only_colour(const Surface& surface, const Appearance& appearance,
                                const std::vector<size_t>& faces) {
    if (appearance.texture)
        return std::nullopt;
    const size_t first = 12 * faces.front();
    for (const size_t face : faces)
        for (size_t i = 0; i < 12; ++i)
            if (surface.colours[12 * face + i] != surface.colours[first + i % 4])
                return std::nullopt;
    Srgb colour;
    for (size_t channel = 0; channel < 3; ++channel)
        colour[channel] = srgb_from_linear(surface.colours[first + channel] * appearance.factor[channel]);
    return colour;
}

/// The areas of some triangles, scaled by the size of the mesh so that nothing overflows.
std::vector<double> areas_of(const FileMesh& mesh, const std::vector<size_t>& faces) {
    double scale = 0;
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        scale = std::max(scale, std::abs(mesh.positions[i]));
    scale = scale > 0 ? scale : 1;
    const double whole = std::min(scale, 1e100) * std::min(scale, 1e100);
    std::vector<double> areas;
    for (const size_t face : faces) {
        double along[3], across[3];
        for (size_t axis = 0; axis < 3; ++axis) {
            const auto corner = [&](size_t k) {
                return mesh.positions[3 * static_cast<size_t>(mesh.triangles[3 * face + k]) + axis] / scale;
            };
            along[axis] = corner(1) - corner(0);
            across[axis] = corner(2) - corner(0);
        }
        const auto dot = [](const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
        const double both = dot(along, across);
        areas.push_back(std::sqrt(std::max(dot(along, along) * dot(across, across) - both * both, 0.0)) * whole);
    }
    return areas;
}

/// Adds the mean colour of some triangles, sampled and weighted by area.
void add_light(Usage& usage, const FileMesh& mesh, const Appearance& appearance, const std::vector<size_t>& faces) {
    std::vector<size_t> some;
    const size_t stride = (faces.size() + kSampledTriangles - 1) / kSampledTriangles;
    for (size_t i = 0; i < faces.size(); i += stride)
        some.push_back(faces[i]);
    int n = 1;
    while (static_cast<size_t>(n + 1) * static_cast<size_t>(n + 1) <= kSamples / some.size())
        ++n;
    const std::vector<Barycentric> places = centroids(n);
    std::optional<Texture> texture = appearance.texture;
    if (texture)
        texture->nearest = true;
    const std::vector<double> areas = areas_of(mesh, some);
    const double largest = *std::max_element(areas.begin(), areas.end());
    double whole = 0, shares = 0;
    std::array<double, 3> light{};
    for (size_t i = 0; i < some.size(); ++i) {
        whole += areas[i];
        const TrianglePaint paint(*mesh.surface, some[i], appearance, texture ? &*texture : nullptr);
        for (const Barycentric& place : places) {
            const Light found = paint.at(place);
            const double share = (areas[i] / (largest > 0 ? largest : 1) + kLittle) *
                                 (kLittle + (found[3] >= appearance.cutoff ? 1 : 0));
            shares += share;
            for (size_t channel = 0; channel < 3; ++channel)
                light[channel] += share * found[channel];
        }
    }
    const double area = whole * double(faces.size()) / double(some.size()) + kLeast;
    for (size_t channel = 0; channel < 3; ++channel)
        usage.light[channel] += light[channel] / shares * area;
    usage.area += area;
}

std::vector<Usage> usages_of(std::vector<FileMesh>& meshes, int threads) {
    std::vector<Usage> usages;
    std::map<std::pair<std::string, bool>, size_t> numbers;
    for (size_t at = 0; at < meshes.size(); ++at) {
        FileMesh& mesh = meshes[at];
        if (!mesh.surface)
            continue;
        const Surface& surface = *mesh.surface;
        mesh.rows.assign(surface.rows.begin(), surface.rows.end());
        const std::vector<uint8_t> solid = visible_triangles(surface, threads);
        std::vector<std::vector<size_t>> faces(surface.entries.size());
        for (size_t t = 0; t < surface.size(); ++t) {
            if (surface.rows[t] < 0)
                continue;
            if (solid[t])
                faces[static_cast<size_t>(surface.rows[t])].push_back(t);
            else
                ++mesh.transparent;
        }
        for (size_t row = 0; row < faces.size(); ++row) {
            if (faces[row].empty())
                continue;
            const Appearance& appearance = surface.entries[row];
            const auto [place, fresh] = numbers.try_emplace({appearance.name, appearance.mirror}, usages.size());
            if (fresh)
                usages.push_back({appearance.name, appearance.mirror, {}, {}, false, {}, 0});
            Usage& usage = usages[place->second];
            const std::optional<Srgb> colour = only_colour(surface, appearance, faces[row]);
            usage.varies |= !colour || (!usage.faces.empty() && usage.colour != colour);
            usage.colour = colour;
            add_light(usage, mesh, appearance, faces[row]);
            usage.faces.emplace_back(at, std::move(faces[row]));
        }
    }
    return usages;
}

/// Adds the materials of appearances and returns their ids; too many appearances share materials.
std::vector<uint8_t> numbered(const std::vector<Usage>& usages, MaterialTable& table) {
    size_t free = MaterialTable::kLimit + 1 - table.entries().size();
    if (free < 1 && !usages.empty())
        throw TooManyMaterials("the uniform materials take all 255 ids and leave none for textures and vertex colours; "
                               "merge some in the asset");
    if (std::any_of(usages.begin(), usages.end(), [](const Usage& one) { return one.varies; }))
        free = (free + 1) / 2; // the other half is for assign_colours
    std::vector<Srgb> means, colours;
    std::vector<double> areas;
    for (const Usage& one : usages) {
        Srgb mean;
        for (size_t channel = 0; channel < 3; ++channel)
            mean[channel] = srgb_from_linear(one.light[channel] / one.area);
        means.push_back(mean);
        colours.push_back(one.varies ? mean : *one.colour);
        areas.push_back(one.area);
    }
    std::vector<uint8_t> ids;
    if (usages.size() <= free) {
        for (size_t i = 0; i < usages.size(); ++i)
            ids.push_back(table.add({usages[i].name, colours[i], usages[i].mirror}));
        return ids;
    }
    const Palette palette = quantize(means, std::span<const double>(areas), static_cast<int>(free));
    std::map<std::pair<uint8_t, bool>, uint8_t> id_of;
    for (size_t i = 0; i < usages.size(); ++i) {
        const auto [place, fresh] = id_of.try_emplace({palette.rows[i], usages[i].mirror}, uint8_t{0});
        if (fresh)
            place->second = table.add({usages[i].name, palette.entries[palette.rows[i]], usages[i].mirror});
        ids.push_back(place->second);
    }
    return ids;
}

} // namespace

void assign_materials(std::vector<FileMesh>& meshes, MaterialTable& table, int threads) {
    const std::vector<Usage> usages = usages_of(meshes, threads);
    const std::vector<uint8_t> ids = numbered(usages, table);
    for (size_t i = 0; i < usages.size(); ++i)
        for (const auto& [at, faces] : usages[i].faces)
            for (const size_t face : faces) {
                meshes[at].materials[face] = ids[i];
                if (!usages[i].varies)
                    meshes[at].rows[face] = -1;
            }
}

} // namespace voxrt::voxelize
