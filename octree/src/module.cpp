// voxrt.octree._native: the octree for Python. The headers are the manual; here arrays are checked and handed over.
#include "assembly.h"
#include "breadth_first.h"
#include "build.h"
#include "coarsen.h"
#include "dag_counts.h"
#include "dense.h"
#include "diff.h"
#include "disk_assembly.h"
#include "encoded_rows.h"
#include "fit_candidates.h"
#include "hidden.h"
#include "interior.h"
#include "leaves.h"
#include "means.h"
#include "mem_text.h"
#include "occupancy_dag.h"
#include "query.h"
#include "regions.h"
#include "shared_size.h"
#include "sight_costs.h"
#include "surface.h"
#include "validate.h"

#include <voxrt/voxelize/python.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <memory>
#include <string>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

using python::LongCall;
using python::NamedTuple;
using python::to_numpy;
using python::to_read_only_numpy;

template <typename T> using Vector = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <typename T, int Columns>
using Rows = nb::ndarray<const T, nb::shape<-1, Columns>, nb::c_contig, nb::device::cpu>;
using Volume = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Corner = std::array<std::int64_t, 3>;

NamedTuple verdict_type, bounds_type, difference_type, regions_type, surface_change_type, leaves_type;

// A read-only array.
nb::object words_to_numpy(std::vector<Word>&& words) {
    words.shrink_to_fit();
    const std::size_t size = words.size();
    return to_read_only_numpy(std::move(words), {size});
}

// Calls `work` without the GIL; Ctrl-C ends it.
template <class Work> auto run(Work work) {
    const LongCall call;
    return work();
}

void require(bool condition, const char* message) {
    if (!condition)
        throw std::invalid_argument(message);
}

void require_depth(unsigned depth) { require(depth >= 1 && depth <= kMaxDepth, "depth must be 1 ... 16"); }

Memory memory_of(const Vector<Word>& words, unsigned depth) {
    require_depth(depth);
    return {words.data(), words.shape(0), depth};
}

Box box_of(const Corner& low, const Corner& high) {
    for (unsigned axis = 0; axis < 3; ++axis)
        require(low[axis] >= -(1 << 20) && high[axis] <= 1 << 20, "the box reaches beyond 2**20 voxels");
    return {low, high};
}

nb::object to_python(const Corner& corner) { return nb::make_tuple(corner[0], corner[1], corner[2]); }

nb::object to_python(const std::optional<Box>& bounds) {
    return bounds ? bounds_type(to_python(bounds->low), to_python(bounds->high)) : nb::none();
}

nb::object bind_build(unsigned depth, const Vector<std::uint64_t>& brick_codes,
                      const Rows<std::uint64_t, 8>& brick_masks, const Vector<std::uint8_t>& brick_materials,
                      const Vector<std::int32_t>& brick_rows, const Rows<std::uint8_t, 512>& cells,
                      const Vector<std::uint64_t>& octant_codes, const Vector<std::uint8_t>& octant_levels,
                      const Vector<std::uint8_t>& octant_materials, int threads) {
    require_depth(depth);
    const std::size_t bricks = brick_codes.shape(0);
    const std::size_t octants = octant_codes.shape(0);
    require(brick_masks.shape(0) == bricks && brick_materials.shape(0) == bricks && brick_rows.shape(0) == bricks,
            "the brick arrays differ in length");
    require(octant_levels.shape(0) == octants && octant_materials.shape(0) == octants,
            "the octant arrays differ in length");
    require(threads >= 0 && threads <= 1024, "threads must be 0 ... 1024");
    const voxelize::VoxelsView view{depth,
                                    bricks,
                                    brick_codes.data(),
                                    brick_masks.data(),
                                    brick_materials.data(),
                                    brick_rows.data(),
                                    cells.shape(0),
                                    cells.data(),
                                    octants,
                                    octant_codes.data(),
                                    octant_levels.data(),
                                    octant_materials.data()};
    return words_to_numpy(run([&] { return build(view, threads); }));
}

