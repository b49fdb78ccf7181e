// The part of voxrt.sim._model that picks voxels of a world that is edited.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::sim {

void bind_pick(nanobind::module_& m);

} // namespace voxrt::sim
