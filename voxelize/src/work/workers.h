// Threads that share numbered jobs. Results are kept by job and never by thread, so they do not depend on the number of
// threads.
//
// The calling thread works too, and runs its interrupt check (interrupt.h): as its jobs count their work, and every
// 20 ms while it waits for the others. The first exception that a job or the check throws stops all threads, in the
// middle of their jobs where these count their work, and is thrown again by run().
//
// WebAssembly has no threads here: the caller does all jobs.
#pragma once

#include "interrupt.h"

#include <cstddef>
#if !defined(__wasm__)
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>
#endif

namespace voxrt::voxelize {

#if defined(__wasm__)

class Workers {
public:
    explicit Workers(int) {}

    int threads() const { return 1; }

    template <class Job> void run(std::size_t count, Job&& job) const {
        for (std::size_t index = 0; index < count; ++index)
            job(index, 0);
    }
};

#else

class Workers {
public:
    /// `threads`, the calling one included; 0 takes as many as the machine has.
    explicit Workers(int threads)
        : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

    int threads() const { return threads_; }

    /// Calls job(index, thread) once for each index 0 … count-1, in ascending order of start. `thread`, 0 …
    /// threads()-1, names the scratch memory that the job may use; thread 0 is the caller. Starts no more threads than
    /// there are jobs, and fewer where the system refuses them.
    template <class Job> void run(std::size_t count, Job&& job) const {
        std::atomic<std::size_t> next{0};
        std::atomic<bool> failed{false};
        std::exception_ptr failure;
        std::mutex mutex;
        std::condition_variable ended;
        int running = 0; // threads but this one
        auto guard = [&](auto&& work) {
            try {
                work();
            } catch (const Stopped&) {
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure)
                    failure = std::current_exception();
                failed = true;
                next = count;
            }
        };
        auto work = [&](int thread) {
            for (std::size_t index; (index = next.fetch_add(1, std::memory_order_relaxed)) < count;)
                job(index, thread);
        };
        auto stop_if_failed = [&failed] {
            if (failed)
                throw Stopped();
        };
        auto work_beside = [&](int thread) {
            guard([&] {
                const InterruptScope scope(stop_if_failed);
                work(thread);
            });
            const std::lock_guard lock(mutex);
            --running;
            ended.notify_one();
        };
        std::vector<std::thread> others;
        for (int thread = 1; thread < threads_ && static_cast<std::size_t>(thread) < count; ++thread) {
            {
                const std::lock_guard lock(mutex);
                ++running;
            }
            try {
                others.emplace_back(work_beside, thread);
            } catch (const std::system_error&) { // no further thread: those that run share the jobs
                const std::lock_guard lock(mutex);
                --running;
                break;
            }
        }
        guard([&] {
            WorkCounter& counter = WorkCounter::current();
            const InterruptScope scope([&, outer = counter.current_check()] {
                stop_if_failed();
                if (outer != nullptr)
                    (*outer)();
            });
            work(0);
            for (std::unique_lock lock(mutex); running > 0;) {
                ended.wait_for(lock, std::chrono::milliseconds(20));
                lock.unlock();
                counter.check();
                lock.lock();
            }
        });
        for (std::thread& other : others)
            other.join();
        if (failure)
            std::rethrow_exception(failure);
    }

private:
    struct Stopped {}; // by the failure of another thread

    int threads_;
};

#endif

} // namespace voxrt::voxelize
