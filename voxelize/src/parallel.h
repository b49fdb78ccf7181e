// Work for several threads: numbered jobs, taken in order, results kept by number and never by thread.
//
// The calling thread works too and calls `poll` now and then (the place for Ctrl-C): by the work done, wherever that
// calls `pulse`, so that long jobs may be stopped as well, and while it waits for the other threads. The first
// exception that a job or poll throws stops the rest, in the midst of their jobs, and is thrown again here.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace voxrt {

/// What a thread does now and then in the midst of its work; it may throw.
class Pulse {
public:
    /// Counts work, in units of about 10 ns; a hundredth of a second or so makes a beat.
    void count(uint32_t work) {
        left_ -= int32_t(work);
        if (left_ <= 0) {
            left_ = kBeat;
            if (beat_ != nullptr)
                (*beat_)();
        }
    }

    /// That of the current thread.
    static Pulse& own() { return own_; }

    /// Sets what the current thread does, as long as this lives.
    class Beat {
    public:
        explicit Beat(std::function<void()> beat) : beat_(std::move(beat)), before_(std::exchange(own_.beat_, &beat_)) {
            own_.left_ = kBeat;
        }
        ~Beat() { own_.beat_ = before_; }
        Beat(const Beat&) = delete;
        Beat& operator=(const Beat&) = delete;

    private:
        const std::function<void()> beat_;
        const std::function<void()>* before_;
    };

private:
    static constexpr int32_t kBeat = 1 << 20;
    int32_t left_ = kBeat;
    const std::function<void()>* beat_ = nullptr;

    static thread_local Pulse own_;
};

inline constinit thread_local Pulse Pulse::own_;

/// To be called by all work that may be long, once for each small part of it.
inline void pulse(uint32_t work) { Pulse::own().count(work); }

class Workers {
public:
    /// `threads` 0: as many as the machine has.
    Workers(int threads, std::function<void()> poll)
        : threads_(threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()))), poll_(poll),
          beat_(std::move(poll)) {}

    int threads() const { return threads_; }

    /// Runs job(index, thread) for index 0 … count-1; thread 0 … threads()-1 tells whose scratch memory to use.
    template <class Job> void run(size_t count, Job&& job) {
        std::atomic<size_t> next{0};
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
            for (size_t index; (index = next.fetch_add(1, std::memory_order_relaxed)) < count;)
                job(index, thread);
        };
        std::vector<std::thread> others;
        for (int thread = 1; thread < threads_ && size_t(thread) < count; ++thread) {
            {
                const std::lock_guard lock(mutex);
                ++running;
            }
            others.emplace_back([&, thread] {
                guard([&] {
                    const Pulse::Beat beat([&failed] {
                        if (failed)
                            throw Stopped();
                    });
                    work(thread);
                });
                const std::lock_guard lock(mutex);
                --running;
                ended.notify_one();
            });
        }
        guard([&] {
            const Pulse::Beat beat([&] {
                if (failed)
                    throw Stopped();
                poll_();
            });
            work(0);
            for (std::unique_lock lock(mutex); running > 0;) {
                ended.wait_for(lock, std::chrono::milliseconds(20));
                lock.unlock();
                if (!failed)
                    poll_();
                lock.lock();
            }
        });
        for (std::thread& other : others)
            other.join();
        if (failure)
            std::rethrow_exception(failure);
    }

private:
    struct Stopped {}; // by another thread's failure

    int threads_;
    std::function<void()> poll_;
    Pulse::Beat beat_; // between runs
};

} // namespace voxrt
