// voxrt.sim._bake: the light that surface voxels receive, for Python. The headers are the manual.
#include "../light/baked_light.h"
#include "../light/daylight.h"
#include "../light/received_light.h"
#include "../surface/brick_triangles.h"
#include "../surface/exposed_bricks.h"
#include "../surface/placed_triangles.h"
#include "../surface/surface_points.h"

#include <voxrt/octree/query/query.h>
#include <voxrt/voxelize/bindings/python.h>
#include <voxrt/voxelize/vectors/instruction_sets.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;
using namespace voxrt::sim;
using voxrt::octree::VerifiedMemory;
using voxrt::python::instruction_sets;
using voxrt::python::LongCall;
using voxrt::python::NamedTuple;
using voxrt::python::to_numpy;

namespace {

template <typename T> using Vector = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <typename T, int Columns>
using Rows = nb::ndarray<const T, nb::shape<-1, Columns>, nb::c_contig, nb::device::cpu>;
template <typename T> using Corners = nb::ndarray<const T, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;

constexpr int kThreadLimit = 1024;
constexpr std::int32_t kWeightLimit = 1 << 16;
constexpr std::size_t kDirectionCountLimit = 1 << 16; // sums stay below 2^60

NamedTuple surface_type, received_type, directions_type, lit_type;

void require(bool condition, const std::string& message) {
    if (!condition)
        throw std::invalid_argument(message);
}

void require_threads(int threads) {
    require(threads >= 0 && threads <= kThreadLimit, "threads is " + std::to_string(threads) + ", not 0 ... 1024");
}

voxrt::octree::Memory memory_of(const Vector<std::uint32_t>& words, int depth) {
    return {words.data(), words.shape(0), depth < 0 ? 0 : static_cast<unsigned>(depth)};
}

nb::object arrays_of(Directions&& directions) {
    const std::size_t count = directions.weights.size();
    return directions_type(to_numpy(std::move(directions.steps), {count, 3}),
                           to_numpy(std::move(directions.units), {count, 3}),
                           to_numpy(std::move(directions.weights), {count}));
}

template <typename Array> auto span_of(const Array& array) { return std::span(array.data(), array.size()); }

using MeshArrays = std::tuple<Rows<double, 3>, Rows<std::int32_t, 3>, Rows<double, 3>, Rows<std::int32_t, 3>>;
using ObjectArrays = std::tuple<std::size_t, nb::ndarray<const double, nb::shape<3, 4>, nb::c_contig, nb::device::cpu>>;

nb::object bind_place_triangles(const std::vector<MeshArrays>& meshes, const std::vector<ObjectArrays>& objects,
                                const std::array<double, 3>& origin, double voxel_size) {
    std::vector<NormalMesh> views;
    std::vector<PlacedMesh> placed;
    for (const auto& [positions, triangles, directions, rows] : meshes) {
        const auto require_below = [](const Rows<std::int32_t, 3>& indices, std::size_t count, std::int32_t least) {
            for (const std::int32_t index : span_of(indices))
                require(index >= least && index < static_cast<std::int64_t>(count), "an index is out of range");
        };
        require(triangles.shape(0) <= std::size_t{1} << 30 && positions.shape(0) < std::size_t{1} << 31,
                "a mesh is too large");
        require(rows.shape(0) == 0 || rows.shape(0) == triangles.shape(0), "rows and triangles differ in length");
        require_below(triangles, positions.shape(0), 0);
        require_below(rows, directions.shape(0), -1);
        views.push_back({span_of(positions), span_of(triangles), span_of(directions), span_of(rows)});
    }
    for (const auto& [mesh, transform] : objects) {
        require(mesh < views.size(), "an object has no such mesh");
        placed.push_back({mesh, {}});
        std::copy_n(transform.data(), 12, placed.back().transform.begin());
    }
    PlacedTriangles found;
    {
        const LongCall call;
        found = place_triangles(views, placed, origin, voxel_size);
    }
    const std::size_t count = found.corners.size() / 9;
    return nb::make_tuple(to_numpy(std::move(found.corners), {count, 3, 3}),
                          to_numpy(std::move(found.normals), {count, 3, 3}));
}

using MaterialFields = std::tuple<std::string, std::array<std::uint8_t, 3>, bool, bool>;

std::vector<voxrt::voxelize::TableMaterial> table_of(const std::vector<MaterialFields>& materials) {
    std::vector<voxrt::voxelize::TableMaterial> table;
    for (const auto& [name, colour, mirror, authored] : materials)
        table.push_back({name, colour, mirror, authored});
    return table;
}

nb::object bind_light_voxels(const Vector<std::uint64_t>& points, const Rows<std::uint8_t, kBrickVoxels>& cells,
                             const Vector<std::int64_t>& sun, const Vector<std::int64_t>& sky,
                             const Vector<std::int64_t>& open_sky, const std::vector<MaterialFields>& materials,
                             const std::array<double, 3>& towards_sun, const std::array<double, 3>& sky_light) {
    const std::size_t count = points.shape(0);
    require(sun.shape(0) == count && sky.shape(0) == count && open_sky.shape(0) == count, "points differ in length");
    for (const std::uint64_t row : span_of(points))
        require(row < cells.size() && cells.data()[row] < materials.size(), "a point has no such voxel or material");
    LitVoxels lit = light_voxels(span_of(points), span_of(cells), {span_of(sun), span_of(sky), span_of(open_sky)},
                                 table_of(materials), {towards_sun, sky_light, 1});
    const std::size_t found = lit.rows.size();
    std::vector<std::uint8_t> colours;
    for (const auto& one : lit.colours)
        colours.insert(colours.end(), one.begin(), one.end());
    return lit_type(to_numpy(std::move(lit.rows), {found}), to_numpy(std::move(lit.sun), {found}),
                    to_numpy(std::move(lit.sky), {found}), to_numpy(std::move(colours), {found, 3}));
}

nb::object bind_bake_memory(int depth, const Vector<std::uint64_t>& codes,
                            const Rows<std::uint8_t, kBrickVoxels>& cells, const Vector<std::uint64_t>& octant_codes,
                            const Vector<std::uint8_t>& octant_levels, const Vector<std::uint8_t>& octant_materials,
                            const Vector<std::uint64_t>& rows, const Rows<std::uint8_t, 3>& colours,
                            const std::vector<MaterialFields>& materials, int count, int threads) {
    require_threads(threads);
    require(count >= 1 && count <= kMostBakedColours, "count is not 1 ... 254");
    require(codes.shape(0) == cells.shape(0), "codes and cells differ in length");
    require(octant_codes.shape(0) == octant_levels.shape(0) && octant_codes.shape(0) == octant_materials.shape(0),
            "the octants' arrays differ in length");
    require(rows.shape(0) == colours.shape(0), "rows and colours differ in length");
    for (const std::uint64_t row : span_of(rows))
        require(row < cells.size(), "a row has no voxel");
    for (const auto& ids : {span_of(cells), span_of(octant_materials)})
        for (const std::uint8_t id : ids)
            require(id < materials.size(), "a voxel has no such material");
    BakedMemory made;
    {
        const LongCall call;
        made = bake_memory({static_cast<unsigned>(depth), span_of(codes), span_of(cells), span_of(octant_codes),
                            span_of(octant_levels), span_of(octant_materials)},
                           span_of(rows),
                           {reinterpret_cast<const voxrt::voxelize::Srgb*>(colours.data()), colours.shape(0)},
                           table_of(materials), count, threads);
    }
    std::vector<MaterialFields> table;
    for (const auto& [name, colour, mirror, authored] : made.materials)
        table.emplace_back(name, colour, mirror, authored);
    const std::size_t words = made.words.size();
    return nb::make_tuple(to_numpy(std::move(made.words), {words}), table);
}

nb::object bind_measure_surface(const Vector<std::uint32_t>& words, int depth, const Corners<double>& corners,
                                const Corners<float>& normals, int threads) {
    require_threads(threads);
    require(corners.shape(0) == normals.shape(0), "corners and normals differ in length");
    ExposedBricks bricks;
    SurfacePoints points;
    {
        const LongCall call;
        const VerifiedMemory memory(memory_of(words, depth));
        bricks = exposed_bricks(memory, threads);
        points = surface_points(memory, bricks, {corners.shape(0), corners.data(), normals.data()}, threads);
    }
    const std::size_t count = bricks.brick_codes.size(), octants = bricks.octant_codes.size();
    const std::size_t found = points.voxels.size();
    return surface_type(
        to_numpy(std::move(bricks.brick_codes), {count}), to_numpy(std::move(bricks.cells), {count, kBrickVoxels}),
        to_numpy(std::move(bricks.octant_codes), {octants}), to_numpy(std::move(bricks.octant_levels), {octants}),
        to_numpy(std::move(bricks.octant_materials), {octants}), to_numpy(std::move(points.voxels), {found}),
        to_numpy(std::move(points.origins), {found, 3}), to_numpy(std::move(points.normals), {found, 3}));
}

// Refuses points that are not near the solid voxels.
void require_near(const voxrt::octree::Memory& memory, const Rows<std::int32_t, 3>& voxels) {
    const auto bounds = voxrt::octree::solid_bounds(memory);
    require(bounds.has_value() || voxels.shape(0) == 0, "nothing is solid, so there are no points");
    for (std::size_t i = 0; i < 3 * voxels.shape(0); ++i)
        require(voxels.data()[i] >= bounds->low[i % 3] - kPointMargin &&
                    voxels.data()[i] < bounds->high[i % 3] + kPointMargin,
                "point " + std::to_string(i / 3) + " lies more than 4 voxels from the box of the solid voxels");
}

nb::object bind_measure_light(const Vector<std::uint32_t>& words, int depth, const Vector<std::uint64_t>& codes,
                              const Vector<std::uint64_t>& voxels, const Rows<std::int32_t, 3>& origins,
                              const Rows<std::int16_t, 3>& normals, const std::array<double, 3>& sun,
                              const std::array<double, 3>& sky, int samples, int threads) {
    require_threads(threads);
    const std::size_t count = voxels.shape(0);
    require(origins.shape(0) == count && normals.shape(0) == count, "voxels, origins and normals differ in length");
    for (std::size_t i = 0; i < count; ++i)
        require(voxels.data()[i] / kBrickVoxels < codes.shape(0), "a voxel is in no brick");
    const SurfacePoints points{{voxels.data(), voxels.data() + count},
                               {origins.data(), origins.data() + 3 * count},
                               {normals.data(), normals.data() + 3 * count}};
    MeasuredLight light;
    {
        const LongCall call;
        const VerifiedMemory memory(memory_of(words, depth));
        require_near(memory.memory(), origins);
        light = measure_light(memory, span_of(codes), points, {sun, sky, samples}, threads);
    }
    const std::size_t found = light.points.size();
    return nb::make_tuple(to_numpy(std::move(light.points), {found}), to_numpy(std::move(light.sun), {found}),
                          to_numpy(std::move(light.sky), {found}), to_numpy(std::move(light.open_sky), {found}));
}

Method method_of(const std::string& name) {
    if (name == "rays")
        return Method::rays;
    if (name == "sweep")
        return Method::sweep;
    require(name == "automatic", "there is no method '" + name + "'");
    return Method::automatic;
}

nb::object bind_receive_light(const Vector<std::uint32_t>& words, int depth, const Rows<std::int32_t, 3>& voxels,
                              const Rows<std::int16_t, 3>& normals, const Rows<std::int32_t, 3>& steps,
                              const Rows<std::int16_t, 3>& units, const Vector<std::int32_t>& weights, int threads,
                              const std::string& method, const std::string& instructions) {
    require_threads(threads);
    const std::size_t count = voxels.shape(0), directions = steps.shape(0);
    require(normals.shape(0) == count, "voxels and normals differ in length");
    require(count >> 32 == 0, "there are 2**32 points or more");
    require(units.shape(0) == directions && weights.shape(0) == directions, "the directions' arrays differ in length");
    require(directions <= kDirectionCountLimit, "there are more than 2**16 directions");
    for (std::size_t d = 0; d < directions; ++d) {
        const std::int32_t* step = steps.data() + 3 * d;
        require(step[0] != 0 || step[1] != 0 || step[2] != 0, "a direction is zero");
        for (int axis = 0; axis < 3; ++axis)
            require(std::abs(std::int64_t{step[axis]}) < kParallelLimit, "a direction is not below 2**11");
        require(weights.data()[d] >= 0 && weights.data()[d] <= kWeightLimit, "a weight is not 0 ... 2**16");
    }
    const LightEngine& engine = voxrt::voxelize::engine_of(light_engines(), instructions);
    auto received = std::make_unique<std::int64_t[]>(count), full = std::make_unique<std::int64_t[]>(count);
    {
        const LongCall call;
        const VerifiedMemory memory(memory_of(words, depth));
        require_near(memory.memory(), voxels);
        receive_light(memory, {count, voxels.data(), normals.data()},
                      {directions, steps.data(), units.data(), weights.data()}, received.get(), full.get(), threads,
                      method_of(method), engine);
    }
    return received_type(to_numpy(std::move(received), {count}), to_numpy(std::move(full), {count}));
}

} // namespace

