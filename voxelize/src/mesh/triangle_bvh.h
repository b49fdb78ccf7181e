// A bounding volume hierarchy over triangles: finds those whose boxes overlap a box, or something else.
//
// Built by halving the triangles along the longest axis of their box, at the median of their centres. Building takes
// n log n; a query takes log n, and what it finds.
#pragma once

#include "../grid/fixed_point.h"
#include "../work/interrupt.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace voxrt::voxelize {

/// A closed box in grid space; empty at first.
struct TriangleBox {
    std::array<int32_t, 3> low{INT32_MAX, INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN, INT32_MIN};

    void add(const Vertex& v) {
        const int32_t at[3] = {v.x, v.y, v.z};
        for (int i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], at[i]);
            high[i] = std::max(high[i], at[i]);
        }
    }
    void add(const TriangleBox& box) {
        for (int i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], box.low[i]);
            high[i] = std::max(high[i], box.high[i]);
        }
    }
    bool overlaps(const TriangleBox& box) const {
        for (int i = 0; i < 3; ++i)
            if (low[i] > box.high[i] || high[i] < box.low[i])
                return false;
        return true;
    }
    bool contains(const TriangleBox& box) const {
        for (int i = 0; i < 3; ++i)
            if (low[i] > box.low[i] || high[i] < box.high[i])
                return false;
        return true;
    }
    double volume() const {
        double product = 1;
        for (int i = 0; i < 3; ++i)
            product *= double(high[i]) - low[i];
        return product;
    }
};

class TriangleBvh {
public:
    /// Takes triangles as their boxes and numbers.
    explicit TriangleBvh(std::vector<std::pair<TriangleBox, uint32_t>> triangles) : triangles_(std::move(triangles)) {
        if (!triangles_.empty())
            build(0, uint32_t(triangles_.size()));
    }

    /// Calls visit(number) for every triangle whose box overlaps `box`.
    template <class Visit> void find(const TriangleBox& box, Visit&& visit) const {
        find_where([&](const TriangleBox& other) { return other.overlaps(box); }, visit);
    }

    /// Calls visit(number) for every triangle whose box meets(box); so must each box that holds one which does.
    template <class Meets, class Visit> void find_where(Meets&& meets, Visit&& visit) const {
        uint32_t stack[64];
        int depth = 0;
        if (!nodes_.empty())
            stack[depth++] = 0;
        while (depth > 0) {
            count_work(1);
            const Node& node = nodes_[stack[--depth]];
            if (!meets(node.box))
                continue;
            if (node.right != 0) {
                stack[depth++] = node.right;
                stack[depth++] = uint32_t(&node - nodes_.data()) + 1;
                continue;
            }
            for (uint32_t i = node.first; i < node.last; ++i)
                if (meets(triangles_[i].first))
                    visit(triangles_[i].second);
        }
    }

private:
    static constexpr uint32_t kLeafTriangles = 8;

    struct Node {
        TriangleBox box;
        uint32_t first, last; // of triangles_
        uint32_t right = 0;   // the left child is the next node; 0 in a leaf
    };

    uint32_t build(uint32_t first, uint32_t last) {
        count_work(last - first);
        const auto index = uint32_t(nodes_.size());
        nodes_.push_back({{}, first, last});
        for (uint32_t i = first; i < last; ++i)
            nodes_[index].box.add(triangles_[i].first);
        if (last - first <= kLeafTriangles)
            return index;
        const TriangleBox& box = nodes_[index].box;
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (int64_t{box.high[i]} - box.low[i] > int64_t{box.high[axis]} - box.low[axis])
                axis = i;
        const uint32_t half = first + (last - first) / 2;
        std::nth_element(triangles_.begin() + first, triangles_.begin() + half, triangles_.begin() + last,
                         [axis](const auto& a, const auto& b) {
                             return int64_t{a.first.low[axis]} + a.first.high[axis] <
                                    int64_t{b.first.low[axis]} + b.first.high[axis];
                         });
        build(first, half);
        const uint32_t right = build(half, last);
        nodes_[index].right = right;
        return index;
    }

    std::vector<std::pair<TriangleBox, uint32_t>> triangles_;
    std::vector<Node> nodes_;
};

} // namespace voxrt::voxelize
