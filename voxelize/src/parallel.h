// Work for several threads: numbered jobs, taken in order, results kept by number and never by thread.
//
// The calling thread works too and calls `poll` now and then (the place for Ctrl-C). The first exception that a job or
// poll throws stops the rest and is thrown again here.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace voxrt {

class Workers {
public:
    /// `threads` 0: as many as the machine has.
    Workers(int threads, std::function<void()> poll)
        : threads_(threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()))),
          poll_(std::move(poll)) {}

    int threads() const { return threads_; }

    /// Runs job(index, thread) for index 0 … count-1; thread 0 … threads()-1 tells whose scratch memory to use.
    template <class Job> void run(size_t count, Job&& job) {
        std::atomic<size_t> next{0};
        std::exception_ptr failure;
        std::mutex failure_mutex;
        auto work = [&](int thread) {
            auto polled = std::chrono::steady_clock::now();
            try {
                for (size_t index; (index = next.fetch_add(1, std::memory_order_relaxed)) < count;) {
                    job(index, thread);
                    if (thread == 0 && std::chrono::steady_clock::now() - polled > std::chrono::milliseconds(50)) {
                        poll_();
                        polled = std::chrono::steady_clock::now();
                    }
                }
            } catch (...) {
                next = count;
                const std::lock_guard lock(failure_mutex);
                if (!failure)
                    failure = std::current_exception();
            }
        };
        std::vector<std::thread> others;
        for (int thread = 1; thread < threads_ && size_t(thread) < count; ++thread)
            others.emplace_back(work, thread);
        work(0);
        for (std::thread& other : others)
            other.join();
        if (failure)
            std::rethrow_exception(failure);
    }

private:
    int threads_;
    std::function<void()> poll_;
};

} // namespace voxrt
