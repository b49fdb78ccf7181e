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

/// The edges of holes. How the solid angle of a surface changes depends on its rim alone, like the field of a current
/// in a wire (Biot and Savart).
class HoleRim {
public:
    struct Piece {
        Point from, to;
        int times;
    };
    /// Within some reach of a point the solid angle over 4 pi differs from a linear one by `error` at most.
    struct Slope {
        Point gradient{0, 0, 0};
        double error = 0;
    };

    HoleRim() = default;
    explicit HoleRim(std::vector<Piece> pieces);

    /// The error is infinite where the rim is within `reach` of q.
    Slope slope(const Point& q, double reach) const;

private:
    struct Node {
        Point middle{}, along{}; // the sum of pieces as vectors
        double length = 0, radius = 0;
        uint32_t piece = 0; // of a leaf
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
    /// The first edge of each cap is on the rim of its hole.
    explicit HoleWinding(std::vector<Cap> caps);

    bool empty() const { return caps_.empty(); }

    /// The caps' solid angle over 4 pi, seen from q, by the sum of all caps or with far ones taken together.
    double exactly_at(const Point& q) const;
    double at(const Point& q) const;
    static constexpr double kRoundingError = 1e-6, kDipoleError = 0.01;

    /// How the same changes within `reach` of q, where no cap lies between; across one it jumps by a whole number.
    HoleRim::Slope slope(const Point& q, double reach) const { return rim_.slope(q, reach); }

private:
    struct Node {
        Point centre{};
        double nx = 0, ny = 0, nz = 0; // sum of area vectors times multiplicity
        double area = 0, radius = 0;
        uint32_t first = 0, last = 0; // caps
        int32_t left = -1, right = -1;
    };
    int32_t build(uint32_t first, uint32_t last);

    std::vector<Cap> caps_;
    std::vector<Node> nodes_;
    HoleRim rim_;
};

} // namespace voxrt
