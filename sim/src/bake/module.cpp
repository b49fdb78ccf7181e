// voxrt.sim._bake: the light that surface voxels receive, for Python. The headers are the manual.
#include "brick_triangles.h"
#include "corner_normals.h"
#include "exposed_bricks.h"
#include "received_light.h"
#include "surface_points.h"

#include <voxrt/octree/query.h>
#include <voxrt/voxelize/python.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;
using namespace voxrt::sim;
using voxrt::octree::VerifiedMemory;
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

NamedTuple surface_type, received_type;

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

nb::object bind_corner_normals(const Rows<double, 3>& positions, const Rows<std::int32_t, 3>& triangles,
                               double least_cosine) {
    const auto vertices = static_cast<std::int64_t>(positions.shape(0));
    const std::size_t count = triangles.shape(0);
    for (std::size_t i = 0; i < 3 * count; ++i)
        require(triangles.data()[i] >= 0 && triangles.data()[i] < vertices, "a triangle has no such vertex");
    require(count <= std::size_t{1} << 30 && vertices < std::int64_t{1} << 31, "the mesh is too large");
    std::vector<float> normals;
    {
        const LongCall call;
        normals = corner_normals(positions.data(), positions.shape(0), triangles.data(), count, least_cosine);
    }
    return to_numpy(std::move(normals), {count, 3, 3});
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

const LightEngine& engine_of(const std::string& instructions) {
    for (const LightEngine& engine : light_engines())
        if (instructions.empty() || instructions == engine.instructions)
            return engine;
    throw std::invalid_argument("this processor has no instruction set '" + instructions + "'");
}

Method method_of(const std::string& name) {
    if (name == "rays")
        return Method::rays;
    if (name == "sweep")
        return Method::sweep;
    require(name == "automatic", "there is no method '" + name + "'");
    return Method::automatic;
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
    const LightEngine& engine = engine_of(instructions);
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
    nb::list instruction_sets;
    for (const LightEngine& engine : light_engines())
        instruction_sets.append(engine.instructions);
    m.attr("INSTRUCTION_SETS") = nb::tuple(instruction_sets);
    surface_type = NamedTuple(
        m, "Surface",
        {"brick_codes", "cells", "octant_codes", "octant_levels", "octant_materials", "voxels", "origins", "normals"},
        "What measure_surface() returns.");
    received_type = NamedTuple(m, "Received", {"received", "full"}, "What receive_light() returns.");
    m.def("corner_normals", &bind_corner_normals, "positions"_a, "triangles"_a, "least_cosine"_a,
          "Unit normals of the corners of a mesh, float32 (T, 3, 3): corner_normals.h.");
    m.def("measure_surface", &bind_measure_surface, "words"_a, "depth"_a, "corners"_a, "normals"_a, "threads"_a,
          "The exposed voxels of a memory, and the points where their light is measured: exposed_bricks.h and\n"
          "surface_points.h. corners (T, 3, 3) float64 in voxels, normals (T, 3, 3) float32.");
    m.def("receive_light", &bind_receive_light, "words"_a, "depth"_a, "voxels"_a, "normals"_a, "steps"_a, "units"_a,
          "weights"_a, "threads"_a, "method"_a = "automatic", "instructions"_a = "",
          "The light that points receive: received_light.h. ValueError: a number out of range.");
}
