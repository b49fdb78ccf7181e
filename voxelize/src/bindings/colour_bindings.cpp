#include "colour_bindings.h"

#include "../colour/assign_colours.h"
#include "../colour/assign_materials.h"
#include "../colour/palette.h"
#include "../colour/srgb.h"
#include "python.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <variant>

namespace nb = nanobind;

namespace voxrt::voxelize {
namespace {

template <typename T> using InputOf = nb::ndarray<const T, nb::numpy, nb::c_contig, nb::device::cpu>;
using Floats = std::variant<InputOf<double>, InputOf<float>>;
using TextureArrays = std::tuple<InputOf<uint8_t>, int, int, bool>;
using AppearanceFields = std::tuple<std::string, Light, std::optional<TextureArrays>, double, bool>;
using SurfaceArrays = std::tuple<std::vector<AppearanceFields>, InputOf<int32_t>, Floats, Floats>;
using FileMeshArrays = std::tuple<Floats, InputOf<int32_t>, InputOf<uint8_t>, std::optional<SurfaceArrays>>;
using VariedMeshArrays = std::tuple<Floats, InputOf<int32_t>, InputOf<uint8_t>, SurfaceArrays>;
using MaterialFields = std::tuple<std::string, Srgb, bool, bool>;

template <typename T> std::span<const T> span_of(const InputOf<T>& array) { return {array.data(), array.size()}; }
Numbers numbers_of(const Floats& array) {
    return std::visit([](const auto& one) { return Numbers(span_of(one)); }, array);
}

void require(bool condition, const char* message) {
    if (!condition)
        throw nb::value_error(message);
}

Texture texture_of(const TextureArrays& arrays) {
    const auto& [pixels, wrap_u, wrap_v, nearest] = arrays;
    require(pixels.ndim() == 3 && pixels.shape(2) == 4 && pixels.size() > 0, "pixels must have shape (H, W, 4)");
    require(wrap_u >= 0 && wrap_u <= 2 && wrap_v >= 0 && wrap_v <= 2, "wraps must be 0 … 2");
    return {{pixels.data(), static_cast<int64_t>(pixels.shape(1)), static_cast<int64_t>(pixels.shape(0))},
            static_cast<Wrap>(wrap_u),
            static_cast<Wrap>(wrap_v),
            nearest};
}

/// A surface and its entries, of arrays that live as long.
class SurfaceOf {
public:
    explicit SurfaceOf(const SurfaceArrays& arrays) {
        const auto& [fields, rows, uv, colours] = arrays;
        for (const auto& [name, factor, texture, cutoff, mirror] : fields)
            entries_.push_back(
                {name, factor, texture ? std::optional(texture_of(*texture)) : std::nullopt, cutoff, mirror});
        surface_ = {entries_, span_of(rows), numbers_of(uv), numbers_of(colours)};
        require(surface_.uv.size() == 6 * surface_.size(), "uv must have shape (T, 3, 2)");
        require(surface_.colours.size() == 12 * surface_.size(), "colours must have shape (T, 3, 4)");
        for (const int32_t row : surface_.rows)
            require(row >= -1 && row < static_cast<int32_t>(entries_.size()), "rows must be -1 or index entries");
    }

