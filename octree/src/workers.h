// Chunks of work on several threads, the calling one among them.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace voxrt::octree {

/// How many threads `asked` (0: as many as the machine has) means for `chunks` chunks.
inline unsigned worker_count(unsigned asked, std::size_t chunks) {
    const unsigned wanted = asked != 0 ? asked : std::max(1u, std::thread::hardware_concurrency());
    return static_cast<unsigned>(std::min<std::size_t>({wanted, std::max<std::size_t>(chunks, 1), 64}));
}

/// Calls `work(worker, chunk)` once for each chunk 0 ... chunks - 1, in any order; worker 0 is the calling thread.
/// Rethrows the first exception after all threads have ended; no chunk starts after one was thrown.
template <typename Work> void for_each_chunk(unsigned workers, std::size_t chunks, Work work) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto run = [&](unsigned worker) {
        try {
            for (std::size_t chunk; (chunk = next.fetch_add(1)) < chunks;)
                work(worker, chunk);
        } catch (...) {
            next = chunks;
            const std::lock_guard lock(failure_mutex);
            if (!failure)
                failure = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    for (unsigned worker = 1; worker < workers; ++worker)
        threads.emplace_back(run, worker);
    run(0);
    for (std::thread& thread : threads)
        thread.join();
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace voxrt::octree
