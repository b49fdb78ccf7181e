// Materials that vary over a triangle: each voxel takes the material of the triangle's point nearest to the voxel's
// centre.
//
// The materials are a raster that lies over the triangle as the raster coordinates of its corners say, like a texture.
// Raster coordinates (u, v) are in cell floor(u) of row floor(v), or in the nearest cell where there is none. Cells of
// material 0 are fully transparent: they bound the inside but leave no shell. The raster does not move the surface.
// Only materials are chosen by floating point here, never coverage.
#pragma once

#include "../scene/parts.h"
#include "tile_surface.h"

#include <algorithm>

namespace voxrt::voxelize {

/// A direction in grid space, 1/4096 voxel.
struct Vector {
    double x, y, z;
    Vector(double x, double y, double z) : x(x), y(y), z(z) {}
    Vector(const Vertex& from, const Vertex& to)
        : x(double(to.x) - from.x), y(double(to.y) - from.y), z(double(to.z) - from.z) {}
    double dot(const Vector& v) const { return x * v.x + y * v.y + z * v.z; }
};

/// A triangle and its raster.
class TriangleRaster {
public:
    TriangleRaster(const Vertex& a, const Vertex& b, const Vertex& c, const MaterialRasters& rasters, size_t triangle)
        : corner_(a), ab_(a, b), ac_(a, c), bb_(ab_.dot(ab_)), bc_(ab_.dot(ac_)), cc_(ac_.dot(ac_)),
          columns_(rasters.sizes[2 * triangle]), rows_(rasters.sizes[2 * triangle + 1]),
          coordinates_(rasters.coordinates.data() + 6 * triangle),
          materials_(rasters.materials.data() + rasters.starts[triangle]) {}

    /// The material nearest to a voxel's centre.
    uint8_t material(int x, int y, int z) const {
        const Vector ap((x + 0.5) * kUnit - corner_.x, (y + 0.5) * kUnit - corner_.y, (z + 0.5) * kUnit - corner_.z);
        const auto [to_b, to_c] = nearest(ab_.dot(ap), ac_.dot(ap));
        auto coordinate = [&](int axis) {
            const double a = coordinates_[axis], b = coordinates_[2 + axis], c = coordinates_[4 + axis];
            return a + to_b * (b - a) + to_c * (c - a);
        };
        return materials_[int64_t{cell(coordinate(1), rows_)} * columns_ + cell(coordinate(0), columns_)];
    }

private:
    /// Barycentric coordinates of a point, that of a left out.
    struct Barycentric {
        double b, c;
    };

    /// The point nearest to p, from (b - a)(p - a) and (c - a)(p - a).
    Barycentric nearest(double pb, double pc) const {
        const double area = bb_ * cc_ - bc_ * bc_;
        if (area > 0) {
            const Barycentric inside{(cc_ * pb - bc_ * pc) / area, (bb_ * pc - bc_ * pb) / area};
            if (inside.b >= 0 && inside.c >= 0 && inside.b + inside.c <= 1)
                return inside;
        }
        // Else it is on an edge: the nearest of three, by the squared distance less that of a.
        const double on_ab = fraction(pb, bb_), on_ac = fraction(pc, cc_);
        const double on_bc = fraction(bb_ - bc_ + pc - pb, bb_ - 2 * bc_ + cc_);
        const Barycentric edges[3] = {{on_ab, 0}, {0, on_ac}, {1 - on_bc, on_bc}};
        auto distance = [&](const Barycentric& s) {
            return s.b * s.b * bb_ + 2 * s.b * s.c * bc_ + s.c * s.c * cc_ - 2 * (s.b * pb + s.c * pc);
        };
        return *std::min_element(edges, edges + 3,
                                 [&](const Barycentric& s, const Barycentric& t) { return distance(s) < distance(t); });
    }

    static double fraction(double along, double length) {
        return length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
    }

    static int cell(double coordinate, int count) {
        return coordinate > 0 ? int(std::min(coordinate, count - 1.0)) : 0;
    }

    Vertex corner_;
    Vector ab_, ac_;
    double bb_, bc_, cc_;
    int columns_, rows_;
    const float* coordinates_;
    const uint8_t* materials_;
};

/// Receiver of cover_triangle (triangle_coverage.h) that gives each voxel of a TileSurface its own material.
class RasterSurface {
public:
    RasterSurface(TileSurface& surface, const TriangleRaster& raster) : surface_(surface), raster_(raster) {}

    int side() const { return surface_.side(); }

    void cover(int x, int y, int lo, int hi) {
        for (int z = lo; z <= hi; ++z) {
            const uint8_t material = raster_.material(x, y, z);
            if (material == 0) {
                surface_.cover_transparent(x, y, z);
            } else {
                surface_.set_material(material);
                surface_.cover(x, y, z, z);
            }
        }
    }

    void cross(int x, int y, int z, bool enters) { surface_.cross(x, y, z, enters); }

private:
    TileSurface& surface_;
    const TriangleRaster& raster_;
};

} // namespace voxrt::voxelize
