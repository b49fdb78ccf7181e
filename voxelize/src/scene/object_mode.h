// How the inside of an object was told from its outside.
#pragma once

#include "fill.h"

#include <array>
#include <cstdint>

namespace voxrt::voxelize {

enum class ObjectMode : std::uint8_t {
    surface, // it was not filled
    exact,   // it closes and does not overlap itself: its winding numbers are 0 and 1
    winding, // it has holes or overlaps itself: the generalized winding number decides
    open,    // some of it stands open, like a room without a front, and was not filled; the rest is as in `winding`
    turned,  // it closes; faces or connected components that were inside out were turned
};

/// The names of the modes in Python and in manifests, by number.
inline constexpr std::array<const char*, 5> kObjectModeNames = {"surface", "exact", "winding", "open", "turned"};

/// What the parts of an object turned out to be, taken together.
struct ObjectFindings {
    bool has_open_enclosure = false; // CappedSurface: a part encloses space and has a large opening
    bool has_turned_faces = false;   // in a part that closes: of faces or of connected components
    bool has_boundary = false;       // a mesh part does not close
    bool overlaps_itself = false;    // winding numbers other than 0 and 1, or 0 and -1, were met
};

/// Decides the mode of an object. `fill`: its inside was asked for.
constexpr ObjectMode object_mode(Fill fill, const ObjectFindings& found) {
    if (!fills(fill))
        return ObjectMode::surface;
    if (found.has_open_enclosure)
        return ObjectMode::open;
    if (found.has_turned_faces)
        return ObjectMode::turned;
    return found.has_boundary || found.overlaps_itself ? ObjectMode::winding : ObjectMode::exact;
}

} // namespace voxrt::voxelize
