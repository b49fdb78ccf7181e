// Triangles of a tile by column, for what is decided voxel by voxel.
#pragma once

#include "../coverage/exact_volume.h"
#include "../faces/exact_predicates.h"
#include "rule_tile.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace voxrt::voxelize {

/// Triangles of the solids of a tile, by column.
class TileSolids {
public:
    struct Listed {
        uint32_t part, number; // of the triangle in its part
        SolidTriangle triangle;
        std::array<int64_t, 3> low, high;
    };

    /// `columns`: by column of the tile whose lowest one is (x, y), whether it is asked for.
    TileSolids(const std::vector<bool>& columns, int x, int y) : x_(x), y_(y) {
        for (uint32_t column = 0; column < columns.size(); ++column)
            if (columns[column])
                wanted_.push_back(column);
    }

    /// `number`: of the triangle in its part.
    void add(uint32_t part, uint32_t number, const SolidTriangle& t) {
        Listed listed{part, number, t, {}, {}};
        for (int axis = 0; axis < 3; ++axis)
            std::tie(listed.low[size_t(axis)], listed.high[size_t(axis)]) = span_of(t, axis);
        const bool is_near = listed.low[0] <= (x_ + kTileSide) * kUnit && listed.high[0] >= x_ * kUnit &&
                             listed.low[1] <= (y_ + kTileSide) * kUnit && listed.high[1] >= y_ * kUnit;
        if (is_near && Plane(t).reach != 0)
            triangles_.push_back(listed);
    }

    /// Which of some voxels with sums nearer than `error` to a half have a half, without a look at each: in a brick
    /// whose lowest voxel is (x, y, z). If planes in the brick face so few axes that volumes are whole numbers of a
    /// step above 2 `error`, all have. A voxel that one plane alone passes has, if its centre is on that.
    Slices sure_halves(const Slices& voxels, int x, int y, int z, double error) const {
        constexpr size_t kFew = 64, kFewPlanes = 4; // kFew: per voxel
        if (triangles_.size() > kFew * size_t(count(voxels)))
            return {};
        const int64_t corner[3] = {x * kUnit, y * kUnit, z * kUnit};
        bool faces[3] = {}, oblique = false;
        std::vector<Plane> planes;
        for (const Listed& one : triangles_) {
            int flat = 3;
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis) {
                const int64_t low = one.low[size_t(axis)], high = one.high[size_t(axis)];
                apart = apart || low >= corner[axis] + kBrickSide * kUnit || high <= corner[axis];
                flat = low == high ? axis : flat;
            }
            if (apart)
                continue;
            (flat == 3 ? oblique : faces[flat]) = true;
            if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) { return p.holds(one.triangle); }))
                planes.emplace_back(one.triangle);
        }
        double step = 1;
        for (const bool faced : faces)
            step /= faced ? double(kUnit) : 1;
        if (!oblique && 2 * error < step)
            return voxels;
        Slices found{};
        for (int at = 0; planes.size() <= kFewPlanes && at < kBrickSide; ++at)
            for (uint64_t left = voxels[size_t(at)]; left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                const auto centre = [](int cell) { return int32_t(cell * kUnit + kUnit / 2); };
                const Vertex middle{centre(x + column_x(bit)), centre(y + column_y(bit)), centre(z + at)};
                int passing = 0;
                bool is_on = false;
                for (const Plane& plane : planes) {
                    const int128 height = plane.height(middle);
                    is_on = is_on || height == 0;
                    passing += (height < 0 ? -height : height) < plane.reach;
                }
                found[size_t(at)] |= uint64_t{is_on && passing == 1} << bit;
            }
        return found;
    }

    /// Calls take(triangle) with those in column (x, y) of the grid.
    template <class Take> void for_each_at(int x, int y, Take take) {
        if (starts_.empty())
            index();
        const auto column = size_t((y - y_) * kTileSide + x - x_);
        for (uint32_t i = starts_[column]; i < starts_[column + 1]; ++i) {
            take(triangles_[listed_[i]]);
        }
    }

    /// Calls take(triangle) with those in column (x, y) of the grid whose bounds may hold a point: u and v along x and
    /// y.
    template <class Take> void for_each_around(int x, int y, double u, double v, Take take) {
        if (starts_.empty())
            index();
        constexpr uint32_t kFew = 32;
        const auto column = size_t((y - y_) * kTileSide + x - x_);
        if (starts_[column + 1] - starts_[column] <= kFew)
            return for_each_at(x, y, take);
        const Squares& squares = squares_in(column);
        const size_t at = squares.at(u - double(x * kUnit), v - double(y * kUnit));
        for (uint32_t i = squares.starts[at]; i < squares.starts[at + 1]; ++i)
            take(triangles_[squares.listed[i]]);
    }

    /// Those of a part in column (x, y) of the grid.
    void find(uint32_t part, int x, int y, std::vector<SolidTriangle>& found) {
        found.clear();
        for_each_at(x, y, [&](const Listed& one) {
            if (one.part == part)
                found.push_back(one.triangle);
        });
    }

