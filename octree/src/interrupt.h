// Lets Ctrl-C through while the GIL is released.
#pragma once

#include <nanobind/nanobind.h>

namespace voxrt::octree {

/// Call `poll` once a unit of work, from the thread that Python called; every 2**16 calls it asks Python for signals
/// and throws what their handlers raised. The GIL must not be held.
class Interrupt {
public:
    void poll() {
        if ((++calls_ & 0xFFFF) != 0)
            return;
        nanobind::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0)
            throw nanobind::python_error();
    }

private:
    std::uint32_t calls_ = 0;
};

} // namespace voxrt::octree
