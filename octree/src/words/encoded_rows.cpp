#include "encoded_rows.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace voxrt::octree {

std::vector<uint32_t> encoded_rows(const Word* words, size_t count, unsigned block_bits) {
    const uint32_t leaf = uint32_t{1} << std::max(block_bits, 9u);
    std::vector<uint32_t> rows(size_t{8} << block_bits, leaf);
    if (count > 1 + rows.size())
        throw std::invalid_argument("an octree of " + std::to_string(count) + " words does not fit a memory of " +
                                    std::to_string(1 + rows.size()));
    for (size_t i = 1; i < count; ++i)
        rows[i - 1] = is_leaf(words[i]) ? leaf | material(words[i]) : static_cast<uint32_t>(block_number(words[i]));
    return rows;
}

} // namespace voxrt::octree
