// Signs of determinants of vertices, exact: products of three differences of 2^31 fit 128 bits.
#pragma once

#include "../grid/fixed_point.h"

namespace voxrt::voxelize {

constexpr int sign_of(int128 v) { return v < 0 ? -1 : v > 0; }

/// Six times the volume of a tetrahedron: on which side of plane abc, seen against its normal, d lies.
constexpr int128 volume6_of(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
    const int128 ax = int128(a.x) - d.x, ay = int128(a.y) - d.y, az = int128(a.z) - d.z;
    const int128 bx = int128(b.x) - d.x, by = int128(b.y) - d.y, bz = int128(b.z) - d.z;
    const int128 cx = int128(c.x) - d.x, cy = int128(c.y) - d.y, cz = int128(c.z) - d.z;
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

} // namespace voxrt::voxelize
