// voxrt.voxelize._native: the voxelizer for Python. The docstrings are the manual; every array is checked here.
#include "../coverage/vector_coverage.h"
#include "../grid/brick.h"
#include "../grid/morton.h"
#include "../scene/convex_hull.h"
#include "../tiles/voxelizer.h"
#include "colour_bindings.h"
#include "python.h"
#include "scene_bindings.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

namespace nb = nanobind;
using namespace voxrt::voxelize;
using voxrt::python::instruction_sets;
using voxrt::python::LongCall;
using voxrt::python::NamedTuple;
using voxrt::python::rows_to_numpy;
using voxrt::python::to_numpy;

namespace {

template <typename T> using InputOf = nb::ndarray<const T, nb::numpy, nb::c_contig, nb::device::cpu>;
using MeshArrays =
    std::tuple<InputOf<double>, InputOf<int32_t>, InputOf<uint8_t>, InputOf<int32_t>, InputOf<float>, InputOf<uint8_t>>;

void require(bool condition, const char* message) {
    if (!condition)
        throw nb::value_error(message);
}

constexpr int32_t kLongestRaster = 1 << 16;

template <typename Array> void require_rows(const Array& array, size_t columns, const char* message) {
    require(array.ndim() == 2 && array.shape(1) == columns, message);
}

/// The first cell of each triangle's raster.
std::vector<int64_t> raster_starts(const MeshArrays& arrays) {
    const auto& [positions, triangles, materials, sizes, coordinates, cells] = arrays;
    std::vector<int64_t> starts(sizes.size() / 2);
    int64_t total = 0;
    for (size_t t = 0; t < starts.size(); ++t) {
        const int64_t columns = sizes.data()[2 * t], rows = sizes.data()[2 * t + 1];
        require(columns >= 0 && columns <= kLongestRaster && rows >= 0 && rows <= kLongestRaster &&
                    (columns == 0) == (rows == 0),
                "rasters must have 1 … 65536 columns and rows, or none");
        starts[t] = total;
        total += columns * rows;
        require(total <= int64_t(cells.size()), "rasters have more cells than there are materials");
    }
    require(cells.ndim() == 1 && int64_t(cells.size()) == total, "rasters have fewer cells than there are materials");
    return starts;
}

MeshView view_mesh(const MeshArrays& arrays, const std::vector<int64_t>& starts) {
    const auto& [positions, triangles, materials, sizes, coordinates, cells] = arrays;
    require_rows(positions, 3, "positions must have shape (V, 3)");
    require_rows(triangles, 3, "triangles must have shape (T, 3)");
    require(materials.ndim() == 1 && (materials.size() == triangles.shape(0) || materials.size() == 0),
            "materials must have shape (T,)");
    const auto vertices = static_cast<int64_t>(positions.shape(0));
    const int32_t* corner = triangles.data();
    int32_t lowest = 0, highest = -1;
    for (size_t i = 0; i < triangles.size(); ++i) {
        lowest = std::min(lowest, corner[i]);
        highest = std::max(highest, corner[i]);
    }
    require(lowest >= 0 && highest < vertices, "triangles must index positions");
    for (size_t i = 0; i < materials.size(); ++i)
        require(materials.data()[i] != 0, "material 0 is empty space");
    require_rows(sizes, 2, "raster sizes must have shape (T, 2)");
    require(coordinates.ndim() == 3 && coordinates.shape(0) == sizes.shape(0) && coordinates.shape(1) == 3 &&
                coordinates.shape(2) == 2,
            "raster coordinates must have shape (T, 3, 2)");
    require(sizes.shape(0) == triangles.shape(0) || sizes.shape(0) == 0, "raster sizes must have shape (T, 2)");
    return {
        {positions.data(), positions.size()},
        {corner, triangles.size()},
        {materials.data(), materials.size()},
        {{sizes.data(), sizes.size()}, {coordinates.data(), coordinates.size()}, {cells.data(), cells.size()}, starts}};
}

template <typename T> nb::object take(LargeVector<T>& values) {
    const size_t size = values.size();
    return to_numpy(std::move(values), {size});
}
template <typename T, size_t N> nb::object take(LargeVector<std::array<T, N>>& rows) {
    return rows_to_numpy(std::move(rows));
}

NamedTuple voxelized, voxel_block, voxel_volumes;

Thin thin_of(const std::string& name) {
    require(name == "keep" || name == "drop", "thin must be keep or drop");
    return name == "keep" ? Thin::keep : Thin::drop;
}

/// The parts of a scene, with the arrays that they borrow.
class SceneParts {
public:
    SceneParts(int grid_depth, std::vector<MeshArrays> meshes, InputOf<uint8_t> kinds, InputOf<int32_t> mesh_of,
               InputOf<double> frames, InputOf<uint8_t> materials, InputOf<int32_t> objects_of, InputOf<uint8_t> rules,
               InputOf<uint8_t> fills)
        : depth(grid_depth), objects(rules.size()), meshes_(std::move(meshes)), frames_(std::move(frames)) {
        require(depth >= 1 && depth <= 16, "depth must be 1 … 16");
        for (const auto* choices : {&rules, &fills}) {
            require(choices->ndim() == 1 && choices->size() == objects,
                    "rules and fills must have an element per object");
            require(std::all_of(choices->data(), choices->data() + objects, [](uint8_t one) { return one <= 2; }),
                    "rules and fills must be 0 … 2");
        }
        const size_t count = kinds.size();
        require(kinds.ndim() == 1 && mesh_of.ndim() == 1 && materials.ndim() == 1 && objects_of.ndim() == 1 &&
                    mesh_of.size() == count && materials.size() == count && objects_of.size() == count,
                "kinds, meshes, materials and objects of the parts must have shape (P,)");
        require_rows(frames_, 12, "frames must have shape (P, 12)");
        require(frames_.shape(0) == count, "frames must have shape (P, 12)");
        starts_.reserve(meshes_.size());
        views_.reserve(meshes_.size());
        for (const MeshArrays& arrays : meshes_)
            views_.push_back(view_mesh(arrays, starts_.emplace_back(raster_starts(arrays))));
        parts.reserve(count);
        for (size_t p = 0; p < count; ++p) {
            require(kinds.data()[p] <= 3, "kinds must be 0 … 3");
            const auto kind = static_cast<PartKind>(kinds.data()[p]);
            const MeshView* mesh = nullptr;
            if (kind == PartKind::mesh) {
                require(mesh_of.data()[p] >= 0 && size_t(mesh_of.data()[p]) < views_.size(),
                        "mesh_of must index meshes");
                mesh = &views_[mesh_of.data()[p]];
            }
            require(materials.data()[p] != 0 ||
                        (mesh != nullptr && (!mesh->materials.empty() || mesh->triangles.empty())),
                    "a part needs a material");
            require(objects_of.data()[p] >= 0 && size_t(objects_of.data()[p]) < objects,
                    "objects_of must be below the number of objects");
            require(p == 0 || objects_of.data()[p - 1] <= objects_of.data()[p], "objects_of must ascend");
            parts.push_back({kind, mesh, frames_.data() + 12 * p, materials.data()[p], uint32_t(objects_of.data()[p]),
                             static_cast<Rule>(rules.data()[objects_of.data()[p]]),
                             static_cast<Fill>(fills.data()[objects_of.data()[p]])});
        }
    }
    SceneParts(const SceneParts&) = delete;
    SceneParts& operator=(const SceneParts&) = delete;

