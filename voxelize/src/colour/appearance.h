// Surface appearance: textures, vertex colours and colour factors of triangles, as their file describes them. Colours
// multiply in linear light. Alpha is coverage.
#pragma once

#include "numbers.h"
#include "texture.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxrt::voxelize {

/// Shares of a triangle's corners in a point of it; their sum is 1.
using Barycentric = std::array<double, 3>;

struct Appearance {
    std::string name;
    Light factor{1, 1, 1, 1}; // multiplied with the texture and the vertex colours
    std::optional<Texture> texture;
    double cutoff = 0; // the surface is cut away where its alpha is below this; 0: opaque
    bool mirror = false;
};

/// The appearance of the triangles of one mesh, in the order of its triangles. Borrowed.
struct Surface {
    std::span<const Appearance> entries;
    std::span<const int32_t> rows; // each triangle's entry, or -1 where its material alone gives its colour
    Numbers uv;                    // (T, 3, 2): texture coordinates of its corners
    Numbers colours;               // (T, 3, 4): linear colour and alpha of its corners

    size_t size() const { return rows.size(); }
};

/// The colour of points on one triangle; `texture` stands for that of its appearance.
class TrianglePaint {
public:
    TrianglePaint(const Surface& surface, size_t triangle, const Appearance& appearance, const Texture* texture);

    Light at(const Barycentric& shares) const;

private:
    const Texture* texture_;
    Light factor_;
    double uv_[3][2];
    double colours_[3][4];
};

/// The colour of a point on a triangle whose row is not -1.
Light sample(const Surface& surface, size_t triangle, const Barycentric& shares);

/// Which triangles have an appearance and are not fully transparent. Those that may be cut away are sampled at the
/// centroids of n² equal parts; n grows with the triangle's size in the texture.
std::vector<uint8_t> visible_triangles(const Surface& surface, int threads);

/// The centroids of a triangle's n² equal parts.
std::vector<Barycentric> centroids(int n);

} // namespace voxrt::voxelize
