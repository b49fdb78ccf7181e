// The solid voxels of a memory as bits.
#pragma once

#include <voxrt/octree/words/verify.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

// A box of voxels, one bit each: that of (x, y, z) is bit x - low[0] of its row, a run of 64-bit words. Every row has a
// word of zeros before it, and at least one after it.
struct Occupancy {
    std::int64_t low[3]; // the voxel of the first bit
    std::size_t size[3]; // voxels; size[0] is a multiple of kChunkBits
    std::size_t stride;  // words from row to row
    std::size_t frame;   // empty rows beside the box on each side of y, and planes of them on each side of z
    std::vector<std::uint64_t> words;

    static constexpr std::size_t kChunkBits = 256;

    // Words from plane to plane.
    std::size_t plane() const { return (size[1] + 2 * frame) * stride; }
    // The first word of the row of voxels (y, z), counted from `low`.
    std::size_t row(std::size_t y, std::size_t z) const { return (z + frame) * plane() + (y + frame) * stride + 1; }
};

// What the box of the solid voxels and a `margin` of voxels around it would take, in bits; 0 where nothing is solid.
std::uint64_t occupancy_bits(const octree::Memory& memory, std::int64_t margin);

// That box, in a frame. Cost: the bits, and the octants at the surface.
Occupancy occupancy_of(const octree::Memory& memory, std::int64_t margin, std::size_t frame);

} // namespace voxrt::sim
