// In place of a recorder, for designs that were verilated without tracing.
#pragma once

#include <string>

namespace voxrt::rtl {

template <class Model> class NoRecorder {
public:
    static constexpr bool traces = false;
    void start(Model&) {}
    void sample() {}
    std::string take() { return {}; }
};

} // namespace voxrt::rtl
