// Lets whoever waits for long work stop it.
#pragma once

#include <cstdint>

namespace voxrt::octree {

/// Long work calls `poll` for each of its small steps and `check` for each large one; both call `hook` now and then,
/// which ends the work by throwing. The Python module's hook lets Ctrl-C through; without one nothing is asked.
class Interrupt {
public:
    /// For the whole process; set it before the first work begins. Called from the thread that asked for the work.
    static inline void (*hook)() = [] {};

    /// Once a small unit of work: every 2**16 calls count.
    void poll() {
        if ((++calls_ & 0xFFFF) == 0)
            hook();
    }

    /// Once a large unit of work.
    static void check() { hook(); }

private:
    std::uint32_t calls_ = 0;
};

} // namespace voxrt::octree
