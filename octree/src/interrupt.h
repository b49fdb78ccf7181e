// Lets Ctrl-C through while the GIL is released.
#pragma once

#include <cstdint>

#include <nanobind/nanobind.h>

namespace voxrt::octree {

/// From the thread that Python called, without the GIL: asks for signals and throws what their handlers raised.
class Interrupt {
public:
    /// Once a small unit of work: every 2**16 calls count.
    void poll() {
        if ((++calls_ & 0xFFFF) == 0)
            check();
    }

    /// Once a large unit of work.
    static void check() {
        nanobind::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0)
            throw nanobind::python_error();
    }

private:
    std::uint32_t calls_ = 0;
};

} // namespace voxrt::octree
