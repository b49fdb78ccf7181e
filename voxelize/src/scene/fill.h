// What of an object becomes solid besides its shell.
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

enum class Fill : std::uint8_t {
    surface,   // nothing: shells alone
    solid,     // what surfaces enclose, holes or not, but for components with one large opening
    automatic, // the same, but components whose openings are large together keep a shell alone too (capped_surface.h)
};

constexpr bool fills(Fill fill) { return fill != Fill::surface; }

} // namespace voxrt::voxelize
