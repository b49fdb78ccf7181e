#include "placed_triangles.h"

#include "corner_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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
                smooth_ = smooth(mesh_.positions);
            found = turned(smooth_, linear);
        } else {
            found = smooth(positions);
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

    std::vector<float> smooth(std::span<const double> positions) const {
        return corner_normals(positions.data(), positions.size() / 3, mesh_.triangles.data(),
                              mesh_.triangles.size() / 3, kCreaseCosine);
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