nb::object bind_build_dense(const Volume& cells, unsigned depth) {
    require_depth(depth);
    for (unsigned axis = 0; axis < 3; ++axis)
        require(cells.shape(axis) <= std::size_t{1} << depth, "the array is larger than the world");
    return words_to_numpy(
        run([&] { return build_dense(cells.data(), cells.shape(0), cells.shape(1), cells.shape(2), depth); }));
}

nb::object bind_build_points(const Vector<std::uint64_t>& codes, const Vector<std::uint8_t>& materials,
                             unsigned depth) {
    require_depth(depth);
    require(codes.shape(0) == materials.shape(0), "codes and materials differ in length");
    return words_to_numpy(run([&] { return build_points(codes.data(), materials.data(), codes.shape(0), depth); }));
}

const char* name_of(Fault fault) {
    switch (fault) {
    case Fault::length:
        return "length";
    case Fault::tag:
        return "tag";
    case Fault::misaligned:
        return "misaligned";
    case Fault::range:
        return "range";
    case Fault::cycle:
        return "cycle";
    case Fault::too_deep:
        return "too-deep";
    case Fault::none:
        break;
    }
    return "";
}

nb::object bind_validate(const Vector<Word>& words, unsigned depth) {
    const Verdict verdict = run([&] { return validate(words.data(), words.shape(0), depth); });
    return verdict_type(name_of(verdict.fault), verdict.address, verdict.least_depth);
}

nb::object bind_materials_at(const Vector<Word>& words, unsigned depth, const Rows<std::int64_t, 3>& points) {
    const Memory memory = memory_of(words, depth);
    const std::size_t count = points.shape(0);
    std::vector<std::uint8_t> materials(count);
    run([&] { materials_at(memory, points.data(), count, materials.data()); });
    return to_numpy(std::move(materials), {count});
}

nb::object bind_leaf_counts(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return to_numpy(run([&] { return leaf_counts(memory); }), {std::size_t{depth} + 1, 256});
}

nb::object bind_count_in_box(const Vector<Word>& words, unsigned depth, const Corner& low, const Corner& high) {
    const Memory memory = memory_of(words, depth);
    const Box box = box_of(low, high);
    const auto found = run([&] { return count_in_box(memory, box); });
    return to_numpy(std::vector<std::uint64_t>(found.begin(), found.end()), {256});
}

nb::object bind_solid_bounds(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return to_python(run([&] { return solid_bounds(memory); }));
}

void bind_fill_region(const Vector<Word>& words, unsigned depth, const Corner& low,
                      const nb::ndarray<std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>& region) {
    const Memory memory = memory_of(words, depth);
    Corner high = low;
    for (unsigned axis = 0; axis < 3; ++axis) {
        require(region.shape(axis) <= 1u << 20, "the region is longer than 2**20 voxels");
        high[axis] += static_cast<std::int64_t>(region.shape(axis));
    }
    const Box box = box_of(low, high);
    run([&] { fill_region(memory, box, region.data()); });
}

nb::object bind_diff(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    const Difference found = run([&] { return diff(a, b); });
    return difference_type(found.appeared, found.vanished, found.recoloured, to_python(found.bounds));
}

nb::object bind_differing_regions(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    const std::vector<Region> regions = run([&] { return differing_regions(a, b); });
    std::vector<std::int64_t> low, high;
    std::vector<std::uint64_t> appeared, vanished, recoloured;
    for (const Region& region : regions) {
        low.insert(low.end(), region.bounds.low.begin(), region.bounds.low.end());
        high.insert(high.end(), region.bounds.high.begin(), region.bounds.high.end());
        appeared.push_back(region.appeared);
        vanished.push_back(region.vanished);
        recoloured.push_back(region.recoloured);
    }
    const std::size_t count = regions.size();
    return regions_type(to_numpy(std::move(low), {count, 3}), to_numpy(std::move(high), {count, 3}),
                        to_numpy(std::move(appeared), {count}), to_numpy(std::move(vanished), {count}),
                        to_numpy(std::move(recoloured), {count}));
}

nb::object bind_encoded_rows(const Vector<Word>& words, unsigned block_bits) {
    if (block_bits > 29)
        throw std::invalid_argument("block_bits is " + std::to_string(block_bits) + ", not 0 ... 29");
    std::vector<std::uint32_t> rows = run([&] { return encoded_rows(words.data(), words.shape(0), block_bits); });
    const std::size_t count = rows.size();
    return to_numpy(std::move(rows), {count});
}

