// Work that falls into independent tiles, spread over the cores.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace voxrt::model {

// Calls work(tile) -> uint64_t once for each tile 0 ... tiles - 1, on `threads` threads (0: one a core) of which the
// caller is one, and returns the sum. `interrupted` is asked from the calling thread about every 50 ms; once it says
// true no further tile begins. `work` must not throw.
template <class Work>
uint64_t on_all_cores(size_t tiles, int threads, const std::function<bool()>& interrupted, const Work& work) {
    std::atomic<size_t> next{0};
    std::atomic<uint64_t> sum{0};
    const auto take_one = [&] {
        const size_t tile = next.fetch_add(1, std::memory_order_relaxed);
        if (tile >= tiles)
            return false;
        sum.fetch_add(work(tile), std::memory_order_relaxed);
        return true;
    };
    size_t crew = threads > 0 ? static_cast<size_t>(threads) : std::thread::hardware_concurrency();
    crew = crew < tiles ? crew : tiles;
    std::vector<std::thread> helpers;
    for (size_t helper = 1; helper < crew; ++helper)
        try {
            helpers.emplace_back([&] {
                while (take_one()) {
                }
            });
        } catch (const std::system_error&) { // no more threads to be had: the others do its share
            break;
        }
    auto asked = std::chrono::steady_clock::now();
    while (take_one()) {
        const auto now = std::chrono::steady_clock::now();
        if (now - asked < std::chrono::milliseconds(50))
            continue;
        asked = now;
        if (interrupted())
            next.store(tiles, std::memory_order_relaxed);
    }
    for (std::thread& helper : helpers)
        helper.join();
    return sum.load();
}

} // namespace voxrt::model
