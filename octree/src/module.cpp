// Python bindings: checks what NumPy hands over, releases the GIL, hands results back without copying.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>

#include "breadth_first.h"
#include "budget.h"
#include "build.h"
#include "coarsen.h"
#include "dense.h"
#include "diff.h"
#include "hidden.h"
#include "interior.h"
#include "interrupt.h"
#include "leaves.h"
#include "query.h"
#include "regions.h"
#include "surface.h"
#include "validate.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

template <typename T> using Vector = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <typename T, int Columns>
using Rows = nb::ndarray<const T, nb::shape<-1, Columns>, nb::c_contig, nb::device::cpu>;
using Volume = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Corner = std::array<std::int64_t, 3>;

// A NumPy array that owns `values`.
template <typename T, typename... Shape> auto to_numpy(std::vector<T>&& values, Shape... shape) {
    auto held = std::make_unique<std::vector<T>>(std::move(values));
    T* data = held->data();
    nb::capsule owner(held.get(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    held.release();
    return nb::ndarray<nb::numpy, T>(data, {static_cast<std::size_t>(shape)...}, owner);
}

nb::ndarray<nb::numpy, const Word, nb::ndim<1>> words_to_numpy(std::vector<Word>&& words) {
    words.shrink_to_fit();
    const std::size_t size = words.size();
    auto held = std::make_unique<std::vector<Word>>(std::move(words));
    const Word* data = held->data();
    nb::capsule owner(held.get(), [](void* p) noexcept { delete static_cast<std::vector<Word>*>(p); });
    held.release();
    return nb::ndarray<nb::numpy, const Word, nb::ndim<1>>(data, {size}, owner);
}

void require(bool held, const char* message) {
    if (!held)
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

auto bind_build(unsigned depth, const Vector<std::uint64_t>& brick_codes, const Rows<std::uint64_t, 8>& brick_masks,
                const Vector<std::uint8_t>& brick_materials, const Vector<std::int32_t>& brick_rows,
                const Rows<std::uint8_t, 512>& cells, const Vector<std::uint64_t>& octant_codes,
                const Vector<std::uint8_t>& octant_levels, const Vector<std::uint8_t>& octant_materials,
                unsigned threads) {
    require_depth(depth);
    const std::size_t bricks = brick_codes.shape(0);
    const std::size_t octants = octant_codes.shape(0);
    require(brick_masks.shape(0) == bricks && brick_materials.shape(0) == bricks && brick_rows.shape(0) == bricks,
            "the brick arrays differ in length");
    require(octant_levels.shape(0) == octants && octant_materials.shape(0) == octants,
            "the octant arrays differ in length");
    const VoxelsView view{depth,
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
    std::vector<Word> words;
    {
        nb::gil_scoped_release release;
        words = build(view, threads);
    }
    return words_to_numpy(std::move(words));
}

auto bind_build_dense(const Volume& cells, unsigned depth) {
    require_depth(depth);
    for (unsigned axis = 0; axis < 3; ++axis)
        require(cells.shape(axis) <= std::size_t{1} << depth, "the array is larger than the world");
    std::vector<Word> words;
    {
        nb::gil_scoped_release release;
        words = build_dense(cells.data(), cells.shape(0), cells.shape(1), cells.shape(2), depth);
    }
    return words_to_numpy(std::move(words));
}

auto bind_build_points(const Vector<std::uint64_t>& codes, const Vector<std::uint8_t>& materials, unsigned depth) {
    require_depth(depth);
    require(codes.shape(0) == materials.shape(0), "codes and materials differ in length");
    std::vector<Word> words;
    {
        nb::gil_scoped_release release;
        words = build_points(codes.data(), materials.data(), codes.shape(0), depth);
    }
    return words_to_numpy(std::move(words));
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

std::tuple<std::string, std::size_t, std::size_t> bind_validate(const Vector<Word>& words, unsigned depth) {
    Verdict verdict;
    {
        nb::gil_scoped_release release;
        verdict = validate(words.data(), words.shape(0), depth);
    }
    return {name_of(verdict.fault), verdict.address, verdict.least_depth};
}

auto bind_materials_at(const Vector<Word>& words, unsigned depth, const Rows<std::int64_t, 3>& points) {
    const Memory memory = memory_of(words, depth);
    std::vector<std::uint8_t> materials(points.shape(0));
    {
        nb::gil_scoped_release release;
        materials_at(memory, points.data(), points.shape(0), materials.data());
    }
    return to_numpy(std::move(materials), points.shape(0));
}

auto bind_leaf_counts(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    std::vector<std::uint64_t> counts;
    {
        nb::gil_scoped_release release;
        counts = leaf_counts(memory);
    }
    return to_numpy(std::move(counts), depth + 1, 256);
}

auto bind_count_in_box(const Vector<Word>& words, unsigned depth, const Corner& low, const Corner& high) {
    const Memory memory = memory_of(words, depth);
    const Box box = box_of(low, high);
    std::vector<std::uint64_t> counts;
    {
        nb::gil_scoped_release release;
        const auto found = count_in_box(memory, box);
        counts.assign(found.begin(), found.end());
    }
    return to_numpy(std::move(counts), 256);
}

std::optional<std::pair<Corner, Corner>> bind_solid_bounds(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    nb::gil_scoped_release release;
    if (const std::optional<Box> bounds = solid_bounds(memory))
        return std::pair{bounds->low, bounds->high};
    return std::nullopt;
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
    nb::gil_scoped_release release;
    fill_region(memory, box, region.data());
}

std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::optional<std::pair<Corner, Corner>>>
bind_diff(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    nb::gil_scoped_release release;
    const Difference found = diff(a, b);
    std::optional<std::pair<Corner, Corner>> bounds;
    if (found.bounds)
        bounds = {found.bounds->low, found.bounds->high};
    return {found.appeared, found.vanished, found.recoloured, bounds};
}

// Bounds (x, y, z of the lowest voxel, then of the end) and counts (appeared, vanished, recoloured), a row a region.
auto bind_differing_regions(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    std::vector<std::int64_t> bounds;
    std::vector<std::uint64_t> counts;
    {
        nb::gil_scoped_release release;
        for (const Region& region : differing_regions(a, b)) {
            bounds.insert(bounds.end(), region.bounds.low.begin(), region.bounds.low.end());
            bounds.insert(bounds.end(), region.bounds.high.begin(), region.bounds.high.end());
            counts.insert(counts.end(), {region.appeared, region.vanished, region.recoloured});
        }
    }
    const std::size_t regions = counts.size() / 3;
    return nb::make_tuple(to_numpy(std::move(bounds), regions, 6), to_numpy(std::move(counts), regions, 3));
}

auto bind_coarsen(const Vector<Word>& words, unsigned depth, unsigned level) {
    const Memory memory = memory_of(words, depth);
    std::vector<Word> coarse;
    {
        nb::gil_scoped_release release;
        BlockPool pool;
        const Node root = coarsen(memory, level, pool);
        coarse = breadth_first_words(pool, root);
    }
    return words_to_numpy(std::move(coarse));
}

using MaterialPairs = nb::ndarray<const std::uint32_t, nb::shape<256, 256>, nb::c_contig, nb::device::cpu>;

auto bind_fit_bricks(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth, unsigned finest,
                     const MaterialPairs& same_face, const MaterialPairs& turned,
                     const nb::ndarray<const std::uint32_t, nb::shape<256>, nb::c_contig, nb::device::cpu>& covering,
                     std::size_t most) {
    const Memory memory = memory_of(words, depth);
    const Memory behind = memory_of(hidden, depth);
    auto costs = std::make_unique<SightCosts>();
    std::copy_n(same_face.data(), 256 * 256, costs->same_face[0].data());
    std::copy_n(turned.data(), 256 * 256, costs->turned[0].data());
    std::copy_n(covering.data(), 256, costs->covering.data());
    std::vector<std::vector<Word>> fits;
    {
        nb::gil_scoped_release release;
        fits = fit_bricks(memory, behind, finest, *costs, most);
    }
    nb::list result;
    for (std::vector<Word>& fit : fits)
        result.append(words_to_numpy(std::move(fit)));
    return result;
}

std::pair<std::uint64_t, std::uint64_t> bind_surface_change(const Vector<Word>& first, const Vector<Word>& second,
                                                            unsigned depth) {
    const Memory a = memory_of(first, depth);
    const Memory b = memory_of(second, depth);
    nb::gil_scoped_release release;
    const SurfaceChange change = surface_change(a, b);
    return {change.surface, change.changed};
}

auto bind_hidden_voxels(const Vector<Word>& words, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    std::vector<Word> hidden;
    {
        nb::gil_scoped_release release;
        hidden = hidden_voxels(memory);
    }
    return words_to_numpy(std::move(hidden));
}

auto bind_fill_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth, std::uint8_t material) {
    const Memory memory = memory_of(words, depth);
    const Memory behind = memory_of(hidden, depth);
    std::vector<Word> filled;
    {
        nb::gil_scoped_release release;
        filled = fill_hidden(memory, behind, material);
    }
    return words_to_numpy(std::move(filled));
}

auto bind_share_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth) {
    const Memory memory = memory_of(words, depth);
    const Memory behind = memory_of(hidden, depth);
    std::vector<Word> shared;
    {
        nb::gil_scoped_release release;
        shared = share_hidden(memory, behind);
    }
    return words_to_numpy(std::move(shared));
}

// Lets Ctrl-C through, from the thread that Python called.
void check_signals() {
    nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0)
        throw nb::python_error();
}

// A LeafWalk with the words that it reads.
class PythonLeafWalk {
public:
    PythonLeafWalk(Vector<Word> words, unsigned depth, const Corner& low, const Corner& high, bool solid_only)
        : words_(std::move(words)), walk_(memory_of(words_, depth), box_of(low, high), solid_only) {}

    auto next(std::size_t limit) {
        std::vector<Leaf> leaves;
        {
            nb::gil_scoped_release release;
            leaves = walk_.next(limit);
        }
        std::vector<std::int32_t> corners;
        std::vector<std::uint8_t> levels;
        std::vector<std::uint8_t> materials;
        for (const Leaf& leaf : leaves) {
            corners.insert(corners.end(), leaf.corner.begin(), leaf.corner.end());
            levels.push_back(leaf.level);
            materials.push_back(leaf.material);
        }
        const std::size_t count = leaves.size();
        return nb::make_tuple(to_numpy(std::move(corners), count, 3), to_numpy(std::move(levels), count),
                              to_numpy(std::move(materials), count));
    }

private:
    Vector<Word> words_;
    LeafWalk walk_;
};

} // namespace
} // namespace voxrt::octree

NB_MODULE(_native, m) {
    using namespace voxrt::octree;
    Interrupt::hook = &check_signals;
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
    m.def("coarsen", &bind_coarsen, "words"_a.noconvert(), "depth"_a, "level"_a);
    m.def("fit_bricks", &bind_fit_bricks, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a, "finest"_a,
          "same_face"_a.noconvert(), "turned"_a.noconvert(), "covering"_a.noconvert(), "most"_a);
    m.def("surface_change", &bind_surface_change, "first"_a.noconvert(), "second"_a.noconvert(), "depth"_a);
    m.def("hidden_voxels", &bind_hidden_voxels, "words"_a.noconvert(), "depth"_a);
    m.def("fill_hidden", &bind_fill_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a, "material"_a);
    m.def("share_hidden", &bind_share_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a);
    nanobind::class_<PythonLeafWalk>(m, "LeafWalk")
        .def(nanobind::init<Vector<Word>, unsigned, const Corner&, const Corner&, bool>(), "words"_a.noconvert(),
             "depth"_a, "low"_a, "high"_a, "solid_only"_a)
        .def("next", &PythonLeafWalk::next, "limit"_a);
}
