// What a brick of 8x8x8 cells looks like, and how far apart two looks are.
#pragma once

#include <array>
#include <cstdint>

namespace voxrt::octree {

using Cells512 = std::array<std::uint8_t, 512>; // materials in Morton order, 0 empty

/// Mean squared differences of colour that a change makes to what a ray sees; 256 is that of a grey face that turns.
struct SightCosts {
    std::array<std::array<std::uint32_t, 256>, 256> same_face; // material a becomes b
    std::array<std::array<std::uint32_t, 256>, 256> turned;    // the same, on a face along another axis
    std::array<std::uint32_t, 256> covering;                   // material b comes before what is seen past the brick
};

/// Prices of an exposed cell that is no longer so or of another material, and of a cell that was empty.
constexpr std::uint64_t kChanged = 300;
constexpr std::uint64_t kAppeared = 100;

using Mask512 = std::array<std::uint64_t, 8>; // a bit a cell, Morton order

/// A brick and what is seen of it along the diagonals of its cube: one ray enters each face on the three near sides.
/// Seen so, faces hide each other as they do in pictures, and all three axes count alike.
struct Brick {
    static constexpr unsigned kRays = 8 * 3 * 64;

    explicit Brick(const Cells512& materials);

    Cells512 cells;
    Mask512 mask{};    // solid cells
    Mask512 exposed{}; // those with an empty neighbour inside the brick
    unsigned solid = 0;
    std::array<std::uint16_t, kRays> seen{}; // material + 256 * (axis of the face + 1); 0 where a ray meets nothing
};

/// What is seen to change where `after` stands for `before`, all of whose solid cells it holds. Counts no further once
/// it is `most` or more.
std::uint64_t sight_change(const Brick& before, const Brick& after, const SightCosts& costs, std::uint64_t most);

} // namespace voxrt::octree
