// A mutex of one name everywhere. WebAssembly has no threads here: its locks are empty.
#pragma once

#if !defined(__wasm__)
#include <mutex>
#endif

namespace voxrt::voxelize {

#if defined(__wasm__)

struct Mutex {};
struct Lock {
    explicit Lock(Mutex&) {}
    ~Lock() {} // so that nobody calls it unused
};

#else

using Mutex = std::mutex;
using Lock = std::lock_guard<std::mutex>;

#endif

} // namespace voxrt::voxelize
