// The rows of the ray tracer's octree memory, as rtl/memory/voxrt_word_encoder.sv makes them of words.
#pragma once

#include "words.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::octree {

/// The 8 * 2^block_bits rows; those beyond the words are empty space. `words`: checked; word 0 is in no row. Throws
/// std::invalid_argument where they are too many.
std::vector<uint32_t> encoded_rows(const Word* words, size_t count, unsigned block_bits);

} // namespace voxrt::octree
