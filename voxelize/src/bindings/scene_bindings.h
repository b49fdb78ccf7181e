// What of a scene's preparation Python shares with other front ends: its bounds, its materials, its warnings.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::voxelize {

void bind_scene(nanobind::module_& m);

} // namespace voxrt::voxelize
