// Where the voxelizer's time goes: wall seconds per stage. voxelizer.h says what each stage does and what bounds it.
#pragma once

#include <chrono>

namespace voxrt::voxelize {

struct StageSeconds {
    double analysis = 0, bin = 0;                        // one after the other
    double coverage = 0, fill = 0, holes = 0, order = 0; // per tile, added up
    double gather = 0;

    double of_tiles() const { return coverage + fill + holes + order; }
    void add_tiles(const StageSeconds& s, double scale) {
        coverage += s.coverage * scale;
        fill += s.fill * scale;
        holes += s.holes * scale;
        order += s.order * scale;
    }
};

/// Returns the seconds since the last call, or since construction. A call takes about 25 ns.
class Stopwatch {
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

} // namespace voxrt::voxelize
