#include "surface_points.h"

#include <voxrt/octree/query/query.h>
#include <voxrt/voxelize/work/interrupt.h>
#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace voxrt::sim {
namespace {

using Vector = std::array<double, 3>;

constexpr double kNear2 = 0.75;     // (sqrt(3) / 2)^2: a voxel's corners are so far from its centre
constexpr double kSlope = 0.05;     // a face is seen by a normal whose component towards it exceeds this
constexpr int kWindow = 2;          // voxels around one whose normal is that of the voxels
constexpr double kAlongAxis = 0.99; // of a unit normal: its largest component, if it counts as along an axis
constexpr double kStride = 0.25;    // voxels
constexpr std::uint32_t kBrickWork = 1000, kTriangleWork = 20;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }
Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return length > 1e-9 ? Vector{a[0] / length, a[1] / length, a[2] / length} : Vector{};
}

// The position of a voxel in its brick, from its index there.
std::array<int, 3> place_of(std::size_t index) {
    std::array<int, 3> place{};
    for (unsigned bit = 0; bit < 3; ++bit)
        for (unsigned axis = 0; axis < 3; ++axis)
            place[axis] |= static_cast<int>(index >> (3 * bit + axis) & 1) << bit;
    return place;
}

std::array<std::int64_t, 3> corner_of(std::uint64_t code) {
    std::array<std::int64_t, 3> corner{};
    for (unsigned bit = 0; bit < 16; ++bit)
        for (unsigned axis = 0; axis < 3; ++axis)
            corner[axis] |= static_cast<std::int64_t>(code >> (3 * bit + axis) & 1) << (bit + 3);
    return corner;
}

// Whether a normal points towards an exposed face.
bool sees(std::uint8_t exposed, const Vector& normal) {
    for (unsigned axis = 0; axis < 3; ++axis)
        if ((exposed >> 2 * axis & 1 && normal[axis] < -kSlope) ||
            (exposed >> (2 * axis + 1) & 1 && normal[axis] > kSlope))
            return true;
    return false;
}

// The sum of the directions of the exposed faces.
Vector open_side(std::uint8_t exposed) {
    Vector sum{};
    for (unsigned axis = 0; axis < 3; ++axis)
        sum[axis] = (exposed >> (2 * axis + 1) & 1) - (exposed >> 2 * axis & 1);
    return sum;
}

// The barycentric coordinates of the point of a triangle nearest to p: Ericson, "Real-Time Collision Detection", 2005,
// section 5.1.5.
Vector nearest_point(const Vector& p, const double* t) {
    const auto from = [&](int k, const Vector& q) {
        return Vector{q[0] - t[3 * k], q[1] - t[3 * k + 1], q[2] - t[3 * k + 2]};
    };
    const Vector b{t[3], t[4], t[5]}, c{t[6], t[7], t[8]};
    const Vector ab = from(0, b), ac = from(0, c), ap = from(0, p), bp = from(1, p), cp = from(2, p);
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0)
        return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3)
        return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (d6 >= 0 && d5 <= d6)
        return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

// What the triangles near one voxel say of one of its sides.
struct Side {
    Vector sum{};
    Vector point{};
    double nearest = 1; // squared distance of `point` from the centre; 1: there is none

    void add(const Vector& normal, double weight, const Vector& at, double distance2) {
        for (int axis = 0; axis < 3; ++axis)
            sum[axis] += weight * normal[axis];
        if (distance2 < nearest) {
            nearest = distance2;
            point = at;
        }
    }
    bool found() const { return nearest < 1 && !is_zero(unit(sum)); }
};

struct Voxel {
    Vector reference{}; // tells its two sides apart
    Side front, back, unseen;
};

class Brick {
public:
    Brick(const octree::VerifiedMemory& memory, const ExposedBricks& bricks, const Triangles& triangles,
          const BrickTriangles& near)
        : memory_(memory), bricks_(bricks), triangles_(triangles), near_(near) {}

    void measure(std::size_t brick, SurfacePoints& out) {
        voxelize::count_work(kBrickWork);
        corner_ = corner_of(bricks_.brick_codes[brick]);
        exposed_ = &bricks_.exposed[kBrickVoxels * brick];
        voxels_.assign(kBrickVoxels, {});
        for (std::size_t i = near_.first[brick]; i < near_.first[brick + 1]; ++i)
            add(near_.triangles[i]);
        has_window_ = false;
        for (std::size_t i = 0; i < kBrickVoxels; ++i)
            if (exposed_[i])
                place_points(kBrickVoxels * brick + i, i, out);
    }

private:
    Vector centre_of(const std::array<int, 3>& place) const {
        return {corner_[0] + place[0] + 0.5, corner_[1] + place[1] + 0.5, corner_[2] + place[2] + 0.5};
    }

