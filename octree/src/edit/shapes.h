// Solids that an edit fills: which voxels are theirs, exactly, and how an octant lies in them.
//
// A voxel is of a ball or of a capsule if its centre is: the surface counts. Positions and radii are whole numbers of
// 1/kShapeUnit voxel, between -kShapeReach and kShapeReach. No square is rounded.
#pragma once

#include "../query/query.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

namespace voxrt::octree {

constexpr std::int64_t kShapeUnit = 16;
constexpr std::int64_t kShapeReach = std::int64_t{1} << 24;

using Place = std::array<std::int64_t, 3>;

struct Ball {
    Place centre;
    std::int64_t radius; // 0 or more
};

/// What is within `radius` of the line from `start` to `end`.
struct Capsule {
    Place start, end;
    std::int64_t radius; // 0 or more
};

using Shape = std::variant<Box, Ball, Capsule>;

/// `part`: some voxels may be in the shape, and some may not. Never for a voxel.
enum class Cover : std::uint8_t { none, part, all };

/// The centres of the voxels of an octant lie from low() to high() on each axis.
struct OctantCentres {
    Place corner; // the lowest voxel
    unsigned level;

    std::int64_t low(unsigned axis) const { return kShapeUnit * corner[axis] + kShapeUnit / 2; }
    std::int64_t high(unsigned axis) const { return low(axis) + kShapeUnit * ((std::int64_t{1} << level) - 1); }
};

inline Cover cover(const Box& box, const Place& corner, unsigned level) {
    const std::int64_t side = std::int64_t{1} << level;
    bool inside = true;
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (corner[axis] >= box.high[axis] || corner[axis] + side <= box.low[axis])
            return Cover::none;
        inside = inside && corner[axis] >= box.low[axis] && corner[axis] + side <= box.high[axis];
    }
    return inside ? Cover::all : Cover::part;
}

inline Cover cover(const Ball& ball, const Place& corner, unsigned level) {
    const OctantCentres centres{corner, level};
    std::int64_t nearest = 0, farthest = 0; // squares
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::int64_t below = centres.low(axis) - ball.centre[axis],
                           above = centres.high(axis) - ball.centre[axis];
        const std::int64_t near = std::max({below, -above, std::int64_t{0}}), far = std::max(-below, above);
        nearest += near * near;
        farthest += far * far;
    }
    const std::int64_t square = ball.radius * ball.radius;
    return farthest <= square ? Cover::all : nearest > square ? Cover::none : Cover::part;
}

/// Whether a point is in a capsule.
inline bool holds(const Capsule& capsule, const Place& point) {
    std::int64_t length = 0, along = 0, from_start = 0, from_end = 0; // products and squares
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::int64_t axle = capsule.end[axis] - capsule.start[axis], way = point[axis] - capsule.start[axis];
        length += axle * axle;
        along += axle * way;
        from_start += way * way;
        from_end += (point[axis] - capsule.end[axis]) * (point[axis] - capsule.end[axis]);
    }
    const std::int64_t square = capsule.radius * capsule.radius;
    if (along <= 0)
        return from_start <= square;
    if (along >= length)
        return from_end <= square;
    __extension__ using Wide = __int128;
    return Wide{from_start - square} * length <= Wide{along} * along;
}

inline Cover cover(const Capsule& capsule, const Place& corner, unsigned level) {
    const OctantCentres centres{corner, level};
    // Convex: it holds an octant if it holds the corners.
    unsigned held = 0;
    for (unsigned octant = 0; octant < (level == 0 ? 1u : 8u); ++octant) {
        Place point;
        for (unsigned axis = 0; axis < 3; ++axis)
            point[axis] = octant >> axis & 1 ? centres.high(axis) : centres.low(axis);
        held += holds(capsule, point);
    }
    if (level == 0)
        return held == 1 ? Cover::all : Cover::none;
    if (held == 8)
        return Cover::all;
    if (held != 0)
        return Cover::part;
    // The ball around the octant against the line, in doubles, a unit too large: this only saves the way further down.
    double length = 0, along = 0, square = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const double axle = static_cast<double>(capsule.end[axis] - capsule.start[axis]);
        const double way =
            static_cast<double>(centres.low(axis) + centres.high(axis)) / 2 - static_cast<double>(capsule.start[axis]);
        length += axle * axle;
        along += axle * way;
        square += way * way;
    }
    const double part = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    const double distance = std::sqrt(std::max(0.0, square - 2 * part * along + part * part * length));
    const double half = static_cast<double>(centres.high(0) - centres.low(0)) / 2;
    return distance > static_cast<double>(capsule.radius) + half * 1.7320508075688774 + 1 ? Cover::none : Cover::part;
}

} // namespace voxrt::octree
