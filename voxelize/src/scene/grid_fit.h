// Fitting a grid of voxels to a scene: its lowest corner is the lowest corner of what will be voxelized.
//
//     Bounds bounds;
//     for (each instance of points)
//         bounds.add(points, placed);       // placed: its 3x4 transform to the scene frame
//     const FittedGrid grid = fit_grid(bounds, depth); // throws UnfitScene
//
// Every sum is taken from left to right in doubles, so that the grid is the same on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace voxrt::voxelize {

/// A scene that no grid fits: what is wrong, and how to fix it; that may be empty.
struct UnfitScene : std::runtime_error {
    UnfitScene(const std::string& problem, std::string fix) : std::runtime_error(problem), fix(std::move(fix)) {}
    std::string fix;
};

/// The smallest box around points.
class Bounds {
public:
    /// Adds the vertices that `used` marks (used_vertices.h), or all where it is empty. `positions`: 3 per vertex,
    /// float or double. `transform`: rows of the affine map (3x4) to the scene frame.
    template <class Real>
    void add(std::span<const Real> positions, std::span<const uint8_t> used, std::span<const double, 12> transform);

    /// Throws UnfitScene where there is no point, or a coordinate that is not finite. `hidden`: how many objects of the
    /// scene are hidden.
    void check(size_t hidden) const;

    /// Metres, scene frame.
    const std::array<double, 3>& low() const { return low_; }
    const std::array<double, 3>& high() const { return high_; }

private:
    static constexpr double kNone = __builtin_huge_val();
    std::array<double, 3> low_{kNone, kNone, kNone};
    std::array<double, 3> high_{-kNone, -kNone, -kNone};
    bool not_a_number_ = false;
};

/// A cube of 2^depth voxels per side: metres, scene frame.
struct FittedGrid {
    unsigned depth;
    std::array<double, 3> origin; // of voxel (0, 0, 0): its lowest corner
    double voxel_size;

    /// The map from an object's frame to grid space in 1/4096 voxel (parts.h): rows of 3x4, as is `transform`, the map
    /// to the scene frame.
    std::array<double, 12> frame(std::span<const double, 12> transform) const;
};

/// The longest side of a box. Throws UnfitScene where it is not finite.
double longest_side(const std::array<double, 3>& low, const std::array<double, 3>& high);

/// The smallest grid of this depth that holds a box.
FittedGrid fit_grid(const std::array<double, 3>& low, const std::array<double, 3>& high, unsigned depth);

} // namespace voxrt::voxelize