    const Surface& surface() const { return surface_; }

private:
    std::vector<Appearance> entries_;
    Surface surface_;
};

void check_mesh(const Numbers& positions, const InputOf<int32_t>& triangles, const InputOf<uint8_t>& materials,
                const std::optional<Surface>& surface) {
    const size_t count = materials.size();
    require(triangles.size() == 3 * count, "triangles must have shape (T, 3), materials (T,)");
    require(!surface || surface->size() == count, "a surface must have a row for each triangle");
    for (const int32_t corner : span_of(triangles))
        require(corner >= 0 && static_cast<size_t>(corner) < positions.size() / 3, "triangles must index positions");
}

nb::object sample_surface(const SurfaceArrays& arrays, const InputOf<int64_t>& triangles,
                          const InputOf<double>& weights) {
    const SurfaceOf of(arrays);
    const size_t count = triangles.size();
    require(weights.size() == 3 * count, "weights must have shape (N, 3)");
    std::vector<double> out;
    out.reserve(4 * count);
    for (size_t i = 0; i < count; ++i) {
        const int64_t t = triangles.data()[i];
        require(t >= 0 && static_cast<size_t>(t) < of.surface().size() &&
                    of.surface().rows[static_cast<size_t>(t)] >= 0,
                "triangles must have an appearance");
        const double* shares = weights.data() + 3 * i;
        const Light found = sample(of.surface(), static_cast<size_t>(t), {shares[0], shares[1], shares[2]});
        out.insert(out.end(), found.begin(), found.end());
    }
    return python::to_numpy(std::move(out), {count, 4});
}

nb::object visible(const SurfaceArrays& arrays) {
    const SurfaceOf of(arrays);
    std::vector<uint8_t> found;
    {
        const python::LongCall call;
        found = visible_triangles(of.surface(), 0);
    }
    const size_t count = found.size();
    return python::to_numpy(std::move(found), {count});
}

nb::object halved_image(const InputOf<uint8_t>& pixels) {
    const Image image = texture_of({pixels, 0, 0, false}).image;
    return python::to_numpy(halved(image, 0), {size_t(image.height + 1) / 2, size_t(image.width + 1) / 2, 4});
}

nb::object assign(const std::vector<FileMeshArrays>& arrays, MaterialTable& table) {
    std::vector<SurfaceOf> surfaces;
    std::vector<FileMesh> meshes;
    surfaces.reserve(arrays.size());
    for (const auto& [positions, triangles, materials, surface] : arrays) {
        const std::optional<Surface> own =
            surface ? std::optional(surfaces.emplace_back(*surface).surface()) : std::nullopt;
        check_mesh(numbers_of(positions), triangles, materials, own);
        const std::span<const uint8_t> ids = span_of(materials);
        meshes.push_back({numbers_of(positions), span_of(triangles), own, {ids.begin(), ids.end()}});
    }
    {
        const python::LongCall call;
        assign_materials(meshes, table, 0);
    }
    nb::list out;
    for (FileMesh& mesh : meshes) {
        const size_t count = mesh.materials.size(), rows = mesh.rows.size();
        out.append(nb::make_tuple(python::to_numpy(std::move(mesh.materials), {count}),
                                  python::to_numpy(std::move(mesh.rows), {rows}), mesh.transparent));
    }
    return out;
}

nb::object colour(const std::vector<VariedMeshArrays>& arrays,
                  const std::vector<std::tuple<size_t, InputOf<double>>>& shown,
                  const std::vector<MaterialFields>& fields, const std::vector<bool>& used, double voxel_size,
                  int colours) {
    require(used.size() == 256, "used must have 256 flags");
    require(colours >= 1 && colours <= 254, "colours must be 1 … 254");
    std::vector<SurfaceOf> surfaces;
    std::vector<VariedMesh> meshes;
    surfaces.reserve(arrays.size());
    std::vector<TableMaterial> materials;
    for (const auto& [name, srgb, mirror, authored] : fields)
        materials.push_back({name, srgb, mirror, authored});
    for (const auto& [positions, triangles, ids, surface] : arrays) {
        const Surface& own = surfaces.emplace_back(surface).surface();
        check_mesh(numbers_of(positions), triangles, ids, own);
        for (const uint8_t id : span_of(ids))
            require(id < materials.size(), "materials of triangles must be below those of the scene");
        meshes.push_back({numbers_of(positions), span_of(triangles), span_of(ids), own});
    }
    std::vector<VariedObject> objects;
    for (const auto& [mesh, transform] : shown) {
        require(mesh < meshes.size() && transform.size() >= 12, "objects must index meshes and have a transform");
        objects.push_back({mesh, {}});
        std::copy_n(transform.data(), 12, objects.back().transform.begin());
    }
    std::array<uint8_t, 256> flags;
    std::copy(used.begin(), used.end(), flags.begin());
    Coloured coloured;
    {
        const python::LongCall call;
        coloured = assign_colours(meshes, objects, std::move(materials), flags, voxel_size, colours, 0);
    }
    nb::list table, maps;
    for (const TableMaterial& one : coloured.materials)
        table.append(nb::make_tuple(one.name, nb::make_tuple(one.colour[0], one.colour[1], one.colour[2]), one.mirror,
                                    one.authored));
    for (MaterialMap& map : coloured.meshes) {
        const size_t count = map.materials.size(), cells = map.cells.size();
        maps.append(nb::make_tuple(python::to_numpy(std::move(map.sizes), {count, 2}),
                                   python::to_numpy(std::move(map.coordinates), {count, 3, 2}),
                                   python::to_numpy(std::move(map.cells), {cells}),
                                   python::to_numpy(std::move(map.materials), {count})));
    }
    return nb::make_tuple(table, maps);
}

nb::object quantized(const InputOf<uint8_t>& colours, const InputOf<double>& weights, int count) {
    require(colours.ndim() == 2 && colours.shape(1) == 3, "colours must have shape (N, 3)");
    require(weights.size() == colours.shape(0), "weights must have shape (N,)");
    require(count >= 1 && count <= 255, "count must be 1 … 255");
    Palette palette;
    {
        const python::LongCall call;
        palette = quantize({reinterpret_cast<const Srgb*>(colours.data()), colours.shape(0)}, span_of(weights), count);
    }
    std::vector<uint8_t> entries;
    for (const Srgb& one : palette.entries)
        entries.insert(entries.end(), one.begin(), one.end());
    const size_t rows = palette.rows.size();
    return nb::make_tuple(python::to_numpy(std::move(entries), {palette.entries.size(), 3}),
                          python::to_numpy(std::move(palette.rows), {rows}));
}

nb::object encoded(const InputOf<double>& linear) {
    const SrgbCurve& curve = SrgbCurve::get();
    std::vector<uint8_t> out(linear.size());
    std::transform(linear.data(), linear.data() + linear.size(), out.begin(),
                   [&](double light) { return curve.encode(light); });
    const size_t count = out.size();
    return python::to_numpy(std::move(out), {count});
}

constexpr auto kSampleManual =
    R"(The colour of points: float64, shape (N, 4), linear red, green, blue and alpha.

`surface`: entries (name, factor, texture or None, cutoff, mirror), where a texture is (pixels (H, W, 4) uint8, wrap along
u and along v: 0 repeat, 1 mirror, 2 clamp; nearest); rows (T,); uv (T, 3, 2); colours (T, 3, 4), each float32 or float64.
`triangles` (N,), whose rows are not -1. `weights` (N, 3): barycentric coordinates.)";

constexpr auto kAssignMaterialsManual =
    R"(Give each triangle with an appearance a material of `table` (src/colour/assign_materials.h).

`meshes`: positions (V, 3), triangles (T, 3), materials (T,), and a surface as sample_surface() takes it, or None. Returns
for each its materials, 0 where fully transparent; its rows, -1 where a plain material stands for the appearance, empty
without a surface; and how many triangles are transparent. TooManyMaterialsError: no ids are left.)";

