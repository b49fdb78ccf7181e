// What the holes of a surface take from its winding number.
//
// Covered by caps, an open surface closes and its winding number is an integer that the column sweep knows exactly. The
// generalized winding number of the open surface (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside
// Segmentation using Generalized Winding Numbers", 2013) is that integer less the solid angle of the caps over 4 pi.
// So its evaluation costs the holes and not the surface. Far caps are taken together as dipoles (Barill, Dickson,
// Schmidt, Levin and Jacobson, "Fast Winding Numbers for Soups and Clouds", 2018).
#pragma once

#include "fixed_point.h"

#include <array>
#include <vector>

namespace voxrt {

struct Point {
    double x, y, z;
    bool operator==(const Point&) const = default;
};

/// The edges of holes. How fast the solid angle of a surface changes depends on its rim alone, like the field of a
/// current in a wire (Biot and Savart): by at most length / distance^2 for each piece.
class HoleRim {
public:
    struct Piece {
        Point middle;
        double length; // times multiplicity
        double radius;
    };

    HoleRim() = default;
    explicit HoleRim(std::vector<Piece> pieces);

    /// Bounds the change of the solid angle a length, within `reach` of q; infinite where the rim is as near.
    double steepness(const Point& q, double reach) const;

private:
    struct Node {
        Point middle{};
        double length = 0, radius = 0;
        int32_t left = -1, right = -1;
    };
    int32_t build(uint32_t first, uint32_t last);

    std::vector<Piece> pieces_;
    std::vector<Node> nodes_;
};

/// Triangles with multiplicity, as a tree of dipoles.
class HoleWinding {
public:
    struct Cap {
        std::array<Point, 3> corners;
        int times;
    };

    HoleWinding() = default;
    /// Caps with edges above `longest_edge` are cut. The first edge of each is on the rim of its hole.
    HoleWinding(std::vector<Cap> caps, double longest_edge);

    bool empty() const { return caps_.empty(); }

    /// The caps' solid angle over 4 pi, seen from q.
    double at(const Point& q) const;

    /// The integer k such that at() lies strictly between k - 1/2 and k + 1/2 within `reach` of q, or kUnsettled.
    int settled(const Point& q, double reach) const;

    static constexpr int kUnsettled = 1 << 20;

private:
    struct Node {
        Point centre{};
        double nx = 0, ny = 0, nz = 0; // sum of area vectors times multiplicity
        double area = 0, radius = 0;
        uint32_t first = 0, last = 0; // caps
        int32_t left = -1, right = -1;
    };
    int32_t build(uint32_t first, uint32_t last);
    bool near_cap(const Point& q, double reach) const;

    std::vector<Cap> caps_;
    std::vector<Node> nodes_;
    HoleRim rim_;
};

} // namespace voxrt
