#include "exact_volume.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace voxrt::voxelize {
namespace {

constexpr int kTries = 1000; // rays: the first one that meets no edge is taken

/// A point with a common denominator: (x, y, z) / w, w > 0, in 1/4096 voxel from the corner of the voxel.
template <class Number> struct Point {
    std::array<Number, 3> at;
    Number w;
};
using ExactPoint = Point<BigInteger>;
using Polygon = std::vector<ExactPoint>;

/// n . p + d: above 0 on the side that the normal points to.
struct Plane {
    std::array<BigInteger, 3> normal;
    BigInteger offset;

    BigInteger height(const ExactPoint& p) const {
        BigInteger sum = offset * p.w;
        for (size_t i = 0; i < 3; ++i)
            sum = sum + normal[i] * p.at[i];
        return sum;
    }
};

Plane axis_plane(size_t axis, int64_t at) {
    Plane plane{{0, 0, 0}, -at};
    plane.normal[axis] = 1;
    return plane;
}

/// What of a convex polygon lies on one side of a plane, `sign` 1 or -1 (Sutherland and Hodgman 1974).
Polygon clip(const Polygon& polygon, const Plane& plane, int sign) {
    std::vector<BigInteger> heights;
    bool all = true;
    for (const ExactPoint& p : polygon) {
        heights.push_back(sign > 0 ? plane.height(p) : -plane.height(p));
        all = all && heights.back().sign() >= 0;
    }
    if (all)
        return polygon;
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const size_t j = i + 1 == polygon.size() ? 0 : i + 1;
        const int here = heights[i].sign(), next = heights[j].sign();
        if (here >= 0)
            kept.push_back(polygon[i]);
        if (here * next >= 0)
            continue;
        const BigInteger a = here > 0 ? heights[i] : -heights[i], b = next > 0 ? heights[j] : -heights[j];
        const ExactPoint &p = polygon[i], &q = polygon[j];
        ExactPoint& met = kept.emplace_back();
        for (size_t axis = 0; axis < 3; ++axis)
            met.at[axis] = b * p.at[axis] + a * q.at[axis];
        met.w = b * p.w + a * q.w;
    }
    return kept;
}

/// Twice the area of a triangle, seen along z, times the denominators of its corners.
BigInteger area2(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
    return a.at[0] * (b.at[1] * c.w - b.w * c.at[1]) - a.at[1] * (b.at[0] * c.w - b.w * c.at[0]) +
           a.w * (b.at[0] * c.at[1] - b.at[1] * c.at[0]);
}

/// A triangle relative to the voxel's corner.
struct Face {
    std::array<std::array<int64_t, 3>, 3> at;
    std::array<int128, 3> normal{};
    std::array<int64_t, 3> low, high;

    Face(const SolidTriangle& t, const std::array<int64_t, 3>& corner) {
        for (size_t i = 0; i < 3; ++i)
            at[i] = {t[i].x - corner[0], t[i].y - corner[1], t[i].z - corner[2]};
        for (size_t i = 0; i < 3; ++i) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            normal[i] = int128(at[1][j] - at[0][j]) * (at[2][k] - at[0][k]) -
                        int128(at[1][k] - at[0][k]) * (at[2][j] - at[0][j]);
            low[i] = std::min({at[0][i], at[1][i], at[2][i]});
            high[i] = std::max({at[0][i], at[1][i], at[2][i]});
        }
    }

    /// On which side of the face a point lies, times the length of the normal.
    int128 height(const std::array<int64_t, 3>& p) const {
        return normal[0] * (p[0] - at[0][0]) + normal[1] * (p[1] - at[0][1]) + normal[2] * (p[2] - at[0][2]);
    }
    Plane plane() const { return {{normal[0], normal[1], normal[2]}, height({0, 0, 0})}; }
    Polygon polygon() const {
        Polygon found;
        for (const auto& p : at)
            found.push_back({{p[0], p[1], p[2]}, 1});
        return found;
    }
    int upwards() const { return normal[2] > 0 ? 1 : normal[2] < 0 ? -1 : 0; }
};

