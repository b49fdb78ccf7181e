// Materials that vary over a triangle: each voxel takes that of the triangle's point nearest to the voxel's centre.
//
// The materials of a triangle are a raster, which lies over it as its corners' places in the raster say; place (u, v)
// is in cell floor(u) of row floor(v), or in the nearest cell where there is none. Cells of material 0 are cut away.
// The surface does not depend on its raster. Voxels are told apart by floating point, here alone.
#pragma once

#include "object_layer.h"
#include "parts.h"

#include <algorithm>

namespace voxrt {

/// A point or a direction in grid space, 1/4096 voxel.
struct Vector {
    double x, y, z;
    Vector(double x, double y, double z) : x(x), y(y), z(z) {}
    Vector(const Vertex& from, const Vertex& to)
        : x(double(to.x) - from.x), y(double(to.y) - from.y), z(double(to.z) - from.z) {}
    double dot(const Vector& v) const { return x * v.x + y * v.y + z * v.z; }
};

/// A triangle and its raster.
class TintedTriangle {
public:
    TintedTriangle(const Vertex& a, const Vertex& b, const Vertex& c, const Tints& tints, size_t triangle)
        : corner_(a), ab_(a, b), ac_(a, c), bb_(ab_.dot(ab_)), bc_(ab_.dot(ac_)), cc_(ac_.dot(ac_)),
          columns_(tints.sizes[2 * triangle]), rows_(tints.sizes[2 * triangle + 1]),
          places_(tints.corners.data() + 6 * triangle), materials_(tints.materials.data() + tints.starts[triangle]) {}

    /// The material nearest to a voxel's centre.
    uint8_t material(int x, int y, int z) const {
        const Vector ap((x + 0.5) * kUnit - corner_.x, (y + 0.5) * kUnit - corner_.y, (z + 0.5) * kUnit - corner_.z);
        const auto [to_b, to_c] = nearest(ab_.dot(ap), ac_.dot(ap));
        auto place = [&](int axis) {
            const double a = places_[axis], b = places_[2 + axis], c = places_[4 + axis];
            return a + to_b * (b - a) + to_c * (c - a);
        };
        return materials_[int64_t{cell(place(1), rows_)} * columns_ + cell(place(0), columns_)];
    }

private:
    struct Shares {
        double b, c;
    };

    /// The shares of b and c at the point nearest to p, from (b - a)(p - a) and (c - a)(p - a).
    Shares nearest(double pb, double pc) const {
        const double area = bb_ * cc_ - bc_ * bc_;
        if (area > 0) {
            const Shares inside{(cc_ * pb - bc_ * pc) / area, (bb_ * pc - bc_ * pb) / area};
            if (inside.b >= 0 && inside.c >= 0 && inside.b + inside.c <= 1)
                return inside;
        }
        // Else it is on an edge: the nearest of three, by the squared distance less that of a.
        const double on_ab = share(pb, bb_), on_ac = share(pc, cc_);
        const double on_bc = share(bb_ - bc_ + pc - pb, bb_ - 2 * bc_ + cc_);
        const Shares edges[3] = {{on_ab, 0}, {0, on_ac}, {1 - on_bc, on_bc}};
        auto distance = [&](const Shares& s) {
            return s.b * s.b * bb_ + 2 * s.b * s.c * bc_ + s.c * s.c * cc_ - 2 * (s.b * pb + s.c * pc);
        };
        return *std::min_element(edges, edges + 3,
                                 [&](const Shares& s, const Shares& t) { return distance(s) < distance(t); });
    }

    static double share(double along, double length) { return length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0; }

    static int cell(double place, int count) { return place > 0 ? int(std::min(place, count - 1.0)) : 0; }

    Vertex corner_;
    Vector ab_, ac_;
    double bb_, bc_, cc_;
    int columns_, rows_;
    const float* places_;
    const uint8_t* materials_;
};

/// Sink of cover_triangle that gives each voxel its own material.
class TintedLayer {
public:
    TintedLayer(ObjectLayer& layer, const TintedTriangle& triangle) : layer_(layer), triangle_(triangle) {}

    int side() const { return layer_.side(); }

    void cover(int x, int y, int lo, int hi) {
        for (int z = lo; z <= hi; ++z) {
            const uint8_t material = triangle_.material(x, y, z);
            if (material == 0) {
                layer_.cut(x, y, z);
            } else {
                layer_.set_material(material);
                layer_.cover(x, y, z, z);
            }
        }
    }

    void cross(int x, int y, int z, bool enters) { layer_.cross(x, y, z, enters); }

private:
    ObjectLayer& layer_;
    const TintedTriangle& triangle_;
};

} // namespace voxrt
