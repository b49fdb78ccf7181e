// One call at a time on an object that Python threads share: the GIL, held when this is made and ended, guards the
// flag.
#pragma once

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

} // namespace voxrt::rtl