std::size_t bind_shared_words(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return run([&] { return shared_words(memory); });
}

nb::object bind_coarsen(const Vector<Word>& words, unsigned depth, unsigned level) {
    const Memory memory = memory_of(words, depth);
    return words_to_numpy(run([&] {
        BlockPool pool;
        const Node root = coarsen(memory, level, pool);
        return breadth_first_words(pool, root);
    }));
}

nb::object bind_occupancy_dag(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return words_to_numpy(run([&] { return occupancy_dag(memory); }));
}

nb::object bind_occupied_octree(const Vector<Word>& words, unsigned depth) {
    return words_to_numpy(run([&] {
        BlockPool pool;
        const Node root = occupied_octree(words.data(), words.shape(0), depth, pool);
        return breadth_first_words(pool, root);
    }));
}

// A row per level; the columns are the fields of DagLevel.
nb::object bind_dag_levels(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    std::vector<std::uint64_t> rows;
    for (const DagLevel& level : run([&] { return dag_levels(memory); }))
        rows.insert(rows.end(), {level.tree_nodes, level.tree_words, level.nodes, level.words, level.mirrored_nodes,
                                 level.mirrored_words});
    const std::size_t count = rows.size() / 6;
    return to_numpy(std::move(rows), {count, 6});
}

std::size_t bind_mirrored_blocks(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return run([&] { return mirrored_blocks(memory); });
}

nb::object bind_fit_candidates(const Vector<Word>& words, unsigned depth, std::size_t limit,
                               const nb::ndarray<const std::uint8_t, nb::shape<-1, 3>, nb::c_contig>& colours) {
    const Memory memory = memory_of(words, depth);
    const auto costs = sight_costs({reinterpret_cast<const Colour*>(colours.data()), colours.shape(0)});
    nb::list result;
    std::string problem;
    try {
        for (std::vector<Word>& fit : run([&] { return fit_candidates(memory, limit, *costs); }))
            result.append(words_to_numpy(std::move(fit)));
    } catch (const DoesNotFit& failure) {
        problem = failure.what();
    }
    return nb::make_tuple(result, problem);
}

nb::object bind_surface_change(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    const SurfaceChange change = run([&] { return surface_change(a, b); });
    return surface_change_type(change.surface, change.changed);
}

nb::object bind_hidden_voxels(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    return words_to_numpy(run([&] { return hidden_voxels(memory); }));
}

nb::object bind_fill_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth,
                            std::uint8_t material) {
    const Memory memory = memory_of(words, depth);
    const Memory hidden_memory = memory_of(hidden, depth);
    return words_to_numpy(run([&] { return fill_hidden(memory, hidden_memory, material); }));
}

nb::object bind_share_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    const Memory hidden_memory = memory_of(hidden, depth);
    return words_to_numpy(run([&] { return share_hidden(memory, hidden_memory); }));
}

nb::object bind_mean_materials(const Vector<Word>& words, unsigned depth, const Rows<std::uint16_t, 3>& light) {
    require(light.shape(0) <= 256, "light must have 256 rows at most");
    const Memory memory = memory_of(words, depth);
    std::vector<LinearLight> materials(light.shape(0));
    for (std::size_t id = 0; id < materials.size(); ++id)
        for (std::size_t channel = 0; channel < 3; ++channel)
            materials[id][channel] = light(id, channel);
    std::vector<std::uint8_t> means = run([&] { return mean_materials(memory, materials); });
    const std::size_t count = means.size();
    return to_read_only_numpy(std::move(means), {count});
}

nb::bytes bind_mem_text(const Vector<Word>& words, int threads) {
    const std::size_t count = words.shape(0);
    PyObject* text = PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(kMemLine * count));
    if (text == nullptr)
        throw nb::python_error();
    const nb::bytes result = nb::steal<nb::bytes>(text);
    run([&] { write_mem_text(words.data(), count, PyBytes_AS_STRING(text), threads); });
    return result;
}