    const int depth;
    const size_t objects;
    std::vector<PartView> parts;

private:
    std::vector<MeshArrays> meshes_;
    InputOf<double> frames_;
    std::vector<std::vector<int64_t>> starts_;
    std::vector<MeshView> views_;
};

nb::object voxelized_of(SparseVoxels& out) {
    nb::dict seconds;
    const StageSeconds& took = out.seconds;
    for (const auto& [stage, value] :
         {std::pair{"analysis", took.analysis}, std::pair{"bin", took.bin}, std::pair{"coverage", took.coverage},
          std::pair{"fill", took.fill}, std::pair{"holes", took.holes}, std::pair{"order", took.order},
          std::pair{"gather", took.gather}})
        seconds[stage] = value;
    return voxelized(take(out.brick_codes), take(out.brick_masks), take(out.brick_materials), take(out.brick_rows),
                     take(out.cells), take(out.octant_codes), take(out.octant_levels), take(out.octant_materials),
                     take(out.object_voxels), take(out.object_modes), take(out.object_notes), seconds);
}

void require_threads(int threads) { require(threads >= 0 && threads <= 1024, "threads must be 0 … 1024"); }

nb::object voxelize_parts(const SceneParts& scene, const std::string& thin, int threads,
                          const std::string& instructions) {
    require_threads(threads);
    SparseVoxels out;
    {
        const LongCall call;
        out = voxelize(scene.depth, scene.parts, scene.objects, threads, thin_of(thin), instructions);
    }
    return voxelized_of(out);
}

nb::object volumes_of_parts(const SceneParts& scene, int threads, const std::string& instructions) {
    require_threads(threads);
    ObjectVolumes found;
    {
        const LongCall call;
        found = find_volumes(scene.depth, scene.parts, scene.objects, threads, instructions);
    }
    return voxel_volumes(take(found.objects), take(found.voxels), take(found.volumes), take(found.whole),
                         take(found.known));
}

/// A BlockVoxelizer. The parts must outlive it.
constexpr size_t kTallies = 6; // of an object: ObjectTally

class PythonBlockVoxelizer {
public:
    PythonBlockVoxelizer(const SceneParts& scene, const std::string& thin, int threads, InputOf<uint8_t> wanted)
        : side_(1 << scene.depth), objects_(scene.objects) {
        require_threads(threads);
        require(wanted.ndim() == 1 && (wanted.size() == 0 || wanted.size() == objects_),
                "wanted must have an element per object, or none");
        const LongCall call;
        native_ = std::make_unique<BlockVoxelizer>(scene.depth, scene.parts, objects_, threads, thin_of(thin),
                                                   std::span<const uint8_t>(wanted.data(), wanted.size()));
    }