    // Adds what a triangle says to the exposed voxels near it.
    void add(std::size_t triangle) {
        const double* corners = triangles_.corners + 9 * triangle;
        const float* normals = triangles_.normals + 9 * triangle;
        int low[3], high[3];
        double area2 = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto [least, most] = std::minmax({corners[axis], corners[3 + axis], corners[6 + axis]});
            low[axis] = static_cast<int>(std::clamp(std::floor(least - corner_[axis] - 0.5), 0.0, 8.0));
            high[axis] = static_cast<int>(std::clamp(std::ceil(most - corner_[axis] + 0.5), 0.0, 8.0));
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            const double part = (corners[3 + next] - corners[next]) * (corners[6 + last] - corners[last]) -
                                (corners[3 + last] - corners[last]) * (corners[6 + next] - corners[next]);
            area2 += part * part;
        }
        const double area = std::min(1.0, std::sqrt(area2) / 2);
        for (int z = low[2]; z < high[2]; ++z)
            for (int y = low[1]; y < high[1]; ++y)
                for (int x = low[0]; x < high[0]; ++x) {
                    const std::size_t index = kSpread[x] | kSpread[y] << 1 | kSpread[z] << 2;
                    if (exposed_[index])
                        add(corners, normals, area, index, centre_of({x, y, z}));
                }
    }

    void add(const double* corners, const float* normals, double area, std::size_t index, const Vector& centre) {
        const Vector share = nearest_point(centre, corners);
        Vector at{}, normal{};
        double distance2 = 0;
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 3; ++k) {
                at[axis] += share[k] * corners[3 * k + axis];
                normal[axis] += share[k] * normals[3 * k + axis];
            }
            distance2 += (at[axis] - centre[axis]) * (at[axis] - centre[axis]);
        }
        normal = unit(normal);
        if (!(distance2 < kNear2) || is_zero(normal))
            return;
        voxelize::count_work(kTriangleWork);
        Voxel& voxel = voxels_[index];
        const double weight = (area + 1e-9) * (kNear2 - distance2);
        if (!sees(exposed_[index], normal)) {
            if (voxel.unseen.nearest < 1 && dot(normal, voxel.unseen.sum) < 0)
                normal = minus(normal);
            voxel.unseen.add(normal, weight, at, distance2);
            return;
        }
        if (is_zero(voxel.reference)) {
            const Vector open = unit(open_side(exposed_[index]));
            voxel.reference = is_zero(open) ? normal : open;
        }
        (dot(normal, voxel.reference) >= 0 ? voxel.front : voxel.back).add(normal, weight, at, distance2);
    }

    void place_points(std::uint64_t number, std::size_t index, SurfacePoints& out) {
        const std::uint8_t exposed = exposed_[index];
        const std::array<int, 3> place = place_of(index);
        const Vector centre = centre_of(place);
        Voxel& voxel = voxels_[index];
        Side front = voxel.front;
        bool has_back = voxel.back.found();
        if (!front.found()) {
            front = voxel.back;
            has_back = false;
        }
        if (!front.found()) {
            front = voxel.unseen;
            if (front.found() && !sees(exposed, unit(front.sum)))
                front.sum = minus(front.sum);
        }
        if (!front.found() || !sees(exposed, unit(front.sum)))
            front = {window_normal(place, exposed), centre, 0};
        const Vector normal = unit(front.sum);
        add_point(number, place, exposed, normal, front.point, out);
        // A second point where the voxel is exposed on the other side too.
        const auto most = std::max_element(normal.begin(), normal.end(),
                                           [](double a, double b) { return std::abs(a) < std::abs(b); });
        const unsigned axis = static_cast<unsigned>(most - normal.begin());
        if (exposed >> (2 * axis) & exposed >> (2 * axis + 1) & 1) {
            const Side& back = voxel.back;
            if (has_back && sees(exposed, unit(back.sum)))
                add_point(number, place, exposed, unit(back.sum), back.point, out);
            else
                add_point(number, place, exposed, minus(normal), front.point, out);
        }
    }

    void add_point(std::uint64_t number, const std::array<int, 3>& place, std::uint8_t exposed, const Vector& normal,
                   const Vector& point, SurfacePoints& out) const {
        const double most = std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])});
        double height = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
        if (most > kAlongAxis)
            height -= 0.5;
        std::array<std::int64_t, 3> origin;
        for (double along = height;; along += kStride) {
            double above = 0;
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis] = static_cast<std::int64_t>(std::floor(point[axis] + along * normal[axis]));
                above += (static_cast<double>(origin[axis]) + 0.5 - point[axis]) * normal[axis];
            }
            if (above >= height - 1e-6)
                break;
        }
        std::uint8_t material = 0;
        octree::materials_at(memory_.memory(), origin.data(), 1, &material);
        if (material != 0) {
            double best = -2;
            unsigned beyond = 0;
            for (unsigned face = 0; face < 6; ++face) {
                const double facing = face & 1 ? normal[face / 2] : -normal[face / 2];
                if (exposed >> face & 1 && facing > best) {
                    best = facing;
                    beyond = face;
                }
            }
            for (unsigned axis = 0; axis < 3; ++axis)
                origin[axis] = corner_[axis] + place[axis];
            origin[beyond / 2] += beyond & 1 ? 1 : -1;
        }
        out.voxels.push_back(number);
        for (int axis = 0; axis < 3; ++axis) {
            out.origins.push_back(static_cast<std::int32_t>(origin[axis]));
            out.normals.push_back(static_cast<std::int16_t>(std::floor(kUnitNormal * normal[axis] + 0.5)));
        }
    }

    // A unit vector from the solid to the empty voxels around one, or, where these are in balance, out of its highest
    // exposed face.
    Vector window_normal(const std::array<int, 3>& place, std::uint8_t exposed) {
        constexpr std::int64_t side = 8 + 2 * kWindow;
        if (!has_window_) {
            window_.resize(side * side * side);
            octree::fill_region(memory_.memory(),
                                {{corner_[0] - kWindow, corner_[1] - kWindow, corner_[2] - kWindow},
                                 {corner_[0] + 8 + kWindow, corner_[1] + 8 + kWindow, corner_[2] + 8 + kWindow}},
                                window_.data());
            has_window_ = true;
        }
        Vector sum{};
        for (int x = -kWindow; x <= kWindow; ++x)
            for (int y = -kWindow; y <= kWindow; ++y)
                for (int z = -kWindow; z <= kWindow; ++z)
                    if (window_[((place[0] + x + kWindow) * side + place[1] + y + kWindow) * side + place[2] + z +
                                kWindow] == 0) {
                        sum[0] += x;
                        sum[1] += y;
                        sum[2] += z;
                    }
        sum = unit(sum);
        if (!sees(exposed, sum))
            sum = unit(open_side(exposed));
        constexpr unsigned kOrder[6] = {3, 1, 0, 5, 4, 2}; // upwards, the sides, downwards
        for (unsigned i = 0; i < 6 && is_zero(sum); ++i)
            if (exposed >> kOrder[i] & 1)
                sum[kOrder[i] / 2] = kOrder[i] & 1 ? 1 : -1;
        return sum;
    }

    static constexpr std::size_t kSpread[8] = {0, 1, 8, 9, 64, 65, 72, 73};

    const octree::VerifiedMemory& memory_;
    const ExposedBricks& bricks_;
    const Triangles& triangles_;
    const BrickTriangles& near_;
    std::array<std::int64_t, 3> corner_{};
    const std::uint8_t* exposed_ = nullptr;
    std::vector<Voxel> voxels_;
    std::vector<std::uint8_t> window_;
    bool has_window_ = false;
};

} // namespace

