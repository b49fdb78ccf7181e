// Writes fields into a wide port of a verilated model, as a packed struct has them: one after another, the last one
// lowest.
#pragma once

#include <cstdint>

namespace voxrt::rtl {

// Words: 32 bits each, the lowest first.
template <class Words> class BitFields {
public:
    explicit BitFields(Words& words) : words_(words) {}

    // The field above all before; bits of the value beyond the width do not count. 1 <= width <= 32.
    void put(uint32_t value, unsigned width) {
        for (unsigned i = 0; i < width; ++i, ++place_) {
            const uint32_t bit = uint32_t{1} << place_ % 32;
            if (value >> i & 1)
                words_[place_ / 32] |= bit;
            else
                words_[place_ / 32] &= ~bit;
        }
    }

private:
    Words& words_;
    unsigned place_ = 0;
};

} // namespace voxrt::rtl