    void use_threads(int threads) {
        require_threads(threads);
        native_->use_threads(threads);
    }

    nb::object blocks(int side) const {
        require(side >= kTileSide && side % kTileSide == 0, "block_side must be a multiple of 64");
        std::vector<int32_t> corners;
        for (const ColumnBlock& block : native_->blocks(side)) {
            corners.push_back(block.x);
            corners.push_back(block.y);
        }
        const size_t count = corners.size() / 2;
        return to_numpy(std::move(corners), {count, 2});
    }

    nb::object objects_of(int x, int y, int side) const {
        return to_numpy(native_->objects_of(block_of(x, y, side)), {objects_});
    }

    nb::object block(int x, int y, int side) {
        const ColumnBlock place = block_of(x, y, side);
        std::vector<ObjectTally> tallies(objects_);
        SparseVoxels out;
        {
            const LongCall call;
            out = native_->block(place, tallies);
        }
        std::vector<int64_t> rows;
        for (const ObjectTally& t : tallies)
            rows.insert(rows.end(),
                        {t.voxels, t.shell_of_open, t.inside_of_open, t.overlaps_itself, t.positive, t.negative});
        return voxel_block(take(out.brick_codes), take(out.brick_masks), take(out.brick_materials),
                           take(out.brick_rows), take(out.cells), take(out.octant_codes), take(out.octant_levels),
                           take(out.octant_materials), to_numpy(std::move(rows), {objects_, kTallies}));
    }

    nb::object report(InputOf<int64_t> tallies) const {
        require_rows(tallies, kTallies, "tallies must have shape (O, 6)");
        require(tallies.shape(0) == objects_, "tallies must have a row per object");
        std::vector<ObjectTally> rows(objects_);
        for (size_t i = 0; i < objects_; ++i) {
            const int64_t* row = tallies.data() + kTallies * i;
            rows[i] = {row[0], row[1], row[2], row[3], row[4], row[5]};
        }
        SparseVoxels out = native_->report(rows);
        out.seconds = native_->seconds();
        return voxelized_of(out);
    }

private:
    ColumnBlock block_of(int x, int y, int side) const {
        require(side >= kTileSide && side % kTileSide == 0, "block_side must be a multiple of 64");
        require(x >= 0 && x < side_ && x % kTileSide == 0 && y >= 0 && y < side_ && y % kTileSide == 0,
                "a block must begin at a multiple of 64 in the grid");
        return {x, y, side};
    }

