#include "flipped_components.h"

#include "../faces/closed_surface.h"
#include "../faces/exact_predicates.h"
#include "../work/disjoint_sets.h"
#include "enclosing_components.h"

#include <bit>
#include <unordered_set>

namespace voxrt::voxelize {
namespace {

constexpr uint32_t kNoComponent = 0xFFFF'FFFF, kNoVertex = 0xFFFF'FFFF;
constexpr double kCracks = 1e-5; // the share of openings in the area of a surface that rounding leaves open

/// A surface and what closes it, as connected components.
class ClosedComponents {
public:
    ClosedComponents(const MeshView& mesh, const std::vector<Vertex>& vertices, const Orientation* orientation,
                     const HoleCaps* caps, const MeshEdges* edges, const Bodies* bodies)
        : mesh_(mesh), vertices_(vertices), orientation_(orientation), caps_(caps), bodies_(bodies),
          sets_(bodies != nullptr ? count() : vertices.size()) {
        if (bodies != nullptr)
            join_bodies(*edges);
        else
            join_at_vertices();
    }

    /// Whether there is a single component, vertices that no triangle uses left out.
    bool is_one() const { return is_one_; }

    /// Finds the components.
    void split() {
        if (bodies_ == nullptr)
            weld();
        std::vector<uint32_t> component_at(std::max(vertices_.size(), count()), kNoComponent);
        std::vector<uint32_t> seen(vertices_.size(), kNoComponent);
        component_of_.assign(count(), kNoComponent);
        for (size_t t = 0; t < count(); ++t) {
            if (!is_closed_part(t))
                continue;
            count_work(5);
            const Corners c = corners(t);
            uint32_t& component = component_at[sets_.find(bodies_ != nullptr ? uint32_t(t) : c[0])];
            if (component == kNoComponent) {
                component = uint32_t(components_.size());
                components_.emplace_back();
            }
            component_of_[t] = component;
            ClosedComponent& own = components_[component];
            own.capped = own.capped || !is_of_body(t);
            for (const uint32_t v : c) {
                own.box.add(vertices_[v]);
                if (seen[v] != component)
                    own.vertices.push_back(v);
                seen[v] = component;
            }
            own.triangles.push_back(uint32_t(t));
            own.volume6 += volume6_of(vertices_[c[0]], vertices_[c[1]], vertices_[c[2]], vertices_[own.vertices[0]]);
        }
    }

    /// Whether some component faces inwards and may be flipped, while others face outwards.
    bool are_mixed() const {
        bool in = false, out = false;
        for (const ClosedComponent& component : components_) {
            if (component.capped && component.volume6 < 0)
                return false;
            in = in || component.volume6 < 0;
            out = out || component.volume6 > 0 || component.capped;
        }
        return in && out;
    }

    /// Whether one that all but closes faces inwards beside others that face outwards.
    bool are_unsure() const {
        if (caps_ == nullptr || !caps_->shell_only.empty() || caps_->opening > kCracks)
            return false;
        bool in = false, out = false;
        for (const ClosedComponent& component : components_) {
            in = in || (component.capped && component.volume6 < 0);
            out = out || component.volume6 > 0;
        }
        return in && out;
    }

    bool has_flat() const {
        return std::any_of(components_.begin(), components_.end(),
                           [](const ClosedComponent& component) { return component.volume6 == 0; });
    }

    /// Decides the orientation of all components.
    void orient() {
        std::vector<Corners> surface(count());
        for (size_t t = 0; t < count(); ++t)
            if (is_closed_part(t))
                surface[t] = corners(t);
        const EnclosingComponents enclosing(vertices_, std::move(surface), components_);
        orientations_.assign(components_.size(), 1);
        // A component comes after those that may enclose it.
        for (const uint32_t index : enclosing.order()) {
            const ClosedComponent& component = components_[index];
            if (component.capped)
                continue;
            int number = 0, nearest = 0;                         // its orientation
            for (const Enclosing& one : enclosing.find(index)) { // larger ones first
                nearest = orientations_[one.component];
                number += one.winding * nearest;
            }
            orientations_[index] = number != 0 ? nearest : component.volume6 < 0 ? -1 : 1;
        }
    }

    /// The orientation with those components flipped; null where none is, or all are.
    std::shared_ptr<const Orientation> flipped() const {
        auto found =
            orientation_ != nullptr ? std::make_shared<Orientation>(*orientation_) : std::make_shared<Orientation>();
        for (const int orientation : orientations_)
            found->components += orientation < 0;
        if (found->components == 0 || found->components == components_.size())
            return nullptr;
        found->faces.resize(mesh_.triangle_count());
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            if (is_closed_part(t) && orientations_[component_of_[t]] < 0)
                found->faces[t] ^= Orientation::kReversed;
        if (orientation_ != nullptr)
            flip_uncounted(*found);
        return found;
    }

private:
    void join_at_vertices() {
        size_t joins = 0;
        for (size_t t = 0; t < count(); ++t)
            if (is_closed_part(t)) {
                count_work(1);
                const Corners c = corners(t);
                joins += sets_.merge(c[0], c[1]);
                joins += sets_.merge(c[0], c[2]);
            }
        is_one_ = joins + 1 >= vertices_.size();
    }
    /// Bodies that close stay apart where they touch others; what remains is joined at vertices.
    void join_bodies(const MeshEdges& edges) {
        size_t joins = 0, faces = 0;
        bodies_->each_edge(edges, [&](uint32_t, std::span<const EdgeUse> uses) {
            uint32_t last = kNoComponent;
            for (const EdgeUse& use : uses)
                if (is_closed_part(use.face)) {
                    joins += last != kNoComponent && sets_.merge(last, use.face);
                    last = use.face;
                }
        });
        std::vector<uint32_t> at(vertices_.size(), kNoComponent); // a triangle at each vertex
        for (size_t t = 0; t < count(); ++t)
            if (is_closed_part(t)) {
                ++faces;
                for (const uint32_t v : t < mesh_.triangle_count() ? edges.corners(t) : corners(t)) {
                    if (is_of_body(t))
                        continue;
                    joins += at[v] != kNoComponent && sets_.merge(at[v], uint32_t(t));
                    at[v] = uint32_t(t);
                }
            }
        is_one_ = joins + 1 >= faces;
    }