private:
    /// A plane through a triangle. It passes a voxel's interior if the centre is nearer to it than `reach`.
    struct Plane {
        explicit Plane(const SolidTriangle& t) : at(t) {
            const int64_t u[3] = {int64_t{t[1].x} - t[0].x, int64_t{t[1].y} - t[0].y, int64_t{t[1].z} - t[0].z};
            const int64_t v[3] = {int64_t{t[2].x} - t[0].x, int64_t{t[2].y} - t[0].y, int64_t{t[2].z} - t[0].z};
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                const int128 n = int128(u[j]) * v[k] - int128(u[k]) * v[j];
                reach += (n < 0 ? -n : n) * (kUnit / 2);
            }
        }
        int128 height(const Vertex& v) const { return volume6_of(at[0], at[1], at[2], v); }
        bool holds(const SolidTriangle& t) const { return height(t[0]) == 0 && height(t[1]) == 0 && height(t[2]) == 0; }

        SolidTriangle at;
        int128 reach = 0;
    };

    static std::pair<int64_t, int64_t> span_of(const SolidTriangle& t, int axis) {
        const auto at = [axis](const Vertex& v) { return int64_t{axis == 0 ? v.x : axis == 1 ? v.y : v.z}; };
        return {std::min({at(t[0]), at(t[1]), at(t[2])}), std::max({at(t[0]), at(t[1]), at(t[2])})};
    }

    /// Calls take(column) with the columns that are asked for and that a triangle reaches; on a plane, both sides.
    template <class Take> void for_each_column(const Listed& t, Take take) const {
        const auto cells = [&t](size_t axis, int first) {
            return std::pair{std::max(voxel_below(t.low[axis]) - first, 0),
                             std::min(voxel_floor(t.high[axis]) - first, kTileSide - 1)};
        };
        const auto [u0, u1] = cells(0, x_);
        const auto [v0, v1] = cells(1, y_);
        for (auto at = std::lower_bound(wanted_.begin(), wanted_.end(), uint32_t(v0 * kTileSide + u0));
             at != wanted_.end() && *at <= uint32_t(v1 * kTileSide + u1); ++at)
            if (const int u = int(*at) % kTileSide; u >= u0 && u <= u1)
                take(size_t(*at));
    }

    /// The triangles of a column by squares of it: those around a point are found without a look at all.
    struct Squares {
        int per_side = 0; // a power of two
        std::vector<uint32_t> starts, listed;

        /// The square that holds a point, from the column's lowest corner.
        size_t at(double u, double v) const { return size_t(row(v) * per_side + row(u)); }
        int row(double along) const { return std::clamp(int(std::floor(along * per_side / kUnit)), 0, per_side - 1); }
    };

    const Squares& squares_in(size_t column) {
        constexpr size_t kMostPerTriangle = 8; // squares
        if (squares_.empty())
            squares_.resize(size_t{kTileSide * kTileSide});
        Squares& squares = squares_[column];
        if (squares.per_side != 0)
            return squares;
        const std::span own(listed_.data() + starts_[column], listed_.data() + starts_[column + 1]);
        const int64_t corner[2] = {(x_ + int64_t(column) % kTileSide) * kUnit,
                                   (y_ + int64_t(column) / kTileSide) * kUnit};
        const auto for_each_square = [&](auto take) {
            for (const uint32_t number : own) {
                const Listed& t = triangles_[number];
                const auto row = [&](size_t axis, int64_t at) { return squares.row(double(at - corner[axis])); };
                for (int v = row(1, t.low[1]); v <= row(1, t.high[1]); ++v)
                    for (int u = row(0, t.low[0]); u <= row(0, t.high[0]); ++u)
                        take(size_t(v * squares.per_side + u), number);
            }
        };
        for (squares.per_side = 64; squares.per_side > 1; squares.per_side /= 2) {
            size_t count = size_t(squares.per_side) * size_t(squares.per_side);
            if (count > own.size())
                continue;
            for_each_square([&](size_t, uint32_t) { ++count; });
            if (count <= kMostPerTriangle * own.size())
                break;
        }
        squares.starts.assign(size_t(squares.per_side) * size_t(squares.per_side) + 1, 0);
        for_each_square([&](size_t at, uint32_t) { ++squares.starts[at + 1]; });
        std::partial_sum(squares.starts.begin(), squares.starts.end(), squares.starts.begin());
        squares.listed.resize(squares.starts.back());
        std::vector<uint32_t> next = squares.starts;
        for_each_square([&](size_t at, uint32_t number) { squares.listed[next[at]++] = number; });
        return squares;
    }

    void index() {
        starts_.assign(size_t{kTileSide * kTileSide} + 1, 0);
        for (const Listed& one : triangles_)
            for_each_column(one, [this](size_t column) { ++starts_[column + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        listed_.resize(starts_.back());
        std::vector<uint32_t> next = starts_;
        for (uint32_t i = 0; i < triangles_.size(); ++i)
            for_each_column(triangles_[i], [&](size_t column) { listed_[next[column]++] = i; });
    }

    std::vector<uint32_t> wanted_; // columns
    int x_, y_;
    std::vector<Listed> triangles_;
    std::vector<uint32_t> starts_, listed_; // by column: where its triangles' numbers start
    std::vector<Squares> squares_;          // by column, made where they are asked for
};

} // namespace voxrt::voxelize