    int side_;
    size_t objects_;
    std::unique_ptr<BlockVoxelizer> native_;
};

nb::object hull_of(InputOf<double> positions, InputOf<double> frame) {
    require_rows(positions, 3, "positions must have shape (V, 3)");
    require(frame.size() == 12, "frame must have shape (3, 4)");
    const MeshView view{{positions.data(), positions.size()}, {}, {}};
    const PartView part{PartKind::mesh, &view, frame.data(), 1, 0};
    std::vector<std::array<int32_t, 3>> triangles;
    {
        const LongCall call;
        std::vector<Vertex> points(view.vertex_count());
        for (size_t v = 0; v < points.size(); ++v)
            points[v] = snap_vertex(part, v);
        triangles = convex_hull(points);
    }
    return rows_to_numpy(std::move(triangles));
}

constexpr auto kPartsManual = R"(P parts of O objects on a grid; it keeps the arrays.

Parameters
----------
depth
    The grid's depth, 1 … 16.
meshes
    :class:`MeshArrays` (or plain tuples): positions (V, 3), triangles (T, 3), materials (T,) or (0,), in their
    objects' frames; parts share them. Then, for materials that vary over triangles (src/material_raster.h), the
    columns and rows of each triangle's raster (T, 2), 0 where it has none; the raster coordinates of its corners
    (T, 3, 2); and the materials of the cells of all rasters. The last three have no rows where no triangle has a
    raster. Rasters apply to parts whose material is 0.
kinds
    Shape (P,): 0 mesh, 1 axis-aligned box, 2 ball, 3 ellipsoid.
mesh_of
    Shape (P,): index into `meshes`, for kind 0.
frames
    Shape (P, 12), in 1/4096 voxel. Kinds 0 and 3: rows of the 3x4 affine map to grid space (of the mesh, of the
    unit ball). Kind 1: minimum and maximum. Kind 2: centre and radius.
materials
    Shape (P,): 1 … 255, or 0 where each triangle has its own.
objects_of
    Shape (P,): ascending, below O.
rules
    Shape (O,), by object: 0 touch, 1 centre, 2 half (src/rules/rule.h).
fills
    Shape (O,), by object: 0 solid, 1 surface, 2 auto (src/scene/fill.h).

Raises
------
ValueError
    An array of the wrong shape or with an index out of range.)";

constexpr auto kVoxelizeManual = R"(Voxelize parts; where they compete, the first keeps the voxel.

Parameters
----------
parts
    :class:`SceneParts`.
thin
    "keep" or "drop".
threads
    0 takes as many as the machine has. The result does not depend on it.
instructions
    One of INSTRUCTION_SETS, or empty for the first. The result does not depend on it.

Returns
-------
Voxelized
    The arrays of :class:`voxrt.voxelize.Voxels` under their names; by object: the voxels that belong to it (int64),
    its mode (uint8, an index of OBJECT_MODES), how many of its components were flipped (int64) and whether those of
    its parts that have holes have more inside than shell (uint8); the wall seconds per stage.

Raises
------
OutOfRangeError
    A part reaches beyond 2**18 voxels from the grid's corner, or is not a number.)";

constexpr auto kBlockVoxelizerManual = R"(The same, a block of columns at a time and in any order (src/voxelizer.h).

`wanted`: uint8, 0 for objects to leave out, for blocks that they do not reach; empty for all objects.)";

constexpr auto kHullManual = R"(Triangulate the convex hull of points as they lie in grid space, in exact arithmetic.

Parameters
----------
positions
    Shape (V, 3), in the object's frame.
frame
    Shape (3, 4): rows of the affine map to grid space, in 1/4096 voxel.

Returns
-------
int32, shape (T, 3): rows of `positions`, counter-clockwise seen from outside. Points in one plane give their
polygon twice, facing both ways; points on one line give nothing.)";

} // namespace

