#include "enclosing_components.h"

#include "triangle_contact.h"

#include <iterator>

namespace voxrt::voxelize {
namespace {

constexpr uint32_t kNoComponent = 0xFFFF'FFFF;
constexpr size_t kFewComponents = 512; // up to so many are compared pair by pair
constexpr size_t kBatch = 16;          // triangles per query

const Enclosing* find_component(const std::vector<Enclosing>& found, uint32_t component) {
    const auto at =
        std::find_if(found.begin(), found.end(), [&](const Enclosing& one) { return one.component == component; });
    return at == found.end() ? nullptr : &*at;
}

} // namespace

EnclosingComponents::EnclosingComponents(const std::vector<Vertex>& vertices, std::vector<Corners> corners,
                                         const std::vector<ClosedComponent>& components)
    : vertices_(vertices), corners_(std::move(corners)), components_(components),
      component_of_(corners_.size(), kNoComponent), order_(components.size()), rank_(components.size()) {
    std::vector<std::pair<TriangleBox, uint32_t>> boxes;
    for (uint32_t i = 0; i < components_.size(); ++i) {
        const bool may = may_enclose(i);
        for (const uint32_t t : components_[i].triangles) {
            component_of_[t] = i;
            if (may)
                boxes.push_back({box_of(t), t});
        }
        order_[i] = i;
    }
    bvh_.emplace(std::move(boxes));
    std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
        const ClosedComponent &p = components_[a], &q = components_[b];
        if (p.box.volume() != q.box.volume())
            return p.box.volume() > q.box.volume();
        const int128 u = p.volume6 < 0 ? -p.volume6 : p.volume6, v = q.volume6 < 0 ? -q.volume6 : q.volume6;
        return u != v ? u > v : a < b;
    });
    for (uint32_t i = 0; i < order_.size(); ++i)
        rank_[order_[i]] = i;
}

std::vector<Enclosing> EnclosingComponents::find(uint32_t own) const {
    const ClosedComponent& component = components_[own];
    std::vector<Enclosing> enclosing;
    const auto is_clear = [&] {
        return std::none_of(enclosing.begin(), enclosing.end(), [](const Enclosing& one) { return one.touched; });
    };
    for (const uint32_t vertex : component.vertices) {
        enclosing = winding_at(own, vertices_[vertex], 0);
        if (is_clear())
            break;
    }
    // All corners of a cavity may lie on other surface, where parts share edges.
    for (size_t i = 0; i < component.triangles.size() && !is_clear(); ++i)
        enclosing = winding_at(own, middle_of(component.triangles[i]), kNear);
    std::erase_if(enclosing, [](const Enclosing& one) { return one.touched; });
    // A component whose surface is not near a triangle encloses all of it or none of it.
    std::vector<uint32_t> near_batch, near;
    for (size_t from = 0; from < component.triangles.size() && !enclosing.empty(); from += kBatch) {
        const size_t to = std::min(from + kBatch, component.triangles.size());
        TriangleBox box;
        for (size_t i = from; i < to; ++i)
            box.add(box_of(component.triangles[i]));
        near_batch.clear();
        bvh_->find(box, [&](uint32_t t) {
            if (find_component(enclosing, component_of_[t]) != nullptr)
                near_batch.push_back(t);
        });
        for (size_t i = from; i < to && !near_batch.empty(); ++i) {
            const TriangleBox own_box = box_of(component.triangles[i]);
            near.clear();
            std::copy_if(near_batch.begin(), near_batch.end(), std::back_inserter(near),
                         [&](uint32_t t) { return own_box.overlaps(box_of(t)); });
            if (!near.empty())
                keep_enclosing(own, component.triangles[i], near, enclosing);
        }
    }
    std::sort(enclosing.begin(), enclosing.end(),
              [&](const Enclosing& a, const Enclosing& b) { return rank_[a.component] < rank_[b.component]; });
    return enclosing;
}

TriangleBox EnclosingComponents::box_of(uint32_t t) const {
    TriangleBox box;
    for (const uint32_t v : corners_[t])
        box.add(vertices_[v]);
    return box;
}

