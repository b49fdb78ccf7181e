// The roots of a world that somebody still reads: a device that draws a frame, or a thread.
#pragma once

#include "../words/words.h"

#include <voxrt/voxelize/work/mutex.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxrt::octree {

/// The table of live roots. A root is live from its commit until it is released and no view of it is left. Any thread
/// may release roots and end views; the thread that edits takes the roots that are no longer live, and frees them.
class LiveRoots {
public:
    struct Root {
        std::size_t address;
        Word word;
    };

    void add(const Root& root) {
        const voxelize::Lock lock(mutex_);
        ended_.reserve(ended_.size() + entries_.size() + 1); // so that end_view() does not throw
        entries_.push_back({root, 0, false});
    }

    /// The root that was committed last.
    Root newest() const {
        const voxelize::Lock lock(mutex_);
        return entries_.back().root;
    }

    /// In the order of their commits. `all`: with those that are released and that views still read, and those that
    /// take_ended() would return.
    std::vector<Root> roots(bool all) const {
        const voxelize::Lock lock(mutex_);
        std::vector<Root> found;
        for (const Entry& entry : entries_)
            if (all || !entry.released)
                found.push_back(entry.root);
        if (all)
            found.insert(found.end(), ended_.begin(), ended_.end());
        return found;
    }

    /// Releases the root at an address. Throws std::invalid_argument where it is not live, or is the newest.
    void release(std::size_t address);

    /// Counts a view of a live root, which end_view() ends. Throws std::invalid_argument where it is not live.
    Word begin_view(std::size_t address);
    void end_view(std::size_t address) noexcept;

    /// The roots that are no longer live since the last call.
    std::vector<Root> take_ended() {
        const voxelize::Lock lock(mutex_);
        return std::exchange(ended_, {});
    }

private:
    struct Entry {
        Root root;
        std::uint32_t views;
        bool released;
    };

    std::vector<Entry>::iterator find(std::size_t address);
    void end_unused(std::vector<Entry>::iterator entry);

    mutable voxelize::Mutex mutex_;
    std::vector<Entry> entries_; // in the order of their commits
    std::vector<Root> ended_;
};

} // namespace voxrt::octree
