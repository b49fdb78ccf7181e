// The caps of holes as seen from the voxels of a brick: those near it one by one, the others as one expansion.
//
// Near caps that share an edge are one surface, and that edge adds nothing to the gradient of their solid angle: it
// depends on the boundary alone, like the magnetic field of a current in a wire (law of Biot and Savart). So the angle
// is smooth wherever no boundary is near, also where caps pass, but for a whole number beyond each cap.
//
// Angles of many points are found together: a square root per point and vertex, some 20 operations per point and cap.
// That is a tenth of the time that one point after another takes.
#pragma once

#include "cap_winding.h"

#include <cmath>
#include <vector>

namespace voxrt::voxelize {

class NearCaps {
public:
    static constexpr size_t kAll = ~size_t{0};

    /// Gathers the caps for points in the ball of `radius` about `centre`, which lies in that of `outer`. Nodes of caps
    /// are taken as far where each has an error of at most `far_error`. Gives up, and returns false, where more than
    /// `most` caps are near.
    bool gather(const CapWinding& caps, const CapWinding::Seen& outer, const Point& centre, double radius,
                double far_error, size_t most);

    size_t count() const { return caps_.size(); }
    /// Largest error of an angle.
    double error_bound() const { return seen_.far.error_bound; }

    static constexpr int kBatch = 16;

    /// Some points in the ball, and what was found for them.
    struct Batch {
        int count = 0;
        double x[kBatch], y[kBatch], z[kBatch]; // the points
        double angle[kBatch];                   // solid angle of all caps over 4 pi
        bool doubtful[kBatch]; // near a cap or its plane's end: the angle may be wrong by a whole number, or by more
        void add(const Point& p) {
            x[count] = p.x;
            y[count] = p.y;
            z[count++] = p.z;
        }
        void clear() { count = 0; }
    };
    void find_angles(Batch& batch);
    /// Finds the angle of one point.
    double find_angle(const Point& point, bool& doubtful);

    /// How the angle changes inside a ball: to second order in the distance from its centre.
    struct Change {
        Point gradient{0, 0, 0};
        double second[6] = {};  // derivatives xx yy zz xy yz zx
        double error_bound = 0; // infinite where a boundary passes the ball
        bool crossed = false;   // caps may pass the ball
        /// By how much the angle at the centre + d exceeds that at the centre.
        double at(const Point& d) const {
            return d.x * (gradient.x + second[0] * d.x / 2 + second[3] * d.y) +
                   d.y * (gradient.y + second[1] * d.y / 2 + second[4] * d.z) +
                   d.z * (gradient.z + second[2] * d.z / 2 + second[5] * d.x);
        }
        /// The most that it may be at a distance of `radius`, but for the error.
        double most(double radius) const {
            const Point& g = gradient;
            const double* h = second;
            const double squares =
                h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + 2 * (h[3] * h[3] + h[4] * h[4] + h[5] * h[5]);
            return radius * std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z) + radius * radius / 2 * std::sqrt(squares);
        }
    };
    /// Gives up where the error exceeds `limit`: it is infinite then.
    Change find_change(const Point& centre, double radius, double limit) const;

    /// What the kernel of find_angles works on: caps, and distances of each vertex from each point.
    struct Cap {
        uint32_t corners[3];
        Point normal;    // twice its area
        double height;   // of its plane above the centre of all, times the length of `normal`
        double sides[3]; // squares of |ab|, |bc|, |ca|
    };

private:
    struct Edge {
        uint32_t from, to;
        double length;
    };
    uint32_t local_vertex(const CapWinding& caps, uint32_t vertex);

    CapWinding::Seen seen_;
    std::vector<Cap> caps_;
    std::vector<Edge> edges_;       // the boundary
    std::vector<Point> vertices_;   // relative to the centre
    std::vector<double> distances_; // by vertex and point
    // By vertex and cap of CapWinding: the gathering that met it last, and as which vertex.
    struct Mark {
        uint32_t gathering = 0, local = 0;
    };
    std::vector<Mark> vertex_marks_;
    std::vector<uint32_t> cap_marks_;
    uint32_t gathering_ = 0;
};

} // namespace voxrt::voxelize