NB_MODULE(_native, m) {
    static PyObject* out_of_range = PyErr_NewExceptionWithDoc(
        "voxrt.voxelize._native.OutOfRangeError",
        "A part reaches beyond 2**18 voxels from the grid's corner, or is not a number; the argument is its object.",
        PyExc_ValueError, nullptr);
    m.attr("OutOfRangeError") = nb::handle(out_of_range);
    nb::list modes;
    for (const char* mode : kObjectModeNames)
        modes.append(mode);
    m.attr("OBJECT_MODES") = nb::tuple(modes);
    m.attr("INSTRUCTION_SETS") = instruction_sets(coverage_engines());
    NamedTuple(m, "MeshArrays",
               {"positions", "triangles", "materials", "raster_sizes", "raster_coordinates", "raster_materials"},
               "A mesh as voxelize() takes it.");
    voxelized =
        NamedTuple(m, "Voxelized",
                   {"brick_codes", "brick_masks", "brick_materials", "brick_rows", "cells", "octant_codes",
                    "octant_levels", "octant_materials", "object_voxels", "object_modes", "object_notes", "seconds"},
                   "What voxelize() returns.");
    voxel_block = NamedTuple(m, "VoxelBlock",
                             {"brick_codes", "brick_masks", "brick_materials", "brick_rows", "cells", "octant_codes",
                              "octant_levels", "octant_materials", "object_tallies"},
                             "What BlockVoxelizer.block() returns; tallies (src/voxelizer.h): int64, shape (O, 6).");
    voxel_volumes = NamedTuple(m, "VoxelVolumes", {"objects", "voxels", "volumes", "whole", "known"},
                               "What find_volumes() returns.");
    nb::register_exception_translator(
        [](const std::exception_ptr& failure, void*) {
            try {
                std::rethrow_exception(failure);
            } catch (const OutOfRange& e) {
                PyErr_SetObject(out_of_range, nb::int_(e.object).ptr());
            }
        },
        nullptr);
    nb::class_<SceneParts>(m, "SceneParts", kPartsManual)
        .def(nb::init<int, std::vector<MeshArrays>, InputOf<uint8_t>, InputOf<int32_t>, InputOf<double>,
                      InputOf<uint8_t>, InputOf<int32_t>, InputOf<uint8_t>, InputOf<uint8_t>>(),
             nb::arg("depth"), nb::arg("meshes"), nb::arg("kinds"), nb::arg("mesh_of"), nb::arg("frames"),
             nb::arg("materials"), nb::arg("objects_of"), nb::arg("rules"), nb::arg("fills"));
    m.def("voxelize", &voxelize_parts, nb::arg("parts"), nb::arg("thin"), nb::arg("threads"),
          nb::arg("instructions") = "", kVoxelizeManual);
    m.def("find_volumes", &volumes_of_parts, nb::arg("parts"), nb::arg("threads"), nb::arg("instructions") = "",
          "Which part of each voxel with surface an object fills; the rules and fills do not matter. By object: "
          "objects, voxels "
          "(x, y, z), volumes. Per object: voxels that are filled whole, and whether it has volumes.");
    nb::class_<PythonBlockVoxelizer>(m, "BlockVoxelizer", kBlockVoxelizerManual)
        .def(nb::init<const SceneParts&, const std::string&, int, InputOf<uint8_t>>(), nb::keep_alive<1, 2>(),
             nb::arg("parts"), nb::arg("thin"), nb::arg("threads"), nb::arg("wanted"))
        .def("use_threads", &PythonBlockVoxelizer::use_threads, nb::arg("threads"), "Sets the number of threads.")
        .def("blocks", &PythonBlockVoxelizer::blocks, nb::arg("block_side"),
             "The corners (x, y) of the blocks with geometry, in Morton order: int32, shape (B, 2).")
        .def("objects_of", &PythonBlockVoxelizer::objects_of, nb::arg("x"), nb::arg("y"), nb::arg("block_side"),
             "Which objects may have a voxel in a block: uint8, shape (O,).")
        .def("block", &PythonBlockVoxelizer::block, nb::arg("x"), nb::arg("y"), nb::arg("block_side"),
             "The voxels of a block, and what it found of each object.")
        .def("report", &PythonBlockVoxelizer::report, nb::arg("tallies"),
             "What became of the objects, from the sum of the tallies of all blocks: a Voxelized without voxels.");
    bind_scene(m);
    bind_colour(m);
    m.def("convex_hull", &hull_of, nb::arg("positions"), nb::arg("frame"), kHullManual);
}