int sign(const BigInteger& v) { return v.sign(); }
int sign(int128 v) { return v < 0 ? -1 : v > 0; }

/// What the ray downwards from a point meets of a face.
enum class Meeting { none, below, level, edge };

template <class Number> Meeting meeting(const Face& face, const Point<Number>& p) {
    int least = 1, most = -1;
    for (size_t i = 0; i < 3; ++i) {
        const auto &a = face.at[i], &b = face.at[(i + 1) % 3];
        const int side = sign(Number(b[0] - a[0]) * (p.at[1] - Number(a[1]) * p.w) -
                              Number(b[1] - a[1]) * (p.at[0] - Number(a[0]) * p.w));
        least = std::min(least, side);
        most = std::max(most, side);
    }
    if (least < 0 && most > 0)
        return Meeting::none;
    if (least == 0 || most == 0)
        return Meeting::edge;
    Number height = 0;
    for (size_t i = 0; i < 3; ++i)
        height = height + Number(face.normal[i]) * (p.at[i] - Number(face.at[0][i]) * p.w);
    const int above = sign(height) * face.upwards();
    return above > 0 ? Meeting::below : above == 0 ? Meeting::level : Meeting::none;
}

class VoxelSolid {
public:
    VoxelSolid(std::span<const SolidTriangle> column, int x, int y, int z) {
        faces_.reserve(column.size());
        for (const SolidTriangle& t : column)
            faces_.emplace_back(t, std::array<int64_t, 3>{x * kUnit, y * kUnit, z * kUnit});
    }

    /// Adds the volume where no more than planes across one axis, or one plane through the centre, part the voxel.
    /// Every such plane parts all of it: the surface closes, so no edge in the voxel is the end of one.
    bool add_simple(ExactSum& sum) const {
        const Face* first = nullptr;
        int axis = -1;
        bool across = true, in_one_plane = true;
        std::vector<int64_t> levels{0};
        for (const Face& face : faces_) {
            if (!may_meet(face))
                continue;
            int only = -1, count = 0;
            for (int i = 0; i < 3; ++i)
                if (face.normal[size_t(i)] != 0) {
                    only = i;
                    ++count;
                }
            axis = first == nullptr ? only : axis;
            across = across && count == 1 && only == axis;
            first = first == nullptr ? &face : first;
            for (const auto& p : face.at)
                in_one_plane = in_one_plane && first->height(p) == 0;
            if (across)
                levels.push_back(face.at[0][size_t(axis)]);
        }
        constexpr std::array<int64_t, 3> middle{kUnit / 2, kUnit / 2, kUnit / 2};
        if (across) {
            levels.push_back(kUnit);
            std::sort(levels.begin(), levels.end());
            int64_t filled = 0;
            for (size_t i = 1; i < levels.size(); ++i)
                if (levels[i - 1] < levels[i] && is_inside([&](int k) {
                        Point<int128> p = beside_middle(k);
                        if (axis >= 0)
                            p.at[size_t(axis)] = 2 * (levels[i - 1] + k % (levels[i] - levels[i - 1])) + 1;
                        return p;
                    }))
                    filled += levels[i] - levels[i - 1];
            sum.add(filled, kUnit);
            return true;
        }
        if (!in_one_plane || first->height(middle) != 0)
            return false;
        int sides = 0;
        for (const int side : {1, -1})
            sides += is_inside([&](int k) {
                Point<int128> p = beside_middle(k);
                for (size_t i = 0; i < 3; ++i)
                    if (const int away = side * sign(first->normal[i]); away != 0)
                        p.at[i] = kUnit + away * (kUnit - 1 - 2 * (k * int(i + 1) % 499));
                return p;
            });
        sum.add(sides, 2);
        return true;
    }

