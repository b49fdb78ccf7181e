// voxrt.octree._native: the octree for Python. The headers are the manual; here arrays are checked and handed over.
#include "../build/build.h"
#include "../build/dense.h"
#include "../query/diff.h"
#include "../query/leaves.h"
#include "../query/query.h"
#include "../query/regions.h"
#include "../words/validate.h"
#include "bindings.h"

#include <nanobind/stl/array.h>

#include <algorithm>
#include <memory>
#include <string>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

using python::NamedTuple;
using python::to_numpy;
using python::to_read_only_numpy;

using Volume = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Corner = std::array<std::int64_t, 3>;

NamedTuple verdict_type;

Box box_of(const Corner& low, const Corner& high) {
    for (unsigned axis = 0; axis < 3; ++axis)
        require(low[axis] >= -(1 << 20) && high[axis] <= 1 << 20, "the box reaches beyond 2**20 voxels");
    return {low, high};
}

nb::object to_python(const Corner& corner) { return nb::make_tuple(corner[0], corner[1], corner[2]); }

nb::object to_python(const std::optional<Box>& bounds) {
    return bounds ? nb::object(nb::make_tuple(to_python(bounds->low), to_python(bounds->high))) : nb::none();
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
    return words_to_numpy(run([&] {
        return build({depth, bricks, brick_codes.data(), brick_masks.data(), brick_materials.data(), brick_rows.data(),
                      cells.shape(0), cells.data(), octants, octant_codes.data(), octant_levels.data(),
                      octant_materials.data()},
                     threads);
    }));
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

nb::object bind_validate(const Vector<Word>& words, unsigned depth) {
    static constexpr const char* names[] = {"", "length", "tag", "misaligned", "range", "cycle", "too-deep"};
    const Verdict verdict = run([&] { return validate(words.data(), words.shape(0), depth); });
    return verdict_type(names[static_cast<int>(verdict.fault)], verdict.address, verdict.least_depth);
}

nb::object bind_materials_at(const Vector<Word>& words, unsigned depth, const Rows<std::int64_t, 3>& points) {
    const Memory memory = memory_of(words, depth);
    const std::size_t count = points.shape(0);
    std::vector<std::uint8_t> materials(count);
    run([&] { materials_at(memory, points.data(), count, materials.data()); });
    return to_numpy(std::move(materials), {count});
}

nb::object bind_leaf_counts(const Vector<Word>& words, unsigned depth) {
    return to_numpy(run_on(words, depth, leaf_counts), {std::size_t{depth} + 1, 256});
}

nb::object bind_count_in_box(const Vector<Word>& words, unsigned depth, const Corner& low, const Corner& high) {
    const Memory memory = memory_of(words, depth);
    const Box box = box_of(low, high);
    const auto found = run([&] { return count_in_box(memory, box); });
    return to_numpy(std::vector<std::uint64_t>(found.begin(), found.end()), {256});
}

nb::object bind_solid_bounds(const Vector<Word>& words, unsigned depth) {
    return to_python(run_on(words, depth, solid_bounds));
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
    const Difference found = run_on(first, second, depth, diff);
    return nb::make_tuple(found.appeared, found.vanished, found.recoloured, to_python(found.bounds));
}

nb::object bind_differing_regions(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const std::vector<Region> regions = run_on(first, second, depth, differing_regions);
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
    return nb::make_tuple(to_numpy(std::move(low), {count, 3}), to_numpy(std::move(high), {count, 3}),
                          to_numpy(std::move(appeared), {count}), to_numpy(std::move(vanished), {count}),
                          to_numpy(std::move(recoloured), {count}));
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
        return nb::make_tuple(to_numpy(std::move(corners), {count, 3}), to_numpy(std::move(levels), {count}),
                              to_numpy(std::move(materials), {count}));
    }

private:
    Vector<Word> words_;
    LeafWalk walk_;
};

} // namespace
} // namespace voxrt::octree

NB_MODULE(_native, m) {
    using namespace voxrt::octree;
    verdict_type = NamedTuple(m, "Verdict", {"fault", "address", "least_depth"},
                              "What validate() found; fault is empty where the words are an octree.");
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
    nanobind::class_<PythonLeafWalk>(m, "LeafWalk")
        .def(nanobind::init<Vector<Word>, unsigned, const Corner&, const Corner&, bool>(), "words"_a.noconvert(),
             "depth"_a, "low"_a, "high"_a, "solid_only"_a)
        .def("next", &PythonLeafWalk::next, "limit"_a);
    bind_derived(m);
    bind_files(m);
    bind_world(m);
}
