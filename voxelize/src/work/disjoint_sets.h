// Disjoint sets of numbers that merge: union-find with path halving (Tarjan and van Leeuwen, "Worst-Case Analysis of
// Set Union Algorithms", 1984). The lowest number of a set is its name, so the names do not depend on the order of
// merging.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace voxrt::voxelize {

class DisjointSets {
public:
    /// Each number 0 … count-1 in a set of its own.
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    /// The lowest number of the set that holds `i`.
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    /// Merges the sets of two numbers; returns whether they were two.
    bool merge(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<std::uint32_t> parent_;
};

} // namespace voxrt::voxelize
