// The Python class Core and the list CORES; core_module.cpp documents them.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::rtl {

void bind_core(nanobind::module_& m);

} // namespace voxrt::rtl
