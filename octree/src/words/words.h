// The words of an octree memory.
//
// A word with bit 31 clear is a pointer: the address of octant 0 in a block of 8 words. A word 0xFFFFFFmm is a leaf of
// material mm; 0 is empty space. Word 0 is the root; blocks stand at addresses 1 + 8k. The index of an octant in its
// block is {z, y, x}, x in bit 0. An octant of level n has 2**n voxels per side.
#pragma once

#include <voxrt/voxelize/work/large_vector.h>

#include <array>
#include <cstdint>

namespace voxrt::octree {

using Word = std::uint32_t;
using Block = std::array<Word, 8>;

/// The words of a memory that was made.
using Words = voxelize::LargeVector<Word>;

constexpr unsigned kMaxDepth = 16;
constexpr Word kTag = 0xFFFFFF00u;
constexpr Word kEmpty = kTag;

constexpr bool is_leaf(Word word) { return (word >> 31) != 0; }
constexpr std::uint8_t material(Word leaf) { return static_cast<std::uint8_t>(leaf); }
constexpr Word leaf(std::uint8_t material) { return kTag | material; }

/// Voxels in an octant of side 2**level: at most 2**48, so every count of voxels fits 64 bits.
constexpr std::uint64_t voxels_at(unsigned level) { return std::uint64_t{1} << (3 * level); }

} // namespace voxrt::octree
