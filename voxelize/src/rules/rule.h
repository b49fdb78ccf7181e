// Which of the voxels that a solid touches are filled.
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

enum class Rule : std::uint8_t {
    touch,  // all: the closed solid meets the voxel's interior
    centre, // those whose centre lies in the closed solid; a surface without inside fills what it touches
    half,   // those where the volumes of solids add up to half of the voxel; surfaces with holes, balls: as centre
};

/// What becomes of parts that are too thin for a rule.
enum class Thin : std::uint8_t {
    keep, // voxels are added so that none of `touch` is without a filled one among it and its 26 neighbours
    drop, // nothing
};

} // namespace voxrt::voxelize