    /// Adds the volume by cutting the surface: what lies below the top of the voxel and above each piece counts, with
    /// the sign of what changes there from outside to inside, or back.
    void add_pieces(ExactSum& sum) const {
        // No face crosses the height `floor`, so the column is inside or outside there as a whole.
        int64_t floor = 0;
        for (bool lower = true; lower;) {
            lower = false;
            for (const Face& face : faces_)
                if (face.low[2] < floor && face.high[2] >= floor) {
                    floor = face.low[2];
                    lower = true;
                }
        }
        std::vector<const Face*> near;
        for (const Face& face : faces_)
            if (face.high[2] >= floor && face.low[2] < kUnit)
                near.push_back(&face);
        if (is_inside([&](int k) {
                Point<int128> p = beside_middle(k);
                p.at[2] = 2 * floor - 1;
                return p;
            }))
            sum.add(1, 1);
        for (const Face* face : near) {
            if (face->upwards() == 0)
                continue;
            Polygon whole = face->polygon();
            for (const size_t axis : {size_t{0}, size_t{1}})
                whole = clip(clip(whole, axis_plane(axis, 0), 1), axis_plane(axis, kUnit), -1);
            whole = clip(whole, axis_plane(2, kUnit), -1);
            for (const Polygon& part : parts_of(*face, whole, near)) {
                const int weight = change_at(*face, part);
                if (weight == 0)
                    continue;
                add_below(clip(part, axis_plane(2, 0), -1), weight, true, sum);
                add_below(clip(part, axis_plane(2, 0), 1), weight, false, sum);
            }
        }
    }

private:
    /// Points beside the centre whose x and y are between those of the lattice. No line passes three of them.
    static Point<int128> beside_middle(int k) {
        return {{kUnit + 1 + 2 * k, kUnit + 1 + 2 * (k * k % 1021), kUnit}, 2};
    }

    /// Whether the plane of a face that is near passes the open voxel.
    static bool may_meet(const Face& face) {
        int128 reach = 0;
        for (size_t i = 0; i < 3; ++i) {
            if (face.low[i] >= kUnit || face.high[i] <= 0)
                return false;
            reach += face.normal[i] < 0 ? -face.normal[i] : face.normal[i];
        }
        const int128 height = face.height({kUnit / 2, kUnit / 2, kUnit / 2});
        return (height < 0 ? -height : height) < reach * (kUnit / 2);
    }

    /// How often the surface winds about a point; nothing where its ray meets an edge. `own`: a face that the point is
    /// on; the others at its height count as below where they come later.
    template <class Number> std::optional<int> winding(const Point<Number>& p, const Face* own = nullptr) const {
        int sum = 0;
        for (const Face& face : faces_) {
            const Meeting met = &face == own ? Meeting::none : meeting(face, p);
            if (met == Meeting::edge)
                return std::nullopt;
            if (met == Meeting::below || (met == Meeting::level && &face > own))
                sum += face.upwards();
        }
        return sum;
    }

    /// Whether the first of some points whose ray meets no edge is inside. They must be on one side of the surface.
    template <class PointOf> bool is_inside(PointOf point) const {
        for (int k = 0; k < kTries; ++k)
            if (const std::optional<int> number = winding(point(k)))
                return *number != 0;
        return false;
    }

