// The functions of colours, for Python.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::voxelize {

void bind_colour(nanobind::module_& m);

} // namespace voxrt::voxelize
