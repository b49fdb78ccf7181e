// Interruption of long work, on one thread: the caller installs a check, the work counts what it does, and about every
// 10 ms the check runs. The check ends the work by throwing.
//
//     const InterruptScope scope([] { if (stop_requested) throw Stopped(); });
//     octree::hidden_voxels(memory); // throws Stopped
//
// All long functions of voxrt::voxelize, voxrt::octree and voxrt::sim count their work. Functions that take a number of
// threads run the check on the calling thread alone; the other threads stop with it (workers.h). Without a scope
// nothing is checked. Counting costs one subtraction and one comparison.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace voxrt::voxelize {

/// Counts the work of one thread.
class WorkCounter {
public:
    /// From one check to the next, on an idle processor.
    static constexpr double kCheckSeconds = 0.01;

    /// The counter of the current thread. A reference may be kept, but used on that thread only.
    static WorkCounter& current() { return current_; }

    /// Adds work, in units of about 10 ns. Throws what the check throws.
    void count(std::uint32_t units) {
        left_ -= static_cast<std::int32_t>(units);
        if (left_ <= 0)
            check();
    }

    /// Counts a small step, such as the visit of an octant.
    void count_step() { count(16); }

    /// Runs the check of the innermost scope now, if there is one.
    void check() {
        left_ = kPeriod;
        if (check_ != nullptr)
            (*check_)();
    }

    /// That check, for a further scope to call; null where there is none. It lives as long as its scope.
    const std::function<void()>* current_check() const { return check_; }

private:
    friend class InterruptScope;
    static constexpr std::int32_t kPeriod = 1 << 20;

    std::int32_t left_ = kPeriod;
    const std::function<void()>* check_ = nullptr;

    static thread_local WorkCounter current_;
};

inline constinit thread_local WorkCounter WorkCounter::current_;

/// Counts work of the current thread: see WorkCounter::count.
inline void count_work(std::uint32_t units) { WorkCounter::current().count(units); }

/// Installs a check on the current thread for its lifetime. Scopes nest: the innermost check is the one that runs.
class InterruptScope {
public:
    explicit InterruptScope(std::function<void()> check)
        : check_(std::move(check)), counter_(WorkCounter::current()), outer_(std::exchange(counter_.check_, &check_)) {
        counter_.left_ = WorkCounter::kPeriod;
    }
    ~InterruptScope() { counter_.check_ = outer_; }
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;

private:
    const std::function<void()> check_;
    WorkCounter& counter_;
    const std::function<void()>* outer_;
};

} // namespace voxrt::voxelize
