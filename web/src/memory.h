// The memory of the C interface, which pictures are made of.
#pragma once

#include <voxrt/octree/words/verify.h>

namespace voxrt::web {

/// What vx_memory() took. Throws std::invalid_argument where it has taken nothing.
const octree::VerifiedMemory& loaded();

} // namespace voxrt::web
