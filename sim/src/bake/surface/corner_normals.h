// Smooth normals of a mesh that has none: by the angle between its triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

// Unit normals of the corners, 9 numbers per triangle. The normal of a corner is the sum of the normals of the
// triangles at its place that form an angle of less than acos(least_cosine) with its own, weighted by their angles
// there (Thurmer and Wuthrich, "Computing Vertex Normals from Polygonal Facets", 1998). Vertices with equal coordinates
// are one place. A triangle without area has zeros. `triangles` holds rows of the `vertices` positions.
std::vector<float> corner_normals(const double* positions, std::size_t vertices, const std::int32_t* triangles,
                                  std::size_t count, double least_cosine);

} // namespace voxrt::sim
