// The convex hull of snapped points, exactly.
//
// Incremental: a point removes the faces that it sees and is joined to the edges around them. Faces in whose plane it
// lies count as unseen, so no face is ever degenerate. Every decision is the sign of an exact volume. Points in one
// plane: Andrew's monotone chain (1979).
//
// Cost: points times faces; meant for colliders.
#pragma once

#include "../grid/fixed_point.h"

#include <array>
#include <vector>

namespace voxrt::voxelize {

/// Triangles over `points`, counter-clockwise seen from outside. Points in one plane give their polygon twice, facing
/// both ways; points on one line give nothing.
std::vector<std::array<int32_t, 3>> convex_hull(const std::vector<Vertex>& points);

} // namespace voxrt::voxelize
