// One call at a time on an object that Python threads share: the GIL, held when this is made and ended, guards the
// flag.
#pragma once

#include <nanobind/nanobind.h>

#include <stdexcept>

namespace voxrt::rtl {

class OneCall {
public:
    explicit OneCall(bool& busy) : busy_(busy) {
        if (busy)
            throw std::runtime_error("at work in another thread: make one such object a thread");
        busy_ = true;
    }
    ~OneCall() { busy_ = false; }
    OneCall(const OneCall&) = delete;
    OneCall& operator=(const OneCall&) = delete;

private:
    bool& busy_;
};

// Raises what Python's signal handlers raise; called without the GIL, now and then.
inline void check_signals() {
    nanobind::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0)
        throw nanobind::python_error();
}

} // namespace voxrt::rtl
