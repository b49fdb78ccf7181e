// The words of an octree memory. No other C++ file knows their bits.
//
// A word with bit 31 clear is a pointer: the address of octant 0 in a block of 8 words. A word 0xFFFFFFmm is a leaf of
// material mm; material 0 is empty space. Word 0 is the root; blocks stand at addresses 1 + 8k. The index of an octant
// in its block is {z, y, x}, x in bit 0. An octant of level n has 2**n voxels per side.
//
// This is the dialect `report`. The dialect `lod` has the same leaves, and pointers that are the number of a block
// above the material that the block is seen as from afar.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace voxrt::octree {

using Word = std::uint32_t;
using Block = std::array<Word, 8>;

constexpr unsigned kMaxDepth = 16;
constexpr Word kTag = 0xFFFFFF00u;
constexpr Word kEmpty = kTag;

constexpr bool is_leaf(Word word) { return (word >> 31) != 0; }
constexpr std::uint8_t material(Word leaf) { return static_cast<std::uint8_t>(leaf); }
constexpr Word leaf(std::uint8_t material) { return kTag | material; }

/// Whether a leaf has the tag of the dialects `report` and `lod`.
constexpr bool is_tagged(Word word) { return word >= kTag; }

/// Blocks have numbers in the order of their addresses.
constexpr bool is_block_address(std::size_t address) { return address % 8 == 1; }
constexpr std::size_t block_address(std::size_t number) { return 1 + 8 * number; }
constexpr std::size_t block_number(Word address) { return address / 8; }

/// A memory holds the root and whole blocks.
constexpr bool is_memory_size(std::size_t words) { return words % 8 == 1; }
constexpr std::size_t memory_size(std::size_t blocks) { return 1 + 8 * blocks; }
constexpr std::size_t block_count(std::size_t words) { return words / 8; }

/// The most blocks that pointers reach.
constexpr std::size_t kBlockLimit = (std::size_t{1} << 28) - 1;
[[noreturn]] inline void throw_too_many_blocks() {
    throw std::length_error(
        "the octree has more than 2**28 - 1 blocks, which 31-bit addresses cannot reach; lower the depth");
}

/// The fields of a pointer of the dialect `lod`; its leaves are those for which is_tagged() holds.
constexpr std::size_t lod_block_number(Word pointer) { return pointer >> 8; }
constexpr std::uint8_t lod_mean(Word pointer) { return static_cast<std::uint8_t>(pointer); }

/// Voxels in an octant of side 2**level: at most 2**48, so every count of voxels fits 64 bits.
constexpr std::uint64_t voxels_at(unsigned level) { return std::uint64_t{1} << (3 * level); }

} // namespace voxrt::octree