SurfacePoints surface_points(const octree::VerifiedMemory& memory, const ExposedBricks& bricks,
                             const Triangles& triangles, int threads) {
    constexpr std::size_t kBricksPerJob = 64;
    const BrickTriangles near = brick_triangles(triangles, bricks.brick_codes, memory.depth());
    const std::size_t count = bricks.brick_codes.size(), jobs = (count + kBricksPerJob - 1) / kBricksPerJob;
    std::vector<SurfacePoints> parts(jobs);
    voxelize::Workers(threads).run(jobs, [&](std::size_t job, int) {
        Brick brick(memory, bricks, triangles, near);
        for (std::size_t b = job * kBricksPerJob; b < std::min((job + 1) * kBricksPerJob, count); ++b)
            brick.measure(b, parts[job]);
    });
    SurfacePoints out;
    for (SurfacePoints& part : parts) {
        out.voxels.insert(out.voxels.end(), part.voxels.begin(), part.voxels.end());
        out.origins.insert(out.origins.end(), part.origins.begin(), part.origins.end());
        out.normals.insert(out.normals.end(), part.normals.begin(), part.normals.end());
        part = {};
    }
    return out;
}

SurfacePoints face_points(const octree::VerifiedMemory& memory, std::span<const std::uint64_t> brick_codes,
                          std::span<const std::uint64_t> voxels) {
    SurfacePoints out;
    for (const std::uint64_t voxel : voxels) {
        const std::array<std::int64_t, 3> corner = corner_of(brick_codes[voxel / kBrickVoxels]);
        const std::array<int, 3> place = place_of(voxel % kBrickVoxels);
        voxelize::count_work(kTriangleWork);
        for (unsigned face = 0; face < 6; ++face) {
            const int towards = face & 1 ? 1 : -1;
            std::array<std::int64_t, 3> beyond{corner[0] + place[0], corner[1] + place[1], corner[2] + place[2]};
            beyond[face / 2] += towards;
            std::uint8_t material = 0;
            octree::materials_at(memory.memory(), beyond.data(), 1, &material);
            if (material != 0)
                continue;
            out.voxels.push_back(voxel);
            for (unsigned axis = 0; axis < 3; ++axis) {
                out.origins.push_back(static_cast<std::int32_t>(beyond[axis]));
                out.normals.push_back(static_cast<std::int16_t>(axis == face / 2 ? towards * kUnitNormal : 0));
            }
        }
    }
    return out;
}

} // namespace voxrt::sim