NB_MODULE(_bake, m) {
    m.attr("INSTRUCTION_SETS") = instruction_sets(light_engines());
    surface_type = NamedTuple(
        m, "Surface",
        {"brick_codes", "cells", "octant_codes", "octant_levels", "octant_materials", "voxels", "origins", "normals"},
        "What measure_surface() returns.");
    received_type = NamedTuple(m, "Received", {"received", "full"}, "What receive_light() returns.");
    directions_type = NamedTuple(m, "Directions", {"steps", "units", "weights"}, "Directions towards light.");
    lit_type = NamedTuple(m, "LitVoxels", {"rows", "sun", "sky", "colours"}, "What light_voxels() returns.");
    m.def(
        "sun_direction", [](const std::array<double, 3>& sun) { return arrays_of(sun_direction(sun)); }, "sun"_a,
        "daylight.h");
    m.def("sky_directions", [](int samples) { return arrays_of(sky_directions(samples)); }, "samples"_a, "daylight.h");
    m.def("place_triangles", &bind_place_triangles, "meshes"_a, "objects"_a, "origin"_a, "voxel_size"_a,
          "placed_triangles.h. meshes: (positions, triangles, directions, rows). objects: (mesh, transform (3, 4)).\n"
          "Returns corners (T, 3, 3) float64 in voxels and normals (T, 3, 3) float32.");
    m.def("light_voxels", &bind_light_voxels, "points"_a, "cells"_a, "sun"_a, "sky"_a, "open_sky"_a, "materials"_a,
          "towards_sun"_a, "sky_light"_a, "baked_light.h. materials: (name, colour, mirror, authored) by id.");
    m.def("bake_memory", &bind_bake_memory, "depth"_a, "codes"_a, "cells"_a, "octant_codes"_a, "octant_levels"_a,
          "octant_materials"_a, "rows"_a, "colours"_a, "materials"_a, "count"_a, "threads"_a,
          "baked_light.h. Returns words and materials.");
    m.def("measure_surface", &bind_measure_surface, "words"_a, "depth"_a, "corners"_a, "normals"_a, "threads"_a,
          "The exposed voxels of a memory, and the points where their light is measured: exposed_bricks.h and\n"
          "surface_points.h. corners (T, 3, 3) float64 in voxels, normals (T, 3, 3) float32.");
    m.def(
        "measure_light", &bind_measure_light, "words"_a, "depth"_a, "brick_codes"_a, "voxels"_a, "origins"_a,
        "normals"_a, "towards_sun"_a, "sky_light"_a, "samples"_a, "threads"_a,
        "baked_light.h. Takes what measure_surface() returns; returns points, and their light of the sun, of the sky\n"
        "and of an open sky.");
    m.def("receive_light", &bind_receive_light, "words"_a, "depth"_a, "voxels"_a, "normals"_a, "steps"_a, "units"_a,
          "weights"_a, "threads"_a, "method"_a = "automatic", "instructions"_a = "",
          "The light that points receive: received_light.h. ValueError: a number out of range.");
}