constexpr auto kAssignColoursManual =
    R"(Give triangles with an appearance materials that vary (src/colour/assign_colours.h).

`meshes`: positions, triangles, materials, surface. `objects`: the index of a mesh and a transform, 3 rows of 4 or more.
`materials`: name, colour, mirror, authored of each. `used`: 256 flags. Returns the materials with the palette, and for
each mesh the sizes (T, 2), coordinates (T, 3, 2) and materials of its rasters, and one material for each triangle.
TooManyMaterialsError: no ids are left.)";

} // namespace

void bind_colour(nb::module_& m) {
    m.def("sample_surface", &sample_surface, nb::arg("surface"), nb::arg("triangles"), nb::arg("weights"),
          kSampleManual);
    m.def("visible_triangles", &visible, nb::arg("surface"),
          "Which triangles have an appearance and are not fully transparent: uint8, shape (T,).");
    m.def("halved_image", &halved_image, nb::arg("pixels"),
          "An image (H, W, 4) with half as many pixels per side, rounded up: means of 2 by 2, in linear light and\n"
          "weighted by alpha.");
    m.def("assign_materials", &assign, nb::arg("meshes"), nb::arg("table"), kAssignMaterialsManual);
    m.def("assign_colours", &colour, nb::arg("meshes"), nb::arg("objects"), nb::arg("materials"), nb::arg("used"),
          nb::arg("voxel_size"), nb::arg("colours"), kAssignColoursManual);
    m.def("quantize", &quantized, nb::arg("colours"), nb::arg("weights"), nb::arg("count"),
          "At most `count` colours that represent `colours` (N, 3), sRGB, of which each covers its weight (N,): the\n"
          "palette (K, 3), ascending, and each colour's entry (N,).");
    m.def("srgb_from_linear", &encoded, nb::arg("linear"), "Linear light (N,) as sRGB of 8 bits (N,).");
    m.def(
        "linear_of_srgb",
        [] {
            const std::array<double, 256>& linear = SrgbCurve::get().linear();
            return python::to_numpy(std::vector<double>(linear.begin(), linear.end()), {256});
        },
        "The linear light of each code of sRGB: float64, shape (256,).");
}

} // namespace voxrt::voxelize
