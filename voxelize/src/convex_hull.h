// The convex hull of snapped points, exactly.
//
// Incremental: a point that some faces see takes their place, joined to the rim of what it saw. Faces that it lies in
// the plane of count as unseen, so no face is ever degenerate. Every decision is the sign of an exact volume.
//
// Bound: points times faces; meant for colliders.
#pragma once

#include "fixed_point.h"

#include <array>
#include <vector>

namespace voxrt {

/// Triangles over `points`, counter-clockwise seen from outside. Points in one plane give their polygon twice, facing
/// both ways; points on one line give nothing.
std::vector<std::array<int32_t, 3>> convex_hull(const std::vector<Vertex>& points);

} // namespace voxrt
