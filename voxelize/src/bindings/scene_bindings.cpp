#include "scene_bindings.h"

#include "../scene/area_by_place.h"
#include "../scene/grid_fit.h"
#include "../scene/material_table.h"
#include "../scene/object_warnings.h"
#include "../scene/projected_area.h"
#include "../scene/used_vertices.h"
#include "python.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>
#include <variant>

namespace nb = nanobind;

namespace voxrt::voxelize {
namespace {

template <typename T> using InputOf = nb::ndarray<const T, nb::numpy, nb::c_contig, nb::device::cpu>;
using Points = std::variant<InputOf<double>, InputOf<float>>;
using Cloud = std::tuple<Points, InputOf<int32_t>, InputOf<double>>;
using Triple = std::array<double, 3>;

template <typename T> std::span<const T> span_of(const InputOf<T>& array) { return {array.data(), array.size()}; }

void check(const InputOf<int32_t>& triangles, size_t vertices) {
    for (size_t i = 0; i < triangles.size(); ++i)
        if (triangles.data()[i] < 0 || static_cast<size_t>(triangles.data()[i]) >= vertices)
            throw nb::value_error("triangles must index positions");
    if (triangles.size() % 3 != 0)
        throw nb::value_error("triangles must have shape (T, 3)");
}

void check(const Cloud& cloud) {
    const auto& [points, triangles, transforms] = cloud;
    std::visit([&](const auto& positions) { check(triangles, positions.size() / 3); }, points);
    if (transforms.size() % 12 != 0)
        throw nb::value_error("transforms must have shape (N, 3, 4)");
}

std::tuple<Triple, Triple> scene_bounds(const std::vector<Cloud>& clouds, size_t hidden) {
    Bounds bounds;
    {
        const python::LongCall call;
        for (const Cloud& cloud : clouds) {
            check(cloud);
            const auto& [points, triangles, transforms] = cloud;
            const std::span<const double> placed = span_of(transforms);
            std::visit(
                [&](const auto& positions) {
                    std::vector<uint8_t> used;
                    if (triangles.size() > 0)
                        used = spanning_vertices(span_of(triangles), span_of(positions));
                    for (size_t i = 0; i < placed.size(); i += 12)
                        bounds.add(span_of(positions), used, placed.subspan(i).first<12>());
                },
                points);
        }
        bounds.check(hidden);
    }
    return {bounds.low(), bounds.high()};
}

/// Calls visit(positions, triangles, transform) for each copy of a mesh.
template <class Visit> void each_copy(const Cloud& cloud, Visit&& visit) {
    const auto& [points, triangles, transforms] = cloud;
    for (size_t i = 0; i < transforms.size(); i += 12)
        std::visit(
            [&](const auto& positions) {
                visit(span_of(positions), span_of(triangles), span_of(transforms).subspan(i).template first<12>());
            },
            points);
}

/// Adds the copies of a mesh to bounds: the vertices that its triangles use.
void add_used(Bounds& bounds, const Cloud& cloud) {
    const auto& [points, triangles, transforms] = cloud;
    const size_t vertices = std::visit([](const auto& positions) { return positions.size() / 3; }, points);
    const std::vector<uint8_t> used = used_vertices(span_of(triangles), vertices);
    each_copy(cloud, [&](auto positions, auto, auto transform) { bounds.add(positions, used, transform); });
}

std::tuple<std::vector<double>, Triple, Triple> projected_areas(const Cloud& cloud) {
    std::vector<double> areas;
    Bounds bounds;
    const python::LongCall call;
    check(cloud);
    add_used(bounds, cloud);
    each_copy(cloud, [&](auto positions, auto triangles, auto transform) {
        areas.push_back(projected_area(positions, triangles, transform));
    });
    return {std::move(areas), bounds.low(), bounds.high()};
}

std::tuple<nb::object, double> areas_by_place(const std::vector<Cloud>& clouds, size_t bins) {
    if (bins == 0)
        throw nb::value_error("bins must be at least 1");
    Bounds bounds;
    std::vector<double> areas;
    double width = 0;
    {
        const python::LongCall call;
        for (const Cloud& cloud : clouds) {
            check(cloud);
            add_used(bounds, cloud);
        }
        for (size_t axis = 0; axis < 3; ++axis)
            width = std::max(width, bounds.high()[axis] - bounds.low()[axis]);
        AreaByPlace found(bounds.low(), width, bins);
        for (const Cloud& cloud : clouds)
            each_copy(cloud, [&](auto positions, auto triangles, auto transform) {
                found.add(positions, triangles, transform);
            });
        areas = std::move(found.areas());
    }
    return {python::to_numpy(std::move(areas), {3, bins}), width};
}

std::tuple<Triple, double> fit(const Triple& low, const Triple& high, unsigned depth) {
    const FittedGrid grid = fit_grid(low, high, depth);
    return {grid.origin, grid.voxel_size};
}

nb::object placed_vertices(const InputOf<double>& positions, const InputOf<int32_t>& triangles) {
    check(triangles, positions.size() / 3);
    if (triangles.size() == 0)
        return nb::cast(positions);
    const std::vector<uint8_t> spanning = spanning_vertices(span_of(triangles), span_of(positions));
    if (std::all_of(spanning.begin(), spanning.end(), [](uint8_t one) { return one != 0; }))
        return nb::cast(positions);
    auto moved = std::make_unique<double[]>(positions.size());
    std::copy_n(positions.data(), positions.size(), moved.get());
    move_unused_vertices({moved.get(), positions.size()}, span_of(triangles), spanning);
    return python::to_numpy(std::move(moved), {positions.size() / 3, 3});
}

std::vector<std::tuple<std::string, std::string, int64_t>>
warnings_of(const InputOf<int64_t>& voxels, const InputOf<uint8_t>& modes, const InputOf<int64_t>& notes,
            const std::vector<std::string>& names, const std::vector<bool>& reported) {
    const size_t count = names.size();
    if (voxels.size() != count || modes.size() != count || notes.size() != kObjectNotes * count ||
        reported.size() != count)
        throw nb::value_error("the arrays of the objects must have one length");
    const std::vector<uint8_t> flags(reported.begin(), reported.end());
    std::vector<ObjectNotes> rows(count);
    for (size_t i = 0; i < notes.size(); ++i)
        rows[i / kObjectNotes][i % kObjectNotes] = notes.data()[i];
    std::vector<std::tuple<std::string, std::string, int64_t>> found;
    for (const ObjectWarning& one : object_warnings({span_of(voxels), span_of(modes), rows, names, flags}))
        found.emplace_back(one.kind, one.message, one.count);
    return found;
}

} // namespace

void bind_scene(nb::module_& m) {
    static PyObject* unfit = PyErr_NewExceptionWithDoc(
        "voxrt.voxelize._native.UnfitSceneError",
        "A scene that no grid fits; the arguments are what is wrong, and how to fix it.", PyExc_ValueError, nullptr);
    m.attr("UnfitSceneError") = nb::handle(unfit);
    static PyObject* too_many = PyErr_NewExceptionWithDoc("voxrt.voxelize._native.TooManyMaterialsError",
                                                          "More than 255 materials.", PyExc_ValueError, nullptr);
    m.attr("TooManyMaterialsError") = nb::handle(too_many);
    nb::register_exception_translator(
        [](const std::exception_ptr& failure, void*) {
            try {
                std::rethrow_exception(failure);
            } catch (const UnfitScene& e) {
                PyErr_SetObject(unfit, nb::make_tuple(e.what(), e.fix).ptr());
            } catch (const TooManyMaterials& e) {
                PyErr_SetString(too_many, e.what());
            }
        },
        nullptr);
    m.def(
        "scene_bounds", &scene_bounds, nb::arg("clouds"), nb::arg("hidden"),
        "The lowest and the highest corner of point clouds, metres: positions (V, 3) float64 or float32; triangles\n"
        "(T, 3) int32, whose vertices count, or none, where all do; transforms (N, 3, 4) float64 to the scene frame.\n"
        "UnfitSceneError: no point, or a coordinate that is not finite; `hidden` objects are named then.");
    m.def(
        "projected_areas", &projected_areas, nb::arg("cloud"),
        "The area of each copy of a mesh, and the lowest and the highest corner of all, metres. A triangle counts as\n"
        "seen along the axis that it faces most. `cloud`: as of scene_bounds(), with triangles.");
    m.def(
        "areas_by_place", &areas_by_place, nb::arg("clouds"), nb::arg("bins"),
        "The area of triangles by where their middles lie along each axis, float64 of shape (3, bins), square metres;\n"
        "and how wide all bins of an axis are, metres: the longest side. `clouds`: as of scene_bounds(), with\n"
        "triangles.");
    m.def("fit_grid", &fit, nb::arg("low"), nb::arg("high"), nb::arg("depth"),
          "Origin and voxel size of the smallest grid of a depth that holds a box. UnfitSceneError: it overflows.");
    m.def("longest_side", &longest_side, nb::arg("low"), nb::arg("high"),
          "The longest side of a box. UnfitSceneError: it overflows.");
    m.def("placed_vertices", &placed_vertices, nb::arg("positions"), nb::arg("triangles"),
          "Positions (V, 3) float64 with those that no triangle (T, 3) uses moved to one that is used.");
    m.def("object_warnings", &warnings_of, nb::arg("voxels"), nb::arg("modes"), nb::arg("notes"), nb::arg("names"),
          nb::arg("reported"), "What to tell of a scene's voxels: kind, message and count each. Arguments by object.");
    nb::class_<MaterialTable>(m, "MaterialTable", "Materials under construction; entry 0 is empty space.")
        .def(
            "__init__",
            [](MaterialTable* table, std::string name, const std::array<uint8_t, 3>& colour) {
                new (table) MaterialTable({std::move(name), colour});
            },
            nb::arg("name"), nb::arg("colour"), "`name` and `colour` are those of empty space.")
        .def(
            "add",
            [](MaterialTable& table, std::string name, const std::array<uint8_t, 3>& colour, bool mirror,
               bool authored) { return int{table.add({std::move(name), colour, mirror, authored})}; },
            nb::arg("name"), nb::arg("colour"), nb::arg("mirror"), nb::arg("authored"),
            "Add a material; returns its id. A number is appended to a name that another material has.\n"
            "TooManyMaterialsError: there are 255.")
        .def(
            "entries",
            [](const MaterialTable& table) {
                std::vector<std::tuple<std::string, std::tuple<int, int, int>, bool, bool>> found;
                for (const auto& [name, colour, mirror, authored] : table.entries())
                    found.emplace_back(name, std::tuple(int{colour[0]}, int{colour[1]}, int{colour[2]}), mirror,
                                       authored);
                return found;
            },
            "Name, colour, mirror and authored of each, by id.");
}

} // namespace voxrt::voxelize
