#include "brick_triangles.h"

#include <voxrt/voxelize/grid/morton.h>
#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace voxrt::sim {
namespace {

constexpr double kSide = 8, kMargin = 1; // voxels

// One triangle: its box, and its plane with the distance from it up to which points count as near.
struct Reach {
    double low[3], high[3];
    double normal[3], offset;

    explicit Reach(const double* corners) {
        double edge[2][3];
        for (int axis = 0; axis < 3; ++axis) {
            const double a = corners[axis], b = corners[3 + axis], c = corners[6 + axis];
            low[axis] = std::min({a, b, c}) - kMargin;
            high[axis] = std::max({a, b, c}) + kMargin;
            edge[0][axis] = b - a;
            edge[1][axis] = c - a;
        }
        double length = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            normal[axis] = edge[0][next] * edge[1][last] - edge[0][last] * edge[1][next];
            length += normal[axis] * normal[axis];
        }
        length = std::sqrt(length);
        offset = 0;
        for (int axis = 0; axis < 3; ++axis) {
            normal[axis] = length > 0 ? normal[axis] / length : 0;
            offset += normal[axis] * corners[axis];
        }
    }

    // Whether a cube may be near the triangle.
    bool meets(double x, double y, double z, double side) const {
        const double corner[3] = {x, y, z};
        double distance = -offset, radius = 2 * kMargin;
        for (int axis = 0; axis < 3; ++axis) {
            if (corner[axis] > high[axis] || corner[axis] + side < low[axis])
                return false;
            distance += normal[axis] * (corner[axis] + side / 2);
            radius += std::abs(normal[axis]) * side / 2;
        }
        return std::abs(distance) <= radius;
    }
};

class Finder {
public:
    Finder(const std::vector<std::uint64_t>& codes, unsigned depth) : codes_(codes), depth_(depth) {}

    // Calls found(brick) for each brick near the triangle.
    template <class Found> void find(const double* corners, Found&& found) {
        descend(Reach(corners), 0, codes_.size(), 0, 0, 0, depth_ > 3 ? depth_ - 3 : 0, found);
    }

private:
    // The bricks begin … end-1 lie in the cube of 2^level bricks per side at (x, y, z), in bricks.
    template <class Found>
    void descend(const Reach& reach, std::size_t begin, std::size_t end, std::uint32_t x, std::uint32_t y,
                 std::uint32_t z, unsigned level, Found& found) {
        const double side = kSide * (std::uint64_t{1} << level);
        if (begin == end || !reach.meets(kSide * x, kSide * y, kSide * z, side))
            return;
        work_.count_step();
        if (level == 0) {
            found(begin);
            return;
        }
        const std::uint32_t half = std::uint32_t{1} << (level - 1);
        const std::uint64_t low = codes_[begin] >> 3 * level << 3 * level;
        std::size_t from = begin;
        for (unsigned octant = 0; octant < 8 && from != end; ++octant) {
            const std::uint64_t above = low + ((std::uint64_t{octant} + 1) << 3 * (level - 1));
            const std::size_t to =
                octant == 7 ? end
                            : std::lower_bound(codes_.begin() + from, codes_.begin() + end, above) - codes_.begin();
            descend(reach, from, to, x + (octant & 1 ? half : 0), y + (octant & 2 ? half : 0),
                    z + (octant & 4 ? half : 0), level - 1, found);
            from = to;
        }
    }

    const std::vector<std::uint64_t>& codes_;
    unsigned depth_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

BrickTriangles brick_triangles(const Triangles& triangles, const std::vector<std::uint64_t>& codes, unsigned depth) {
    if (std::uint64_t{triangles.count} >> 32 != 0)
        throw std::invalid_argument("there are 2**32 triangles or more");
    struct Pair {
        std::uint32_t triangle;
        std::uint32_t brick;
    };
    std::vector<Pair> pairs;
    Finder finder(codes, depth);
    for (std::size_t t = 0; t < triangles.count; ++t)
        finder.find(triangles.corners + 9 * t, [&](std::size_t brick) {
            pairs.push_back({static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(brick)});
        });
    BrickTriangles out;
    out.first.assign(codes.size() + 1, 0);
    for (const Pair& pair : pairs)
        ++out.first[pair.brick + 1];
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    out.triangles.resize(pairs.size());
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    for (const Pair& pair : pairs)
        out.triangles[next[pair.brick]++] = pair.triangle;
    return out;
}

} // namespace voxrt::sim
