// When a consumer is not ready: runs of random length, stalled or not, so that queues fill and drain.
#pragma once

#include <cstdint>

namespace voxrt::rtl {

class StallPattern {
public:
    // Seed 0 never stalls.
    explicit StallPattern(uint32_t seed) : state_(seed) {}

    // Whether the consumer stalls in the next clock.
    bool next() {
        if (state_ == 0)
            return false;
        if (run_ == 0) {
            state_ ^= state_ << 13; // xorshift32 (Marsaglia 2003)
            state_ ^= state_ >> 17;
            state_ ^= state_ << 5;
            stalled_ = !stalled_;
            run_ = 1 + (state_ % 8 == 0 ? state_ / 8 % 200 : state_ / 8 % 4);
        }
        --run_;
        return stalled_;
    }

private:
    uint32_t state_;
    unsigned run_ = 0;
    bool stalled_ = false;
};

} // namespace voxrt::rtl
