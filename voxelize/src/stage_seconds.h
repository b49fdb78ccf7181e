// Where the voxelizer's time goes: wall seconds by stage.
#pragma once

#include <chrono>

namespace voxrt {

/// What bounds each: voxelizer.h.
struct StageSeconds {
    double survey = 0, bin = 0;                          // one after the other
    double coverage = 0, fill = 0, holes = 0, order = 0; // of a tile
    double gather = 0;

    double of_tiles() const { return coverage + fill + holes + order; }
    void add_tiles(const StageSeconds& s, double scale) {
        coverage += s.coverage * scale;
        fill += s.fill * scale;
        holes += s.holes * scale;
        order += s.order * scale;
    }
};

/// Gives the time since it was last asked. Bound: a reading of the clock, 25 ns.
class Lap {
public:
    double operator()() {
        const auto now = std::chrono::steady_clock::now();
        const double passed = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return passed;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace voxrt
