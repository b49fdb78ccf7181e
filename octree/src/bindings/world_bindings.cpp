#include "../build/coarsen.h"
#include "bindings.h"
#include "python_world.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <array>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

using python::NamedTuple;
using python::rows_to_numpy;
using python::to_numpy;

NamedTuple patch_type, figures_type;

template <typename Work> auto with(PythonWorld& world, Work work) {
    return run([&] { return world.with(work); });
}

PythonWorld* make_world(const Vector<Word>& words, unsigned depth, std::size_t most_words, std::size_t undo_steps,
                        std::optional<std::size_t> root) {
    const Memory memory = memory_of(words, depth);
    require(!root || (*root < memory.size && memory.words[*root] == memory.root()), "the root is not that of word 0");
    return run([&] { return new PythonWorld(memory, WorldLimits{most_words, undo_steps}, root); });
}

void require_reach(std::initializer_list<const Place*> places, std::int64_t reach) {
    for (const Place* place : places)
        for (const std::int64_t coordinate : *place)
            require(-reach <= coordinate && coordinate <= reach, "a coordinate is out of reach");
}

bool bind_set(PythonWorld& world, const Rows<std::int64_t, 3>& points, const Vector<std::uint8_t>& materials) {
    const std::size_t count = points.shape(0);
    require(materials.shape(0) == count, "points and materials differ in length");
    return with(world, [&](World& one) {
        const std::int64_t side = std::int64_t{1} << one.depth();
        require(std::all_of(points.data(), points.data() + 3 * count,
                            [&](std::int64_t coordinate) { return coordinate >= 0 && coordinate < side; }),
                "a point lies outside the world");
        return one.set(points.data(), materials.data(), count);
    });
}

bool change_shape(PythonWorld& world, const Shape& shape, std::uint8_t material, bool solid_only) {
    return with(world, [&](World& one) { return solid_only ? one.paint(shape, material) : one.fill(shape, material); });
}

bool bind_change_box(PythonWorld& world, const Place& low, const Place& high, std::uint8_t material, bool solid_only) {
    return change_shape(world, Box{low, high}, material, solid_only);
}

bool bind_change_ball(PythonWorld& world, const Place& centre, std::int64_t radius, std::uint8_t material,
                      bool solid_only) {
    require_reach({&centre}, kShapeReach);
    require(radius >= 0 && radius <= kShapeReach, "the radius is out of reach");
    return change_shape(world, Ball{centre, radius}, material, solid_only);
}

bool bind_change_capsule(PythonWorld& world, const Place& start, const Place& end, std::int64_t radius,
                         std::uint8_t material, bool solid_only) {
    require_reach({&start, &end}, kShapeReach);
    require(radius >= 0 && radius <= kShapeReach, "the radius is out of reach");
    return change_shape(world, Capsule{start, end, radius}, material, solid_only);
}

bool bind_paste(PythonWorld& world, const Vector<Word>& words, unsigned depth, const Place& size, const Place& at,
                unsigned quarters, const std::array<std::uint8_t, 256>& materials) {
    const Memory piece = memory_of(words, depth);
    require_reach({&size, &at}, 1 << 20);
    return with(world, [&](World& one) { return one.paste(piece, size, at, quarters, materials); });
}

void require_box(const Place& low, const Place& high) {
    for (unsigned axis = 0; axis < 3; ++axis)
        require(high[axis] - low[axis] <= 1 << kMaxDepth, "the box has more than 2**16 voxels per side");
    require_reach({&low, &high}, 1 << 20);
}

nb::object to_tuple(Copied&& found) { return nb::make_tuple(words_to_numpy(std::move(found.words)), found.depth); }

nb::object bind_copy(PythonWorld& world, const Place& low, const Place& high) {
    require_box(low, high);
    return to_tuple(with(world, [&](World& one) { return one.copy({low, high}); }));
}

// What is solid in a box, as one material.
Copied solid_box(const Memory& memory, const Place& low, const Place& high, std::size_t most) {
    std::array<std::uint8_t, 256> materials;
    materials.fill(1);
    materials[0] = 0;
    return copied(memory, {low, high}, materials, most);
}

nb::object bind_solid_box(const Vector<Word>& words, unsigned depth, const Place& low, const Place& high,
                          std::size_t most) {
    require_box(low, high);
    return to_tuple(run_on(words, depth, [&](const Memory& memory) { return solid_box(memory, low, high, most); }));
}

nb::object bind_solid_box_of_world(PythonWorld& world, const Place& low, const Place& high, std::size_t most) {
    require_box(low, high);
    return to_tuple(with(world, [&](World& one) { return solid_box(one.memory().memory(), low, high, most); }));
}

