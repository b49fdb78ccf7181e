// The text of a memory, as $readmemh reads it: a line per word, eight upper-case hexadecimal digits and a newline.
//
// Beside the text its CRC-32 (ISO 3309, as zlib computes it), which a manifest knows a memory by. It is computed from
// the words alone, four bytes of a word at a time: a CRC is linear, so each byte of a word has its own table.
//
// Cost: about 3 ns per word and thread for both, less than the disk takes.
#pragma once

#include "../words/words.h"

#include <cstddef>

namespace voxrt::octree {

constexpr std::size_t kMemLine = 9; // characters per word

/// Writes `count` lines to `text` (9 * count characters). `threads`: 0 takes as many as the machine has.
void write_mem_text(const Word* words, std::size_t count, char* text, int threads);

/// The CRC-32 of the text of `count` words that follows text with the CRC-32 `before` (0 for none).
std::uint32_t mem_text_crc32(const Word* words, std::size_t count, std::uint32_t before, int threads);

/// Reads the text of write_mem_text(), `count` lines, into `words`. False where a line is anything else.
bool read_mem_text(const char* text, std::size_t count, Word* words, int threads);

} // namespace voxrt::octree
