#include "framing.h"

#include <voxrt/octree/build/coarsen.h>
#include <voxrt/octree/query/leaves.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace voxrt::sim {

namespace {

using Axes = std::array<Point, 3>; // look, right, up

constexpr double kFieldOfView = 35; // degrees across the frame's shorter side
constexpr Point kThreeQuarter = {-0.62, -0.68, -1.0};
constexpr double kMargin = 0.085; // of the frame's side, left free on each side
constexpr double kRegisterLimit = 1 << 15, kDirectionLimitOfFrames = 1 << 20;
constexpr unsigned kOutlineLevels = 6;
constexpr int kCorners = 64; // of the polygon that stands for the circle around the scene

Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point unit(const Point& v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

Axes axes_along(const Point& look) {
    const Point right = cross(look, {0, 1, 0});
    return {unit(look), unit(right), unit(cross(right, look))};
}

double focal_length(int32_t width, int32_t height) {
    return std::min(width, height) / (2 * std::tan(kFieldOfView * (std::numbers::pi / 180) / 2));
}

/// Solves rows^T (z, x, y) = p by elimination with the largest pivots.
Point coordinates(const Axes& rows, Point p) {
    std::array<Point, 3> m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m[i][j] = rows[j][i];
    for (int column = 0; column < 3; ++column) {
        int pivot = column;
        for (int row = column + 1; row < 3; ++row)
            if (std::abs(m[row][column]) > std::abs(m[pivot][column]))
                pivot = row;
        std::swap(m[column], m[pivot]);
        std::swap(p[column], p[pivot]);
        for (int row = column + 1; row < 3; ++row) {
            const double factor = m[row][column] / m[column][column];
            for (int k = column + 1; k < 3; ++k)
                m[row][k] -= factor * m[column][k];
            p[row] -= factor * p[column];
        }
    }
    for (int row = 2; row >= 0; --row) {
        for (int k = row + 1; k < 3; ++k)
            p[row] -= m[row][k] * p[k];
        p[row] /= m[row][row];
    }
    return p;
}

/// Where a camera of these registers sees all points. In their frame the eye (ez, ex, ey) sees x within the slope s
/// when |x - ex| <= s (z - ez): the two tightest corners a side give ez, and half way between them ex.
Point eye_that_sees(const std::vector<Point>& points, const Axes& rows, int32_t width, int32_t height) {
    const double slope[2] = {std::max(0.5, width * (0.5 - kMargin) - 1), std::max(0.5, height * (0.5 - kMargin) - 1)};
    double least[2], most[2];
    std::fill_n(least, 2, std::numeric_limits<double>::infinity());
    std::fill_n(most, 2, -std::numeric_limits<double>::infinity());
    for (const Point& point : points) {
        const Point found = coordinates(rows, point);
        for (int side = 0; side < 2; ++side) {
            least[side] = std::min(least[side], found[1 + side] + slope[side] * found[0]);
            most[side] = std::max(most[side], found[1 + side] - slope[side] * found[0]);
        }
    }
    const double z = std::min((least[0] - most[0]) / (2 * slope[0]), (least[1] - most[1]) / (2 * slope[1]));
    const double x = (least[0] + most[0]) / 2, y = (least[1] + most[1]) / 2;
    Point eye;
    for (int axis = 0; axis < 3; ++axis)
        eye[axis] = z * rows[0][axis] + x * rows[1][axis] + y * rows[2][axis];
    return eye;
}

/// Registers of the largest scale at which they fit and directions stay below the limit; no position yet.
Camera scaled(const Axes& axes, double focal, int32_t width, int32_t height) {
    const double rounding = 1 + width / 2 + height / 2;
    double largest = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double look = std::abs(axes[0][axis] * focal), right = std::abs(axes[1][axis]),
                     up = std::abs(axes[2][axis]);
        largest = std::max({largest, look, right, up});
        reach = std::max(reach, look + right * (width / 2) + up * (height / 2));
    }
    const double scale = std::min((kRegisterLimit - 1) / largest, (kDirectionLimitOfFrames - 1 - rounding) / reach);
    Camera camera{};
    for (int axis = 0; axis < 3; ++axis) {
        camera.look[axis] = static_cast<int32_t>(std::nearbyint(axes[0][axis] * focal * scale));
        camera.right[axis] = static_cast<int32_t>(std::nearbyint(axes[1][axis] * scale));
        camera.up[axis] = static_cast<int32_t>(std::nearbyint(axes[2][axis] * scale));
    }
    return camera;
}

} // namespace

std::vector<Point> outline_points(const octree::VerifiedMemory& memory) {
    const unsigned depth = memory.depth();
    const unsigned level = depth > kOutlineLevels ? depth - kOutlineLevels : 0;
    const octree::Words words = octree::coarsened(memory.memory(), level);
    const int64_t side = int64_t{1} << depth;
    std::vector<Point> points;
    const auto add = [&points](const auto& corner, double size) {
        for (int i = 0; i < 8; ++i)
            points.push_back(
                {corner[0] + (i & 1 ? size : 0), corner[1] + (i & 2 ? size : 0), corner[2] + (i & 4 ? size : 0)});
    };
    octree::LeafWalk walk({words.data(), words.size(), depth}, {{0, 0, 0}, {side, side, side}}, true);
    for (auto leaves = walk.next(4096); !leaves.empty(); leaves = walk.next(4096))
        for (const octree::Leaf& leaf : leaves)
            add(leaf.corner, std::ldexp(1.0, static_cast<int>(leaf.level)));
    if (points.empty())
        add(Point{}, static_cast<double>(side));
    return points;
}

Camera frame_points(const std::vector<Point>& points, int32_t width, int32_t height) {
    const Axes axes = axes_along(kThreeQuarter);
    const double focal = focal_length(width, height);
    Axes ahead = axes;
    for (double& part : ahead[0])
        part *= focal;
    return look_along(eye_that_sees(points, ahead, width, height), kThreeQuarter, width, height);
}

Camera look_along(const Point& eye, const Point& look, int32_t width, int32_t height) {
    Camera camera = scaled(axes_along(look), focal_length(width, height), width, height);
    for (int axis = 0; axis < 3; ++axis)
        camera.position[axis] = static_cast<int32_t>(std::nearbyint(eye[axis] * 16));
    return camera;
}

Camera refit(const Camera& camera, const Size& made_for, const Size& size) {
    if (size == made_for)
        return camera;
    const double longer = static_cast<double>(std::min(size[0], size[1])) / std::min(made_for[0], made_for[1]);
    Axes rows;
    for (int axis = 0; axis < 3; ++axis) {
        rows[0][axis] = camera.look[axis] * longer;
        rows[1][axis] = camera.right[axis];
        rows[2][axis] = camera.up[axis];
    }
    Camera made = scaled(rows, 1.0, size[0], size[1]);
    std::copy_n(camera.position, 3, made.position);
    return made;
}

Camera frame_along(const Point& look, const std::vector<Point>& points, int32_t width, int32_t height) {
    Camera camera = scaled(axes_along(unit(look)), focal_length(width, height), width, height);
    Axes registers;
    for (int axis = 0; axis < 3; ++axis) {
        registers[0][axis] = camera.look[axis];
        registers[1][axis] = camera.right[axis];
        registers[2][axis] = camera.up[axis];
    }
    const Point eye = eye_that_sees(points, registers, width, height);
    for (int axis = 0; axis < 3; ++axis)
        camera.position[axis] = static_cast<int32_t>(std::floor(16 * eye[axis] + 0.5));
    return camera;
}

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