nb::object bind_materials_at(PythonWorld& world, const Rows<std::int64_t, 3>& points) {
    const std::size_t count = points.shape(0);
    std::vector<std::uint8_t> materials(count);
    with(world, [&](World& one) { materials_at(one.memory().memory(), points.data(), count, materials.data()); });
    return to_numpy(std::move(materials), {count});
}

nb::object bind_commit(PythonWorld& world) {
    Patch patch = with(world, [](World& one) { return one.commit(); });
    const std::size_t count = patch.addresses.size();
    return patch_type(patch.root, patch.root_word, to_numpy(std::move(patch.addresses), {count}),
                      rows_to_numpy(std::move(patch.blocks)));
}

nb::object bind_steps(PythonWorld& world, std::uint32_t author) {
    const auto [undo, redo] =
        with(world, [=](World& one) { return std::pair(one.undo_steps(author), one.redo_steps(author)); });
    return nb::make_tuple(undo, redo);
}

nb::object bind_live_roots(PythonWorld& world) {
    nb::list addresses;
    for (const LiveRoots::Root& root : with(world, [](World& one) { return one.live_roots(); }))
        addresses.append(root.address);
    return nb::tuple(addresses);
}

nb::object bind_words(PythonWorld& world) {
    return words_to_numpy(with(world, [](World& one) { return one.words(); }));
}

nb::object bind_image(PythonWorld& world) {
    return words_to_numpy(with(world, [](World& one) { return one.image(); }));
}

nb::object bind_written(PythonWorld& world) {
    std::vector<Word> found = with(world, [](World& one) { return one.written(); });
    const std::size_t count = found.size();
    return to_numpy(std::move(found), {count});
}

// The words of a live root. Other threads may edit meanwhile.
nb::object bind_words_at(PythonWorld& world, std::size_t root) {
    return words_to_numpy(run([&] {
        const View view = world.view(root);
        return coarsened(view.memory().memory(), 0);
    }));
}

nb::object bind_figures(PythonWorld& world) {
    const World::Figures found = with(world, [](World& one) { return one.figures(); });
    return figures_type(found.blocks, found.kept, found.free);
}

} // namespace

void bind_world(nb::module_& m) {
    patch_type = NamedTuple(m, "Patch", {"root", "root_word", "addresses", "blocks"}, "What World.commit() returns.");
    figures_type = NamedTuple(m, "WorldFigures", {"blocks", "kept", "free"}, "What World.figures() returns.");
    m.def("solid_box", &bind_solid_box, "words"_a.noconvert(), "depth"_a, "low"_a, "high"_a, "most"_a);
    nb::class_<PythonWorld>(m, "World")
        .def(nb::new_(&make_world), "words"_a.noconvert(), "depth"_a, "most_words"_a, "undo_steps"_a,
             "root"_a = nb::none())
        .def("set", &bind_set, "points"_a.noconvert(), "materials"_a.noconvert())
        .def("change_box", &bind_change_box, "low"_a, "high"_a, "material"_a, "solid_only"_a)
        .def("change_ball", &bind_change_ball, "centre"_a, "radius"_a, "material"_a, "solid_only"_a)
        .def("change_capsule", &bind_change_capsule, "start"_a, "end"_a, "radius"_a, "material"_a, "solid_only"_a)
        .def("paste", &bind_paste, "words"_a.noconvert(), "depth"_a, "size"_a, "at"_a, "quarters"_a, "materials"_a)
        .def("copy", &bind_copy, "low"_a, "high"_a)
        .def("solid_box", &bind_solid_box_of_world, "low"_a, "high"_a, "most"_a)
        .def("materials_at", &bind_materials_at, "points"_a.noconvert())
        .def("undo", [](PythonWorld& world) { return with(world, [](World& one) { return one.undo(); }); })
        .def("redo", [](PythonWorld& world) { return with(world, [](World& one) { return one.redo(); }); })
        .def("steps", &bind_steps, "author"_a)
        .def(
            "set_author",
            [](PythonWorld& world, std::uint32_t author) { with(world, [=](World& one) { one.set_author(author); }); },
            "author"_a)
        .def(
            "set_stroke",
            [](PythonWorld& world, std::uint32_t stroke) { with(world, [=](World& one) { one.set_stroke(stroke); }); },
            "stroke"_a)
        .def("commit", &bind_commit)
        .def("live_roots", &bind_live_roots)
        .def(
            "release", [](PythonWorld& world, std::size_t root) { world.release(root); }, "root"_a)
        .def("words", &bind_words)
        .def("words_at", &bind_words_at, "root"_a)
        .def("image", &bind_image)
        .def("written", &bind_written)
        .def("figures", &bind_figures)
        .def("check", [](PythonWorld& world) { with(world, [](World& one) { one.check(); }); });
}

} // namespace voxrt::octree
