// Errors of the C interface: what a call threw, as one line.
#pragma once

#include <voxrt/voxelize/scene/grid_fit.h>

#include <exception>
#include <new>
#include <string>

namespace voxrt::web {

/// Why the last call failed.
inline std::string& last_error() {
    static std::string text;
    return text;
}

/// Calls `work` and returns what it returns; where it throws, keeps the reason and returns -1.
template <class Work> auto guarded(Work work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        last_error() = "takes more memory than a browser gives one page; choose a lesser depth";
    } catch (const voxelize::UnfitScene& unfit) {
        last_error() = unfit.fix.empty() ? unfit.what() : unfit.what() + ("; " + unfit.fix);
    } catch (const std::exception& failure) {
        last_error() = failure.what();
    }
    return -1;
}

} // namespace voxrt::web
