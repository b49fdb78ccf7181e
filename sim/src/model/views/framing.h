// Cameras that see all of a memory, as voxrt.octree.camera and voxrt.views.viewpoint make them.
#pragma once

#include "../frames/frame.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

using Point = std::array<double, 3>;

/// Points whose convex hull holds all that is solid, or the world, known to 1/64 of the world: voxels, grid frame.
std::vector<Point> outline_points(const octree::VerifiedMemory& memory);

/// The camera that sees all points, tightly, from the front right and above.
Camera frame_points(const std::vector<Point>& points, int32_t width, int32_t height);

/// The camera at `eye`, voxels, that looks along `look`, which is not upright.
Camera look_along(const Point& eye, const Point& look, int32_t width, int32_t height);

/// Columns and rows.
using Size = std::array<int32_t, 2>;

/// A camera for frames of size `made_for`, with the same angle across the shorter side of frames of size `size`.
Camera refit(const Camera& camera, const Size& made_for, const Size& size);

/// The camera that looks along `look` and sees all points, tightly.
Camera frame_along(const Point& look, const std::vector<Point>& points, int32_t width, int32_t height);

/// `count` cameras, counterclockwise seen from above, in equal steps from that of frame_points(). Each sees all points:
/// the first one sees the upright cylinder around them.
std::vector<Camera> orbit(const std::vector<Point>& points, int32_t width, int32_t height, int count);

} // namespace voxrt::sim
