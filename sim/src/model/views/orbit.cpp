#include "orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxrt::sim {

namespace {

constexpr int kCorners = 64; // of the polygon that stands for the circle around the scene

} // namespace

std::vector<Camera> orbit(const std::vector<Point>& points, int32_t width, int32_t height, int count) {
    Point low = points.at(0), high = low;
    for (const Point& point : points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    const Point centre = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
    double square = 0;
    for (const Point& point : points) {
        const double x = point[0] - centre[0], z = point[2] - centre[2];
        square = std::max(square, x * x + z * z);
    }
    const double radius = std::sqrt(square) / std::cos(std::numbers::pi / kCorners);
    std::vector<Point> cylinder;
    for (const double y : {low[1], high[1]})
        for (int corner = 0; corner < kCorners; ++corner) {
            const double angle = 2 * std::numbers::pi * corner / kCorners;
            cylinder.push_back({centre[0] + radius * std::cos(angle), y, centre[2] + radius * std::sin(angle)});
        }
    const Camera first = frame_points(cylinder, width, height);
    Point eye;
    for (int axis = 0; axis < 3; ++axis)
        eye[axis] = first.position[axis] / 16.0 - centre[axis];
    std::vector<Camera> cameras;
    for (int step = 0; step < count; ++step) {
        const double angle = 2 * std::numbers::pi * step / count;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const auto turned = [&](const auto& v) {
            return Point{cosine * v[0] + sine * v[2], double(v[1]), cosine * v[2] - sine * v[0]};
        };
        const Point from = turned(eye);
        cameras.push_back(look_along({centre[0] + from[0], centre[1] + from[1], centre[2] + from[2]},
                                     turned(first.look), width, height));
    }
    return cameras;
}

} // namespace voxrt::sim
