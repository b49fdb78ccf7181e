// Vertices that are connected, as sets that merge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace voxrt {

/// Each set goes by its lowest vertex.
class VertexGroups {
public:
    explicit VertexGroups(size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0u); }

    uint32_t of(uint32_t v) {
        while (parent_[v] != v)
            v = parent_[v] = parent_[parent_[v]];
        return v;
    }

    /// Whether they were in two sets.
    bool join(uint32_t a, uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<uint32_t> parent_;
};

} // namespace voxrt
