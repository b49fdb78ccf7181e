// What the caps of holes add to a surface's winding number.
//
// Closed by caps, a surface with holes has an integer winding number, which the column sweep knows exactly. The
// generalized winding number of the surface itself (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside
// Segmentation using Generalized Winding Numbers", 2013) is that integer less the solid angle of the caps over 4 pi. So
// its cost grows with the holes and not with the surface.
//
// Far caps are taken together as dipoles with their first moments (Barill, Dickson, Schmidt, Levin and Jacobson, "Fast
// Winding Numbers for Soups and Clouds", 2018); near ones are summed (near_caps.h). Every approximation carries a
// proven error bound: 1 / distance is harmonic, so that its derivative of order n is at most n! / distance^(n + 1) in
// any directions. A dipole of area A whose ends lie within t D of D has an error of at most A / (4 pi D^2) times the
// sum over k >= 2 of (k + 1) t^k.
#pragma once

#include "../grid/fixed_point.h"

#include <array>
#include <cstddef>
#include <vector>

namespace voxrt::voxelize {

struct Point {
    double x, y, z;
    bool operator==(const Point&) const = default;
};

/// The solid angle of some caps over 4 pi near a point, to first order.
struct LinearExpansion {
    double angle = 0;
    Point gradient{0, 0, 0};
    double error_bound = 0;
};

/// Caps in a tree of dipoles. Building takes n log n.
class CapWinding {
public:
    using Cap = std::array<Point, 3>; // in voxels, multiples of 1/4096

    CapWinding() = default;
    explicit CapWinding(std::vector<Cap> caps);

    bool empty() const { return caps_.empty(); }

    /// Caps as points in a ball see them: far ones as one expansion about its centre; nodes of the tree hold the
    /// others.
    struct Seen {
        Point centre{};
        LinearExpansion far;
        std::vector<uint32_t> near;
    };
    /// All caps near.
    Seen all() const { return {{}, {}, {0}}; }
    /// What a ball sees that lies in the ball of `outer`. Nodes whose error is at most `far_error` each are far; others
    /// are opened, down to caps or below a radius of `smallest`. Gives up, and returns false, where more than `most`
    /// are near.
    bool split(const Seen& outer, const Point& centre, double radius, double far_error, double smallest, size_t most,
               Seen& seen) const;
    /// The cap of a node that has one.
    uint32_t cap_of(uint32_t node) const { return nodes_[node].first; }

    static constexpr uint32_t kNoCap = 0xFFFF'FFFF;
    size_t count() const { return caps_.size(); }
    size_t vertex_count() const { return vertices_.size(); }
    const Point& vertex(uint32_t number) const { return vertices_[number]; }
    /// Corner i of a cap: the number of its vertex. Vertices at one position are one.
    uint32_t corner(uint32_t cap, int i) const { return corners_[3 * size_t{cap} + i]; }
    /// The cap that has the edge from corner i to the next the other way round, or kNoCap.
    uint32_t across(uint32_t cap, int i) const { return across_[3 * size_t{cap} + i]; }
    /// The solid angle over 4 pi at q, with an error of at most `tolerance`. On a cap, q counts as just below it, as in
    /// the column sweep.
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
    void find_vertices();
    void pair_edges();
    /// From a point to the centre of a node. `inverse_square` is over 4 pi.
    struct Offset {
        double inverse_square, inverse;
        Point direction;
        Offset(const Point& d, double square);
    };
    static double dipole_angle(const Node& node, const Offset& from);
    static void add_dipole(const Node& node, const Offset& from, LinearExpansion& sum);

    std::vector<Cap> caps_;
    std::vector<Node> nodes_;
    std::vector<Point> vertices_;
    std::vector<uint32_t> corners_; // 3 per cap
    std::vector<uint32_t> across_;  // 3 per cap
};

} // namespace voxrt::voxelize
