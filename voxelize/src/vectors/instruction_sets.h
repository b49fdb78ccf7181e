// The instruction sets that some sources are compiled for, one of which is chosen at run time. An engine is what one of
// these sources offers: a struct whose member `instructions` is the name of its set.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::voxelize {

#if defined(__x86_64__)
/// Whether the processor runs files that end in _avx512.cpp.
inline bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
/// Whether it runs files that end in _avx2.cpp.
inline bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#endif

/// The engine with a name, or the first one where the name is empty.
template <class Engine> const Engine& engine_of(const std::vector<Engine>& engines, const std::string& instructions) {
    for (const Engine& engine : engines)
        if (instructions.empty() || instructions == engine.instructions)
            return engine;
    throw std::invalid_argument("this processor has no instruction set '" + instructions + "'");
}

} // namespace voxrt::voxelize
