// How well some triangles enclose space: their generalized winding number on a lattice of 8x8x8 points over their box.
//
// With its caps a surface closes, and its winding number is a sum of crossings along the vertical lines of the lattice.
// Less what the caps add (cap_winding.h), it is the generalized winding number. Cost: the triangles, and 512 sums over
// the caps.
#pragma once

#include "../work/interrupt.h"
#include "cap_winding.h"
#include "near_caps.h"

#include <algorithm>
#include <cmath>

namespace voxrt::voxelize {

class EnclosureProbe {
public:
    /// For a lattice over the box low … high.
    EnclosureProbe(const Point& low, const Point& high)
        : low_(low), step_{(high.x - low.x) / kSide, (high.y - low.y) / kSide, (high.z - low.z) / kSide} {}

    /// Adds a triangle of the closed surface: of the mesh or a cap.
    void add(const Point& a, const Point& b, const Point& c) {
        const auto [x0, x1] = lines(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), low_.x, step_.x);
        const auto [y0, y1] = lines(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), low_.y, step_.y);
        for (int j = y0; j <= y1; ++j)
            for (int i = x0; i <= x1; ++i) {
                count_work(1);
                cross(a, b, c, i, j);
            }
    }

    struct Enclosure {
        double mean = 0, highest = 0; // of the absolute winding number where it exceeds 1/2
    };

    /// `caps`: those that were added.
    Enclosure measure(const CapWinding& caps) const {
        constexpr double kTolerance = 1e-3;
        const std::vector<double> angles = angles_of(caps, kTolerance);
        Enclosure found;
        int inside = 0;
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                int number = 0;
                for (int k = 0; k < kSide; ++k) {
                    number += changes_[j][i][k];
                    const double enclosed = std::min(1.0, std::abs(number - angles[(j * kSide + i) * kSide + k]));
                    if (enclosed < 0.5 + kTolerance)
                        continue;
                    found.mean += enclosed;
                    found.highest = std::max(found.highest, enclosed);
                    ++inside;
                }
            }
        found.mean = inside > 0 ? found.mean / inside : 0;
        return found;
    }

private:
    static constexpr int kSide = 8;
    static constexpr double kOffset = 0.41421356; // in a cell of the lattice: on no plane of symmetry

    static constexpr size_t kManyCaps = 1 << 15; // to be summed one by one

    /// The solid angle of the caps over 4 pi at each point of the lattice.
    std::vector<double> angles_of(const CapWinding& caps, double tolerance) const {
        std::vector<double> angles(kSide * kSide * kSide);
        const auto point = [this](size_t n) {
            return at(int(n / kSide % kSide), int(n / kSide / kSide), int(n % kSide));
        };
        if (caps.count() > kManyCaps) {
            for (size_t n = 0; n < angles.size(); ++n)
                angles[n] = caps.at(point(n), tolerance);
            return angles;
        }
        NearCaps near;
        near.gather(caps, caps.all(), at(kSide / 2, kSide / 2, kSide / 2), 0, 0, NearCaps::kAll);
        for (size_t n = 0; n < angles.size(); n += NearCaps::kBatch) {
            NearCaps::Batch batch;
            for (size_t i = 0; i < NearCaps::kBatch; ++i)
                batch.add(point(n + i));
            near.find_angles(batch);
            for (size_t i = 0; i < NearCaps::kBatch; ++i)
                angles[n + i] = batch.doubtful[i] ? caps.at(point(n + i), tolerance) : batch.angle[i];
        }
        return angles;
    }

    struct Lines {
        int first, last;
    };
    static Lines lines(double from, double to, double low, double step) {
        if (!(step > 0))
            return {0, -1};
        return {std::max(0, place(std::floor((from - low) / step - kOffset))),
                std::min(kSide - 1, place(std::ceil((to - low) / step - kOffset)))};
    }
    /// A place in the lattice, or one beside it: coordinates may be beyond all integers.
    static int place(double at) { return at > -1 ? int(std::min(at, double(kSide))) : -1; }
    Point at(int i, int j, int k) const {
        return {low_.x + (i + kOffset) * step_.x, low_.y + (j + kOffset) * step_.y, low_.z + (k + kOffset) * step_.z};
    }

    /// Marks where line (i, j) crosses a triangle: it enters the solid against the normal.
    void cross(const Point& a, const Point& b, const Point& c, int i, int j) {
        const Point q = at(i, j, 0);
        auto orientation = [&q](const Point& u, const Point& v) {
            // The same for an edge and its reverse, but for the sign.
            const bool swap = std::pair(v.x, v.y) < std::pair(u.x, u.y);
            const Point &s = swap ? v : u, &e = swap ? u : v;
            const double t = (e.x - s.x) * (q.y - s.y) - (e.y - s.y) * (q.x - s.x);
            return swap ? -t : t;
        };
        const double u = orientation(b, c), v = orientation(c, a), w = orientation(a, b), sum = u + v + w;
        if (sum == 0 || !((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)))
            return;
        if (!(step_.z > 0))
            return;
        const double z = (u * a.z + v * b.z + w * c.z) / sum;
        const int first = place(std::floor((z - low_.z) / step_.z - kOffset)) + 1;
        if (first < kSide)
            changes_[j][i][first] += sum > 0 ? -1 : 1;
    }

    Point low_, step_;
    int changes_[kSide][kSide][kSide] = {};
};

} // namespace voxrt::voxelize
