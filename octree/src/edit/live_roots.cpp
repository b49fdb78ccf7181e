#include "live_roots.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace voxrt::octree {

void LiveRoots::release(std::size_t address) {
    const voxelize::Lock lock(mutex_);
    const auto entry = find(address);
    if (entry + 1 == entries_.end())
        throw std::invalid_argument("the root at word " + std::to_string(address) +
                                    " was committed last, and a device needs it; release older ones");
    entry->released = true;
    end_unused(entry);
}

Word LiveRoots::begin_view(std::size_t address) {
    const voxelize::Lock lock(mutex_);
    const auto entry = find(address);
    ++entry->views;
    return entry->root.word;
}

void LiveRoots::end_view(std::size_t address) noexcept {
    const voxelize::Lock lock(mutex_);
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& one) { return one.root.address == address; });
    --entry->views;
    end_unused(entry);
}

std::vector<LiveRoots::Entry>::iterator LiveRoots::find(std::size_t address) {
    const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& one) { return one.root.address == address && !one.released; });
    if (entry == entries_.end())
        throw std::invalid_argument("the root at word " + std::to_string(address) + " is not live");
    return entry;
}

void LiveRoots::end_unused(std::vector<Entry>::iterator entry) {
    if (!entry->released || entry->views != 0)
        return;
    ended_.push_back(entry->root);
    entries_.erase(entry);
}

} // namespace voxrt::octree