/// False where the component's box contains no other component's box.
bool EnclosingComponents::may_enclose(uint32_t component) const {
    if (components_.size() > kFewComponents)
        return true;
    for (uint32_t i = 0; i < components_.size(); ++i)
        if (i != component && components_[component].box.contains(components_[i].box))
            return true;
    return false;
}

/// Rounded to the lattice.
Vertex EnclosingComponents::middle_of(uint32_t t) const {
    const auto& [a, b, c] = corners_[t];
    const auto mean = [&](int32_t Vertex::* axis) {
        return int32_t((int64_t(vertices_[a].*axis) + vertices_[b].*axis + vertices_[c].*axis) / 3);
    };
    return {mean(&Vertex::x), mean(&Vertex::y), mean(&Vertex::z)};
}

/// The winding numbers of larger components at a place, by the triangles above it. Of those that it touches the winding
/// number is not known. `room`: 0 for a vertex, kNear for the middle of a triangle.
std::vector<Enclosing> EnclosingComponents::winding_at(uint32_t own, const Vertex& q, int room) const {
    std::vector<Enclosing> found;
    auto at = [&](uint32_t component) -> Enclosing& {
        for (Enclosing& enclosing : found)
            if (enclosing.component == component)
                return enclosing;
        return found.emplace_back(Enclosing{component, 0, false});
    };
    const TriangleBox above{{q.x - room, q.y - room, q.z - room}, {q.x + room, q.y + room, INT32_MAX}};
    bvh_->find(above, [&](uint32_t t) {
        const uint32_t component = component_of_[t];
        if (rank_[component] >= rank_[own])
            return;
        const Corners corner = corners_[t];
        const Vertex &a = vertices_[corner[0]], &b = vertices_[corner[1]], &c = vertices_[corner[2]];
        const int height = sign_of(volume6_of(a, b, c, q));
        if (room > 0 && is_near(a, b, c, q)) {
            at(component).touched = true;
            return;
        }
        if (height == 0) {
            if (std::min({a.z, b.z, c.z}) <= q.z && is_on(a, b, c, q))
                at(component).touched = true;
            return;
        }
        const int side = side_of(a, b, q);
        if (side != 0 && side_of(b, c, q) == side && side_of(c, a, q) == side && height == side)
            at(component).winding += side;
    });
    std::erase_if(found, [](const Enclosing& enclosing) { return !enclosing.touched && enclosing.winding == 0; });
    return found;
}

/// Keeps the components that enclose a triangle as well.
void EnclosingComponents::keep_enclosing(uint32_t own, uint32_t t, const std::vector<uint32_t>& near,
                                         std::vector<Enclosing>& enclosing) const {
    std::array<std::vector<Enclosing>, 3> at;
    for (size_t i = 0; i < 3; ++i)
        at[i] = winding_at(own, vertices_[corners_[t][i]], 0);
    std::optional<std::vector<Enclosing>> at_middle;
    std::erase_if(enclosing, [&](const Enclosing& one) {
        int touched = 0;
        for (const std::vector<Enclosing>& here : at) {
            const Enclosing* found = find_component(here, one.component);
            if (found == nullptr || !(found->touched || found->winding == one.winding))
                return true;
            touched += found->touched;
        }
        if (touched < 3)
            return false;
        if (!at_middle)
            at_middle = winding_at(own, middle_of(t), kNear);
        const Enclosing* found = find_component(*at_middle, one.component);
        return found == nullptr || !(found->touched || found->winding == one.winding);
    });
    std::erase_if(enclosing, [&](const Enclosing& one) { return crosses(one.component, t, near); });
}

/// Whether a component's surface meets the interior of a triangle from both sides, or lies along it.
bool EnclosingComponents::crosses(uint32_t component, uint32_t t, const std::vector<uint32_t>& near) const {
    const auto vertices_of = [&](uint32_t triangle) {
        const Corners& c = corners_[triangle];
        return Triangle{vertices_[c[0]], vertices_[c[1]], vertices_[c[2]]};
    };
    Sides sides;
    for (const uint32_t other : near)
        if (component_of_[other] == component)
            sides.add(sides_of_contact(vertices_of(t), vertices_of(other)));
    return sides.above && sides.below;
}

} // namespace voxrt::voxelize
