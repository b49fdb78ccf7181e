// Rays through a world that is edited: no words are copied, and none are verified again.
#include "pick_bindings.h"
#include "../rays/ray.h"

#include <voxrt/octree/bindings/python_world.h>

#include <nanobind/stl/array.h>

#include <stdexcept>

namespace nb = nanobind;

namespace voxrt::sim {
namespace {

using Triple = std::array<std::int32_t, 3>;

nb::object pick(octree::PythonWorld& world, const Triple& origin, const Triple& direction) {
    Line line{};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] <= -kDirectionLimit || direction[axis] >= kDirectionLimit)
            throw std::invalid_argument("the direction is not below 2**20");
        line.origin[axis] = origin[axis];
        line.direction[axis] = direction[axis];
    }
    Hit<WideKey> hit;
    {
        const nb::gil_scoped_release release;
        hit = world.with([&](const octree::World& one) { return Ray<WideKey>(one.memory(), line).trace(); });
    }
    return nb::make_tuple(hit.material, hit.face, nb::make_tuple(hit.cell[0], hit.cell[1], hit.cell[2]));
}

} // namespace

void bind_pick(nb::module_& m) {
    m.def("pick", &pick, nb::arg("world"), nb::arg("origin"), nb::arg("direction"),
          "Trace one ray through a voxrt.octree._native.World, as Memory.trace does: origin in 1/16 voxel. Returns\n"
          "material, face and cell. ValueError: a direction out of range.");
}

} // namespace voxrt::sim