    /// The parts of a polygon of a face that no other face cuts.
    static std::vector<Polygon> parts_of(const Face& face, Polygon whole, const std::vector<const Face*>& near) {
        std::vector<Polygon> parts{std::move(whole)};
        auto cut = [&](const Plane& plane) {
            std::vector<Polygon> found;
            for (const Polygon& part : parts)
                for (const int side : {1, -1})
                    if (Polygon half = clip(part, plane, side); has_area(half))
                        found.push_back(std::move(half));
            parts = std::move(found);
        };
        for (const Face* other : near) {
            bool apart = other == &face || other->normal == std::array<int128, 3>{};
            for (size_t i = 0; i < 3; ++i)
                apart = apart || other->low[i] > face.high[i] || other->high[i] < face.low[i];
            if (apart)
                continue;
            const auto span = [](const Face& f, const Face& of) {
                int least = 1, most = -1;
                for (const auto& p : of.at) {
                    least = std::min(least, sign(f.height(p)));
                    most = std::max(most, sign(f.height(p)));
                }
                return std::pair{least, most};
            };
            const auto [least, most] = span(*other, face);
            if (least == 0 && most == 0) {
                for (size_t i = 0; i < 3; ++i) { // in one plane: along the other's edges, upright
                    const auto &a = other->at[i], &b = other->at[(i + 1) % 3];
                    const int64_t nx = a[1] - b[1], ny = b[0] - a[0];
                    cut({{nx, ny, 0}, -(int128(nx) * a[0] + int128(ny) * a[1])});
                }
            } else if (least < 0 && most > 0) {
                const auto [low, high] = span(face, *other);
                if (low <= 0 && high >= 0)
                    cut(other->plane());
            }
        }
        std::erase_if(parts, [](const Polygon& part) { return !has_area(part); });
        return parts;
    }

    /// The first corner of a triangle with area that a fan about corner 0 has; 0 where there is none.
    static size_t fan_corner(const Polygon& polygon) {
        for (size_t i = 2; i < polygon.size(); ++i)
            if (area2(polygon[0], polygon[i - 1], polygon[i]).sign() != 0)
                return i;
        return 0;
    }
    static bool has_area(const Polygon& polygon) { return fan_corner(polygon) != 0; }

    /// What changes at a part of a face, upwards: 1 from outside to inside, -1 from inside to outside, or 0.
    int change_at(const Face& face, const Polygon& part) const {
        const size_t i = fan_corner(part);
        const ExactPoint* corners[3] = {&part[0], &part[i - 1], &part[i]};
        for (int k = 0; k < kTries; ++k) {
            ExactPoint p{{0, 0, 0}, 0};
            for (int c = 0; c < 3; ++c) {
                const BigInteger weight =
                    BigInteger(1 + k * (c + 1) % 97) * corners[(c + 1) % 3]->w * corners[(c + 2) % 3]->w;
                for (size_t axis = 0; axis < 3; ++axis)
                    p.at[axis] = p.at[axis] + weight * corners[c]->at[axis];
                p.w = p.w + weight * corners[c]->w;
            }
            if (const std::optional<int> below = winding(p, &face))
                return int(*below + face.upwards() != 0) - int(*below != 0);
        }
        return 0;
    }

    /// Adds what lies above a polygon in the voxel, `sign` 1 or -1. `whole`: the polygon lies below the voxel.
    static void add_below(const Polygon& polygon, int weight, bool whole, ExactSum& sum) {
        for (size_t i = 2; i < polygon.size(); ++i) {
            const ExactPoint &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
            BigInteger area = area2(a, b, c);
            if (area.sign() == 0)
                continue;
            if ((area.sign() < 0) == (weight > 0))
                area = -area;
            const BigInteger scale = a.w * b.w * c.w;
            if (whole) {
                sum.add(area, scale * BigInteger(2 * kUnit * kUnit));
                continue;
            }
            const BigInteger heights = a.at[2] * b.w * c.w + b.at[2] * a.w * c.w + c.at[2] * a.w * b.w;
            sum.add(area * (BigInteger(3 * kUnit) * scale - heights),
                    scale * scale * BigInteger(6 * kUnit * kUnit * kUnit));
        }
    }

    std::vector<Face> faces_;
};

} // namespace

void add_exact_volume(std::span<const SolidTriangle> column, int x, int y, int z, ExactSum& sum) {
    const VoxelSolid solid(column, x, y, z);
    if (!solid.add_simple(sum))
        solid.add_pieces(sum);
}

} // namespace voxrt::voxelize
