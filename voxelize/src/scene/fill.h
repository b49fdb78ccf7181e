// What of an object becomes solid besides its shell.
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

enum class Fill : std::uint8_t {
    solid,     // what surfaces enclose, holes or not, but for components with one large opening
    surface,   // nothing: shells alone
    automatic, // as solid, but components whose openings are large together keep a shell alone too (capped_surface.h)
};

constexpr bool fills(Fill fill) { return fill != Fill::surface; }

} // namespace voxrt::voxelize