std::uint32_t bind_mem_text_crc32(const Vector<Word>& words, std::uint32_t before, int threads) {
    return run([&] { return mem_text_crc32(words.data(), words.shape(0), before, threads); });
}

// None where the text is not that of mem_text().
nb::object bind_read_mem_text(const nb::bytes& text) {
    if (text.size() % kMemLine != 0)
        return nb::none();
    std::vector<Word> words(text.size() / kMemLine);
    if (!run([&] { return read_mem_text(text.c_str(), words.size(), words.data(), 0); }))
        return nb::none();
    const std::size_t count = words.size();
    return to_numpy(std::move(words), {count});
}

void bind_assembly_add(Assembly& assembly, const Vector<Word>& words) {
    run([&] { assembly.add(words.data(), words.shape(0)); });
}

nb::object bind_assembly_words(const Assembly& assembly) {
    return words_to_numpy(run([&] { return assembly.words(); }));
}

void bind_disk_assembly_add(DiskAssembly& assembly, const Vector<Word>& words) {
    run([&] { assembly.add(words.data(), words.shape(0)); });
}

// Paths are bytes: a file's name need not be text.
std::string path_of(const nb::bytes& path) { return {path.c_str(), path.size()}; }

std::size_t bind_disk_assembly_write(DiskAssembly& assembly, const nb::bytes& path) {
    const std::string target = path_of(path);
    return run([&] { return assembly.write(target); });
}

// A LeafWalk with the words that it reads.
class PythonLeafWalk {
public:
    PythonLeafWalk(Vector<Word> words, unsigned depth, const Corner& low, const Corner& high, bool solid_only)
        : words_(std::move(words)), walk_(memory_of(words_, depth), box_of(low, high), solid_only) {}

    nb::object next(std::size_t limit) {
        const std::vector<Leaf> leaves = run([&] { return walk_.next(limit); });
        std::vector<std::int32_t> corners;
        std::vector<std::uint8_t> levels;
        std::vector<std::uint8_t> materials;
        for (const Leaf& leaf : leaves) {
            corners.insert(corners.end(), leaf.corner.begin(), leaf.corner.end());
            levels.push_back(leaf.level);
            materials.push_back(leaf.material);
        }
        const std::size_t count = leaves.size();
        return leaves_type(to_numpy(std::move(corners), {count, 3}), to_numpy(std::move(levels), {count}),
                           to_numpy(std::move(materials), {count}));
    }

private:
    Vector<Word> words_;
    LeafWalk walk_;
};

void add_result_types(nb::module_& m) {
    verdict_type = NamedTuple(m, "Verdict", {"fault", "address", "least_depth"},
                              "What validate() found; fault is empty where the words are an octree.");
    bounds_type = NamedTuple(m, "Bounds", {"low", "high"}, "Voxels from low up to and without high.");
    difference_type = NamedTuple(m, "Difference", {"appeared", "vanished", "recoloured", "bounds"},
                                 "What diff() returns: counts of voxels, and their Bounds or None.");
    regions_type = NamedTuple(m, "Regions", {"low", "high", "appeared", "vanished", "recoloured"},
                              "What differing_regions() returns: a row per region.");
    surface_change_type = NamedTuple(m, "SurfaceChange", {"surface", "changed"}, "What surface_change() returns.");
    leaves_type = NamedTuple(m, "Leaves", {"corners", "levels", "materials"}, "What LeafWalk.next() returns.");
}

} // namespace
} // namespace voxrt::octree

