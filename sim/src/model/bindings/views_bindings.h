// Binds orbits and beam.h.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::sim {

void bind_views(nanobind::module_& m);

} // namespace voxrt::sim
