#include "placed_triangles.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

namespace voxrt::sim {

namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>; // rows

constexpr double kFarthest = 1e9; // voxels
const double kCreaseCosine = std::cos(45 * std::numbers::pi / 180);

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector row(std::span<const double> values, std::size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

Vector product(const Matrix& m, const Vector& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

// The directions as unit vectors, zero for those that are none. No square overflows or vanishes.
std::vector<Vector> unit_directions(std::span<const double> directions) {
    std::vector<Vector> found(directions.size() / 3);
    for (std::size_t i = 0; i < found.size(); ++i) {
        Vector v = row(directions, i);
        double largest = 0;
        bool finite = true;
        for (const double part : v) {
            finite &= std::isfinite(part);
            largest = std::max(largest, std::abs(part));
        }
        if (!finite || largest == 0)
            continue;
        for (double& part : v)
            part /= largest;
        const double size = std::sqrt(dot(v, v));
        found[i] = {v[0] / size, v[1] / size, v[2] / size};
    }
    return found;
}

// Whether a transform turns, mirrors and scales evenly.
bool keeps_angles(const Matrix& m) {
    Matrix squares{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                squares[i][j] += m[k][i] * m[k][j];
    const double scale = (squares[0][0] + squares[1][1] + squares[2][2]) / 3;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            worst = std::max(worst, std::abs(squares[i][j] - (i == j ? scale : 0)));
    return worst <= 1e-6 * scale;
}

constexpr std::size_t kMostNeighbours = 256; // of one place: more are summed without looking at their angles

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return length > 0 && std::isfinite(length) ? Vector{a[0] / length, a[1] / length, a[2] / length} : Vector{};
}

// The number of each vertex's place: vertices with equal coordinates have one.
std::vector<std::uint32_t> places(const double* positions, std::size_t vertices) {
    std::vector<std::uint32_t> order(vertices), place(vertices);
    std::iota(order.begin(), order.end(), 0u);
    const auto at = [&](std::uint32_t v) { return positions + 3 * std::size_t{v}; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::lexicographical_compare(at(a), at(a) + 3, at(b), at(b) + 3);
    });
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        if (i != 0 && !std::equal(at(order[i]), at(order[i]) + 3, at(order[i - 1])))
            ++number;
        place[order[i]] = number;
    }
    return place;
}

// Unit normals of the corners, 9 numbers per triangle. The normal of a corner is the sum of the normals of the
// triangles at its place that form an angle of less than 45 degrees with its own, weighted by their angles there
// (Thurmer and Wuthrich, "Computing Vertex Normals from Polygonal Facets", 1998). Vertices with equal coordinates are
// one place. A triangle without area has zeros.
std::vector<float> corner_normals(std::span<const double> positions, std::span<const std::int32_t> triangles) {
    const std::size_t vertices = positions.size() / 3, count = triangles.size() / 3;
    const std::vector<std::uint32_t> place = places(positions.data(), vertices);
    std::vector<Vector> faces(count);
    std::vector<double> angles(3 * count, 0.0);
    for (std::size_t t = 0; t < count; ++t) {
        Vector corner[3];
        for (int k = 0; k < 3; ++k)
            std::copy_n(positions.data() + 3 * static_cast<std::size_t>(triangles[3 * t + k]), 3, corner[k].begin());
        faces[t] = unit(cross(corner[1] - corner[0], corner[2] - corner[0]));
        for (int k = 0; k < 3; ++k) {
            const Vector one = unit(corner[(k + 1) % 3] - corner[k]), other = unit(corner[(k + 2) % 3] - corner[k]);
            angles[3 * t + k] = std::acos(std::clamp(dot(one, other), -1.0, 1.0));
        }
    }
    // The corners at each place, one place after another.
    std::vector<std::size_t> first(vertices + 1, 0);
    for (std::size_t i = 0; i < 3 * count; ++i)
        ++first[place[triangles[i]] + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> corners(3 * count);
    std::vector<std::size_t> next = first;
    for (std::size_t i = 0; i < 3 * count; ++i)
        corners[next[place[triangles[i]]]++] = static_cast<std::uint32_t>(i);

    std::vector<float> normals(9 * count, 0.0f);
    for (std::size_t p = 0; p < vertices; ++p) {
        const std::size_t begin = first[p], end = first[p + 1];
        Vector all{};
        if (end - begin > kMostNeighbours)
            for (std::size_t j = begin; j < end; ++j)
                for (int axis = 0; axis < 3; ++axis)
                    all[axis] += angles[corners[j]] * faces[corners[j] / 3][axis];
        voxelize::count_work(static_cast<std::uint32_t>(1 + (end - begin)));
        for (std::size_t i = begin; i < end; ++i) {
            const Vector& own = faces[corners[i] / 3];
            Vector sum = all;
            if (end - begin <= kMostNeighbours)
                for (std::size_t j = begin; j < end; ++j)
                    if (const Vector& other = faces[corners[j] / 3]; dot(own, other) > kCreaseCosine)
                        for (int axis = 0; axis < 3; ++axis)
                            sum[axis] += angles[corners[j]] * other[axis];
            sum = unit(sum);
            if (dot(sum, own) <= 0)
                sum = own;
            for (int axis = 0; axis < 3; ++axis)
                normals[3 * std::size_t{corners[i]} + axis] = static_cast<float>(sum[axis]);
        }
    }
    return normals;
}

class Placer {
public:
    explicit Placer(const NormalMesh& mesh) : mesh_(mesh), directions_(unit_directions(mesh.directions)) {}

    void place(const Matrix& linear, const Vector& offset, PlacedTriangles& placed) {
        std::vector<double> positions(mesh_.positions.size());
        for (std::size_t i = 0; i < positions.size() / 3; ++i) {
            const Vector turned = product(linear, row(mesh_.positions, i));
            for (int axis = 0; axis < 3; ++axis) {
                const double place = turned[axis] + offset[axis];
                positions[3 * i + axis] = std::isnan(place) ? 0 : std::clamp(place, -kFarthest, kFarthest);
            }
        }
        const std::size_t first = placed.corners.size();
        for (const std::int32_t vertex : mesh_.triangles)
            placed.corners.insert(placed.corners.end(), positions.data() + 3 * std::size_t(vertex),
                                  positions.data() + 3 * std::size_t(vertex) + 3);
        placed.normals.resize(placed.corners.size());
        float* normals = placed.normals.data() + first;
        if (mesh_.rows.empty() || !place_authored(linear, normals))
            place_by_angle(linear, positions, normals);
    }

private:
    // Sets the author's normals; false where a corner has none, and then nothing. By the cofactors of the transform,
    // which exist where it has no inverse.
    bool place_authored(const Matrix& linear, float* normals) const {
        double largest = 0;
        for (const Vector& line : linear)
            for (const double part : line)
                largest = std::max(largest, std::abs(part));
        Matrix scaled = linear;
        for (Vector& line : scaled)
            for (double& part : line)
                part /= largest == 0 ? 1 : largest;
        const auto& [a, b, c] = scaled;
        Matrix cofactors{cross(b, c), cross(c, a), cross(a, b)};
        if (dot(a, cross(b, c)) < 0)
            for (Vector& line : cofactors)
                for (double& part : line)
                    part = -part;
        bool whole = true;
        for (std::size_t t = 0; t < mesh_.triangles.size() / 3; ++t) {
            Vector corner[3], own[3];
            for (int k = 0; k < 3; ++k) {
                corner[k] = row(mesh_.positions, std::size_t(mesh_.triangles[3 * t + k]));
                const std::int32_t direction = mesh_.rows[3 * t + k];
                own[k] = direction < 0 ? Vector{} : directions_[std::size_t(direction)];
            }
            Vector sides[2];
            for (int axis = 0; axis < 3; ++axis) {
                sides[0][axis] = corner[1][axis] - corner[0][axis];
                sides[1][axis] = corner[2][axis] - corner[1][axis];
            }
            const Vector face = cross(sides[0], sides[1]);
            const double side = dot(own[0], face) + dot(own[1], face) + dot(own[2], face) < 0 ? -1 : 1;
            for (int k = 0; k < 3; ++k) {
                const Vector turned = product(cofactors, Vector{side * own[k][0], side * own[k][1], side * own[k][2]});
                const double size = std::sqrt(dot(turned, turned));
                for (int axis = 0; axis < 3; ++axis)
                    normals[9 * t + 3 * k + axis] = size > 0 ? static_cast<float>(turned[axis] / size) : 0.0f;
                whole &= own[k][0] != 0 || own[k][1] != 0 || own[k][2] != 0;
            }
        }
        return whole;
    }

    // Sets normals from the angles between triangles, at corners that the author gave none.
    void place_by_angle(const Matrix& linear, const std::vector<double>& positions, float* normals) {
        std::vector<float> found;
        if (keeps_angles(linear)) {
            if (smooth_.empty())
                smooth_ = corner_normals(mesh_.positions, mesh_.triangles);
            found = turned(smooth_, linear);
        } else {
            found = corner_normals(positions, mesh_.triangles);
            if (dot(linear[0], cross(linear[1], linear[2])) < 0)
                for (float& part : found)
                    part = -part;
        }
        for (std::size_t corner = 0; corner < mesh_.triangles.size(); ++corner)
            if (!is_authored(corner))
                std::copy_n(found.data() + 3 * corner, 3, normals + 3 * corner);
    }

    bool is_authored(std::size_t corner) const {
        if (mesh_.rows.empty() || mesh_.rows[corner] < 0)
            return false;
        const Vector& own = directions_[std::size_t(mesh_.rows[corner])];
        return own[0] != 0 || own[1] != 0 || own[2] != 0;
    }

    static std::vector<float> turned(const std::vector<float>& normals, const Matrix& linear) {
        float m[3][3];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                m[i][j] = static_cast<float>(linear[i][j]);
        std::vector<float> found(normals.size());
        for (std::size_t i = 0; i < normals.size(); i += 3) {
            float v[3];
            for (int axis = 0; axis < 3; ++axis)
                v[axis] = m[axis][0] * normals[i] + m[axis][1] * normals[i + 1] + m[axis][2] * normals[i + 2];
            const float size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int axis = 0; axis < 3; ++axis)
                found[i + axis] = size > 0 ? v[axis] / std::max(size, std::numeric_limits<float>::min()) : 0.0f;
        }
        return found;
    }

    const NormalMesh& mesh_;
    std::vector<Vector> directions_;
    std::vector<float> smooth_; // in the mesh's frame, for all its objects
};

} // namespace

PlacedTriangles place_triangles(const std::vector<NormalMesh>& meshes, const std::vector<PlacedMesh>& objects,
                                const std::array<double, 3>& origin, double voxel_size) {
    PlacedTriangles placed;
    std::unordered_map<std::size_t, Placer> placers;
    for (const PlacedMesh& object : objects) {
        Placer& placer = placers.try_emplace(object.mesh, meshes[object.mesh]).first->second;
        Matrix linear;
        Vector offset;
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 3; ++k)
                linear[axis][k] = object.transform[4 * axis + k] / voxel_size;
            offset[axis] = (object.transform[4 * axis + 3] - origin[axis]) / voxel_size;
        }
        placer.place(linear, offset, placed);
    }
    return placed;
}

} // namespace voxrt::sim
