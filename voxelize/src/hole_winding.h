// What the holes of a surface take from its winding number.
//
// Covered by caps, an open surface closes and its winding number is an integer that the column sweep knows exactly. The
// generalized winding number of the open surface (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside
// Segmentation using Generalized Winding Numbers", 2013) is that integer less the solid angle of the caps over 4 pi.
// So its evaluation costs the holes and not the surface.
//
// Far caps are taken together as dipoles (Barill, Dickson, Schmidt, Levin and Jacobson, "Fast Winding Numbers for Soups
// and Clouds", 2018) with their first moments, and what is found out about a cube is handed down to its parts, which
// look at what was too near for it alone (Greengard and Rokhlin, "A Fast Algorithm for Particle Simulations", 1987).
// Every approximation carries a proven bound of its error. 1 / distance is harmonic, so that its derivative of order n
// is at most n! / distance^(n + 1) in any directions: a dipole of area A whose ends lie within t D of D is off by at
// most A / (4 pi D^2) sum over k >= 2 of (k + 1) t^k.
#pragma once

#include "fixed_point.h"

#include <array>
#include <cstddef>
#include <vector>

namespace voxrt {

struct Point {
    double x, y, z;
    bool operator==(const Point&) const = default;
};

/// The solid angle of some caps over 4 pi about a point: linear, and by how much it may be off.
struct LinearAngle {
    double angle = 0;
    Point gradient{0, 0, 0};
    double error = 0;
};

/// All caps as seen from a ball.
struct HoleView {
    Point centre{0, 0, 0};
    LinearAngle far;
    LinearAngle near;           // of caps that the parts of the ball can see better
    std::vector<uint32_t> open; // nodes of all that is not in `far`
    double doubt = 0;           // the most that caps add which are in neither
    /// Caps pass through the ball. They are taken as seen from the centre: to go on through one keeps the angle, with a
    /// surface that it closes, in step with the winding number at the centre.
    bool crossed = false;
};

/// Triangles as a tree of dipoles.
class HoleWinding {
public:
    using Cap = std::array<Point, 3>; // multiples of 1/4096

    HoleWinding() = default;
    explicit HoleWinding(std::vector<Cap> caps);

    bool empty() const { return caps_.empty(); }

    /// What is known of all caps before looking.
    HoleView start() const;

    /// Looks from a ball within that of `from`. Where reach is 0, all is far and exact but for what was far already,
    /// and `centre` is to be a point where voxels are asked.
    void look(const HoleView& from, const Point& centre, double reach, HoleView& to) const;

    /// The caps' solid angle over 4 pi, within `tolerance`. On a cap the point counts as just below it, where the
    /// column sweep has it.
    double at(const Point& q, double tolerance) const;

private:
    struct Node {
        Point centre{}, dipole{}; // the sum of area vectors
        double moment[6] = {};    // symmetric part of area vector (x) offset from the centre: xx yy zz xy yz zx
        double area = 0, radius = 0;
        uint32_t first = 0, last = 0; // caps
        int32_t left = -1, right = -1;
    };
    int32_t build(uint32_t first, uint32_t last);
    static double dipole_angle(const Node& node, const Point& d, double square);
    static void add_dipole(const Node& node, const Point& d, double square, LinearAngle& sum);

    std::vector<Cap> caps_;
    std::vector<Node> nodes_;
};

} // namespace voxrt
