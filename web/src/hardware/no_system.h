// What Verilator's run time includes and WASI lacks: threads, the clock of the process, files.
//
// It is included before every source of voxrt_hardware.wasm. The module has one thread, and with one thread the run
// time starts none: locks need not lock. The clock is for reports of speed that nobody asks for here. Files are /proc.
#pragma once

#include <atomic>
#include <compare>
#include <ctime>
#include <functional>
#include <mutex>
#include <sstream>
#include <string>

#define CLOCK_PROCESS_CPUTIME_ID CLOCK_MONOTONIC

namespace std {

class mutex {
public:
    void lock() {}
    void unlock() {}
    bool try_lock() { return true; }
};

class recursive_mutex : public mutex {};

class condition_variable_any {
public:
    void notify_one() {}
    void notify_all() {}
    template <class... Arguments> void wait(Arguments&&...) {}
};

class condition_variable : public condition_variable_any {};

class thread {
public:
    struct id {
        auto operator<=>(const id&) const = default;
    };

    template <class... Arguments> explicit thread(Arguments&&...) { __builtin_trap(); }
    void join() {}
    static unsigned hardware_concurrency() { return 1; }
};

template <> struct hash<thread::id> {
    size_t operator()(thread::id) const { return 0; }
};

namespace this_thread {
inline thread::id get_id() { return {}; }
inline void yield() {}
} // namespace this_thread

/// A file that is never there.
template <> struct basic_ifstream<char> : istringstream {
    explicit basic_ifstream(const string&) { setstate(failbit); }
};

} // namespace std
