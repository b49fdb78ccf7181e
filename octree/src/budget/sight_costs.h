// What changes of materials and faces cost in a picture.
#pragma once

#include "appearance.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace voxrt::octree {

using Colour = std::array<std::uint8_t, 3>; // sRGB

/// Mean squared differences of colour where a ray meets another material, another face, or a voxel that appeared.
/// `colours`: by material id, entry 0 the background; empty where all materials are equally different.
std::unique_ptr<AppearanceCosts> sight_costs(std::span<const Colour> colours);

} // namespace voxrt::octree
