// What a brick of 8x8x8 cells looks like, and how much the look changes where another brick takes its place.
//
// A brick is seen along the eight diagonals of its cube. One ray enters each cell face on the three near sides, so
// faces hide each other as in pictures, and all three axes count alike.
#pragma once

#include <array>
#include <cstdint>

namespace voxrt::octree {

using Cells512 = std::array<std::uint8_t, 512>; // materials in Morton order, 0 empty
using Mask512 = std::array<std::uint64_t, 8>;   // a bit per cell, Morton order

/// Costs of a change for one ray: mean squared differences of colour. 256 is the cost of a grey face that turns to
/// another axis.
struct AppearanceCosts {
    std::array<std::array<std::uint32_t, 256>, 256> same_axis;  // material a becomes b
    std::array<std::array<std::uint32_t, 256>, 256> other_axis; // the same, and the face is across another axis
    std::array<std::uint32_t, 256> occlusion;                   // material b hides what was seen past the brick
};

/// Cost of an exposed cell that is exposed no longer, or of another material.
constexpr std::uint64_t kExposedCellCost = 300;

/// Cost of a solid cell that was empty.
constexpr std::uint64_t kAddedCellCost = 100;

/// A brick and what its rays see.
struct BrickAppearance {
    static constexpr unsigned kRays = 8 * 3 * 64;

    explicit BrickAppearance(const Cells512& materials);

    Cells512 cells;
    Mask512 mask{};    // solid cells
    Mask512 exposed{}; // those with an empty neighbour inside the brick
    unsigned solid = 0;
    std::array<std::uint16_t, kRays> seen{}; // material + 256 * (axis of the face + 1); 0 where a ray meets nothing
};

/// The cost of showing `after` in place of `before`, all of whose solid cells it holds; kAddedCellCost not included.
/// May stop, with a lower result, once the cost is `limit` or more.
std::uint64_t appearance_cost(const BrickAppearance& before, const BrickAppearance& after, const AppearanceCosts& costs,
                              std::uint64_t limit);

} // namespace voxrt::octree