NB_MODULE(_native, m) {
    using namespace voxrt::octree;
    add_result_types(m);
    m.def("build", &bind_build, "depth"_a, "brick_codes"_a.noconvert(), "brick_masks"_a.noconvert(),
          "brick_materials"_a.noconvert(), "brick_rows"_a.noconvert(), "cells"_a.noconvert(),
          "octant_codes"_a.noconvert(), "octant_levels"_a.noconvert(), "octant_materials"_a.noconvert(), "threads"_a);
    m.def("build_dense", &bind_build_dense, "cells"_a.noconvert(), "depth"_a);
    m.def("build_points", &bind_build_points, "codes"_a.noconvert(), "materials"_a.noconvert(), "depth"_a);
    m.def("validate", &bind_validate, "words"_a.noconvert(), "depth"_a);
    m.def("materials_at", &bind_materials_at, "words"_a.noconvert(), "depth"_a, "points"_a.noconvert());
    m.def("leaf_counts", &bind_leaf_counts, "words"_a.noconvert(), "depth"_a);
    m.def("count_in_box", &bind_count_in_box, "words"_a.noconvert(), "depth"_a, "low"_a, "high"_a);
    m.def("solid_bounds", &bind_solid_bounds, "words"_a.noconvert(), "depth"_a);
    m.def("fill_region", &bind_fill_region, "words"_a.noconvert(), "depth"_a, "low"_a, "region"_a.noconvert());
    m.def("diff", &bind_diff, "first"_a.noconvert(), "second"_a.noconvert(), "depth"_a);
    m.def("differing_regions", &bind_differing_regions, "first"_a.noconvert(), "second"_a.noconvert(), "depth"_a);
    m.def("shared_words", &bind_shared_words, "words"_a.noconvert(), "depth"_a);
    m.def("coarsen", &bind_coarsen, "words"_a.noconvert(), "depth"_a, "level"_a);
    m.def("occupancy_dag", &bind_occupancy_dag, "words"_a.noconvert(), "depth"_a);
    m.def("occupied_octree", &bind_occupied_octree, "words"_a.noconvert(), "depth"_a);
    m.def("dag_levels", &bind_dag_levels, "words"_a.noconvert(), "depth"_a);
    m.def("mirrored_blocks", &bind_mirrored_blocks, "words"_a.noconvert(), "depth"_a);
    m.def("encoded_rows", &bind_encoded_rows, "words"_a.noconvert(), "block_bits"_a);
    m.def("mean_materials", &bind_mean_materials, "words"_a.noconvert(), "depth"_a, "light"_a.noconvert());
    m.def("fit_candidates", &bind_fit_candidates, "words"_a.noconvert(), "depth"_a, "limit"_a, "colours"_a);
    m.def("mem_text", &bind_mem_text, "words"_a.noconvert(), "threads"_a = 0);
    m.def("mem_text_crc32", &bind_mem_text_crc32, "words"_a.noconvert(), "before"_a = 0, "threads"_a = 0);
    m.def("read_mem_text", &bind_read_mem_text, "text"_a);
    m.def("surface_change", &bind_surface_change, "first"_a.noconvert(), "second"_a.noconvert(), "depth"_a);
    m.def("hidden_voxels", &bind_hidden_voxels, "words"_a.noconvert(), "depth"_a);
    m.def("fill_hidden", &bind_fill_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a, "material"_a);
    m.def("share_hidden", &bind_share_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a);
    nb::class_<Assembly>(m, "Assembly")
        .def(nb::new_([](unsigned depth, std::size_t expected_blocks) {
                 require_depth(depth);
                 return new Assembly(depth, expected_blocks);
             }),
             "depth"_a, "expected_blocks"_a)
        .def("add", &bind_assembly_add, "words"_a.noconvert())
        .def("words", &bind_assembly_words);
    nb::register_exception_translator([](const std::exception_ptr& failure, void*) {
        try {
            std::rethrow_exception(failure);
        } catch (const FileError& error) {
            errno = error.code().value();
            PyErr_SetFromErrnoWithFilename(PyExc_OSError, error.path.c_str());
        }
    });
    nb::class_<DiskAssembly>(m, "DiskAssembly")
        .def(nb::new_([](unsigned depth, const nb::bytes& folder, std::size_t cache_bytes) {
                 require_depth(depth);
                 return new DiskAssembly(depth, path_of(folder), cache_bytes);
             }),
             "depth"_a, "folder"_a, "cache_bytes"_a)
        .def("add", &bind_disk_assembly_add, "words"_a.noconvert())
        .def("write", &bind_disk_assembly_write, "path"_a);
    nanobind::class_<PythonLeafWalk>(m, "LeafWalk")
        .def(nanobind::init<Vector<Word>, unsigned, const Corner&, const Corner&, bool>(), "words"_a.noconvert(),
             "depth"_a, "low"_a, "high"_a, "solid_only"_a)
        .def("next", &PythonLeafWalk::next, "limit"_a);
}
