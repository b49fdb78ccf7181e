// Cameras on a circle around a scene.
#pragma once

#include "framing.h"

namespace voxrt::sim {

/// `count` cameras, counterclockwise seen from above, in equal steps from that of frame_points(). Each sees all points:
/// the first one sees the upright cylinder around them.
std::vector<Camera> orbit(const std::vector<Point>& points, int32_t width, int32_t height, int count);

} // namespace voxrt::sim