    /// Flips faces that do not count with the components on which they lie.
    void flip_uncounted(Orientation& orientation) const {
        std::unordered_set<uint64_t> flipped; // positions
        for (size_t i = 0; i < components_.size(); ++i)
            if (orientations_[i] < 0)
                for (const uint32_t v : components_[i].vertices)
                    flipped.insert(vertex_key(vertices_[v]));
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            if (orientation.is_uncounted(t)) {
                const Corners c = corners(t);
                if (std::all_of(c.begin(), c.end(),
                                [&](uint32_t v) { return flipped.contains(vertex_key(vertices_[v])); }))
                    orientation.faces[t] ^= Orientation::kReversed;
            }
    }

    size_t count() const { return mesh_.triangle_count() + (caps_ != nullptr ? caps_->triangles.size() : 0); }
    /// Whether a triangle belongs to what closes: not to an open component.
    bool is_closed_part(size_t t) const {
        if (t >= mesh_.triangle_count())
            return t - mesh_.triangle_count() >= caps_->seams; // those have no area
        return (orientation_ == nullptr || !orientation_->is_uncounted(t)) &&
               (caps_ == nullptr || caps_->shell_only.empty() || caps_->shell_only[t] == 0);
    }
    /// Whether a triangle is of a body that closes without caps.
    bool is_of_body(size_t t) const {
        return bodies_ == nullptr || (t < mesh_.triangle_count() && bodies_->closes(uint32_t(t)));
    }
    Corners corners(size_t t) const {
        if (t >= mesh_.triangle_count())
            return caps_->triangles[t - mesh_.triangle_count()];
        const int32_t* c = mesh_.triangles.data() + 3 * t;
        const Corners corners{uint32_t(c[0]), uint32_t(c[1]), uint32_t(c[2])};
        return orientation_ != nullptr ? orientation_->turned_corners(t, corners) : corners;
    }
    /// Merges vertices at one position, where the surface does not close by its indices.
    void weld() {
        std::vector<uint64_t> sums(vertices_.size(), 0);
        for (size_t t = 0; t < mesh_.triangle_count(); ++t) {
            if (!is_closed_part(t))
                continue;
            count_work(5);
            const auto [a, b, c] = corners(t);
            sums[sets_.find(a)] +=
                boundary_key(vertex_key(vertices_[a]), vertex_key(vertices_[b]), vertex_key(vertices_[c]));
        }
        std::vector<uint32_t> loose;
        for (uint32_t v = 0; v < vertices_.size(); ++v)
            if (sums[sets_.find(v)] != 0)
                loose.push_back(v);
        std::vector<uint32_t> first(std::bit_ceil(2 * loose.size() + 1), kNoVertex); // by hash, then the next place
        for (const uint32_t v : loose) {
            count_work(5);
            size_t place = vertex_key(vertices_[v]) & (first.size() - 1);
            while (first[place] != kNoVertex && !(vertices_[first[place]] == vertices_[v]))
                place = (place + 1) & (first.size() - 1);
            if (first[place] == kNoVertex)
                first[place] = v;
            else
                sets_.merge(first[place], v);
        }
    }

    const MeshView& mesh_;
    const std::vector<Vertex>& vertices_;
    const Orientation* orientation_;
    const HoleCaps* caps_;
    const Bodies* bodies_; // null where the surface is a manifold
    DisjointSets sets_;    // of vertices; of triangles where there are bodies
    bool is_one_;
    std::vector<uint32_t> component_of_;      // by triangle
    std::vector<ClosedComponent> components_; // by first triangle
    std::vector<int> orientations_;           // by component; -1: flipped
};

} // namespace

FlippedComponents flip_components(const MeshView& mesh, const std::vector<Vertex>& vertices,
                                  std::shared_ptr<const Orientation> orientation, const HoleCaps* caps,
                                  const MeshEdges* edges, const Bodies* bodies) {
    ClosedComponents components(mesh, vertices, orientation.get(), caps, edges, bodies);
    if (components.is_one())
        return {orientation, false};
    components.split();
    const bool has_flat = components.has_flat();
    if (components.are_unsure()) {
        auto unsure = orientation ? std::make_shared<Orientation>(*orientation) : std::make_shared<Orientation>();
        unsure->faces.resize(mesh.triangle_count());
        ++unsure->unsure;
        return {std::move(unsure), has_flat};
    }
    if (!components.are_mixed())
        return {orientation, has_flat};
    components.orient();
    auto flipped = components.flipped();
    return {flipped ? flipped : orientation, has_flat};
}

} // namespace voxrt::voxelize
