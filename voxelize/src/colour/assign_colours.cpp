#include "assign_colours.h"

#include "palette.h"
#include "raster_cells.h"
#include "raster_layout.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace voxrt::voxelize {
namespace {

constexpr double kNoArea = 1e-12; // a cell that covers nothing counts, but less than any other

struct Shown {
    std::array<double, 9> linear{}; // to voxels, of the object that shows the mesh largest
    double size = -1;
    int64_t objects = 0;
};

std::vector<Shown> shown_meshes(size_t meshes, std::span<const VariedObject> objects, double voxel_size) {
    std::vector<Shown> shown(meshes);
    for (const VariedObject& object : objects) {
        std::array<double, 9> linear;
        double size = 0;
        for (size_t i = 0; i < 9; ++i) {
            linear[i] = object.transform[i / 3 * 4 + i % 3] / voxel_size;
            size += std::abs(linear[i]);
        }
        Shown& mesh = shown[object.mesh];
        ++mesh.objects;
        if (mesh.objects == 1 || size > mesh.size) {
            mesh.linear = linear;
            mesh.size = size;
        }
    }
    return shown;
}

/// The ids above the scene's materials, then unused ids among them.
std::deque<int> free_ids(const std::vector<TableMaterial>& materials, const std::array<uint8_t, 256>& used) {
    std::deque<int> free;
    for (size_t id = materials.size(); id <= MaterialTable::kLimit; ++id)
        free.push_back(static_cast<int>(id));
    for (size_t id = 1; id < materials.size(); ++id)
        if (!materials[id].authored && !used[id])
            free.push_back(static_cast<int>(id));
    return free;
}

std::string hexadecimal(const Srgb& colour) {
    std::string text = "#";
    for (const uint8_t channel : colour)
        for (const int digit : {channel >> 4, channel & 15})
            text += "0123456789abcdef"[digit];
    return text;
}

/// The palette of all cells, and its materials. An entry is split in two where it is both of mirrors and of others.
class PaletteMaterials {
public:
    PaletteMaterials(const std::vector<RasterCells>& meshes, std::vector<TableMaterial>& materials,
                     std::deque<int> free, int colours) {
        std::vector<Srgb> found;
        std::vector<double> weights;
        std::vector<uint8_t> owners;
        bool kinds[2] = {};
        for (const RasterCells& cells : meshes)
            for (size_t i = 0; i < cells.colours.size(); ++i)
                if (cells.solid[i]) {
                    found.push_back(cells.colours[i]);
                    weights.push_back(cells.weights[i]);
                    owners.push_back(cells.owners[i]);
                    kinds[materials[cells.owners[i]].mirror] = true;
                }
        const size_t number = std::max<size_t>(1, size_t{kinds[0]} + kinds[1]);
        if (free.size() < number)
            throw TooManyMaterials(
                "its own materials take all 255 ids and leave none for textures and vertex colours; merge some in the "
                "asset");
        const Palette palette =
            quantize(found, std::span<const double>(weights),
                     static_cast<int>(std::min<size_t>(static_cast<size_t>(colours), free.size() / number)));
        std::vector<std::array<double, 256>> cover(2 * palette.entries.size());
        rows_.reserve(found.size());
        for (size_t i = 0; i < found.size(); ++i) {
            const size_t entry = 2 * size_t{palette.rows[i]} + materials[owners[i]].mirror;
            rows_.push_back(static_cast<uint16_t>(entry));
            cover[entry][owners[i]] += weights[i] + kNoArea;
        }
        std::vector<std::pair<size_t, size_t>> named; // owner and entry
        for (size_t entry = 0; entry < cover.size(); ++entry) {
            const auto most = std::max_element(cover[entry].begin(), cover[entry].end());
            if (*most > 0)
                named.emplace_back(most - cover[entry].begin(), entry);
        }
        std::sort(named.begin(), named.end());
        ids_.resize(cover.size());
        for (const auto& [owner, entry] : named) {
            const Srgb colour = palette.entries[entry / 2];
            if (materials[owner].colour == colour) {
                ids_[entry] = static_cast<uint8_t>(owner);
                continue;
            }
            const auto id = static_cast<size_t>(free.front());
            free.pop_front();
            TableMaterial made{materials[owner].name + " " + hexadecimal(colour), colour, materials[owner].mirror};
            if (id == materials.size())
                materials.push_back(std::move(made));
            else
                materials[id] = std::move(made);
            ids_[entry] = static_cast<uint8_t>(id);
        }
    }

    /// The material of the next solid cell.
    uint8_t next() { return ids_[rows_[at_++]]; }

private:
    std::vector<uint8_t> ids_;   // by entry
    std::vector<uint16_t> rows_; // the entry of each solid cell
    size_t at_ = 0;
};

MaterialMap map_of(const VariedMesh& mesh, std::span<const TriangleLayout> layouts, const RasterCells& cells,
                   PaletteMaterials& palette) {
    MaterialMap map;
    for (const TriangleLayout& layout : layouts) {
        map.sizes.insert(map.sizes.end(), {layout.columns, layout.rows});
        for (const auto& corner : raster_corners(layout))
            map.coordinates.insert(map.coordinates.end(), corner.begin(), corner.end());
    }
    std::array<double, 256> cover{};
    map.cells.resize(cells.colours.size());
    for (size_t i = 0; i < map.cells.size(); ++i)
        if (cells.solid[i]) {
            map.cells[i] = palette.next();
            cover[map.cells[i]] += double{cells.weights[i] + static_cast<float>(kNoArea)};
        }
    const auto most = std::max_element(cover.begin() + 1, cover.end()) - cover.begin();
    for (size_t t = 0; t < mesh.materials.size(); ++t) // where all is cut away, the materials stay
        map.materials.push_back(mesh.surface.rows[t] >= 0 && cover[most] > 0 ? static_cast<uint8_t>(most)
                                                                             : mesh.materials[t]);
    return map;
}

} // namespace

Coloured assign_colours(std::span<const VariedMesh> meshes, std::span<const VariedObject> objects,
                        std::vector<TableMaterial> materials, const std::array<uint8_t, 256>& used, double voxel_size,
                        int colours, int threads) {
    const std::vector<Shown> shown = shown_meshes(meshes.size(), objects, voxel_size);
    std::vector<std::vector<TriangleLayout>> layouts;
    for (size_t i = 0; i < meshes.size(); ++i)
        layouts.push_back(lay_out(meshes[i].positions, meshes[i].triangles, meshes[i].surface.rows, shown[i].linear));
    fit_rasters(layouts);
    std::vector<RasterCells> cells;
    {
        ReducedImages images(threads);
        for (size_t i = 0; i < meshes.size(); ++i)
            cells.push_back(
                colour_rasters(meshes[i].surface, layouts[i], meshes[i].materials, shown[i].objects, images, threads));
    }
    Coloured coloured{std::move(materials), {}};
    PaletteMaterials palette(cells, coloured.materials, free_ids(coloured.materials, used), colours);
    for (size_t i = 0; i < meshes.size(); ++i)
        coloured.meshes.push_back(map_of(meshes[i], layouts[i], cells[i], palette));
    return coloured;
}

} // namespace voxrt::voxelize
