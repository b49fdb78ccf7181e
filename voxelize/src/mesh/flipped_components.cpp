#include "flipped_components.h"

#include "../faces/closed_surface.h"
#include "../work/disjoint_sets.h"
#include "triangle_bvh.h"
#include "triangle_contact.h"

#include <bit>
#include <optional>
#include <unordered_set>

namespace voxrt::voxelize {
namespace {

constexpr uint32_t kNoComponent = 0xFFFF'FFFF, kNoVertex = 0xFFFF'FFFF;
constexpr size_t kFewComponents = 512; // up to so many are compared pair by pair
constexpr double kCracks = 1e-5;       // the share of openings in the area of a surface that rounding leaves open
constexpr size_t kBatch = 16;          // triangles per query

struct Component {
    std::vector<uint32_t> triangles, vertices;
    TriangleBox box;
    int128 volume6 = 0;
    bool capped = false;
    int orientation = 1; // -1: flipped
};

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
            Component& own = components_[component];
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
        for (const Component& component : components_) {
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
        for (const Component& component : components_) {
            in = in || (component.capped && component.volume6 < 0);
            out = out || component.volume6 > 0;
        }
        return in && out;
    }

    bool has_flat() const {
        return std::any_of(components_.begin(), components_.end(),
                           [](const Component& component) { return component.volume6 == 0; });
    }

    /// Decides the orientation of all components.
    void orient() {
        std::vector<std::pair<TriangleBox, uint32_t>> boxes;
        for (uint32_t i = 0; i < components_.size(); ++i)
            if (may_enclose(i))
                for (const uint32_t t : components_[i].triangles)
                    boxes.push_back({box_of(t), t});
        const TriangleBvh bvh(std::move(boxes));
        std::vector<uint32_t> order(components_.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        // A component comes after those that may enclose it.
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            const Component &p = components_[a], &q = components_[b];
            if (p.box.volume() != q.box.volume())
                return p.box.volume() > q.box.volume();
            const int128 u = p.volume6 < 0 ? -p.volume6 : p.volume6, v = q.volume6 < 0 ? -q.volume6 : q.volume6;
            return u != v ? u > v : a < b;
        });
        rank_.resize(components_.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            rank_[order[i]] = i;
        for (const uint32_t index : order) {
            Component& component = components_[index];
            if (component.capped)
                continue;
            int number = 0;
            uint32_t nearest = kNoComponent;
            for (const Enclosing& enclosing : find_enclosing(index, bvh)) {
                number += enclosing.winding * components_[enclosing.component].orientation;
                if (nearest == kNoComponent || rank_[enclosing.component] > rank_[nearest])
                    nearest = enclosing.component;
            }
            component.orientation = number != 0 ? components_[nearest].orientation : component.volume6 < 0 ? -1 : 1;
        }
    }

    /// The orientation with those components flipped; null where none is, or all are.
    std::shared_ptr<const Orientation> flipped() const {
        auto found =
            orientation_ != nullptr ? std::make_shared<Orientation>(*orientation_) : std::make_shared<Orientation>();
        for (const Component& component : components_)
            found->components += component.orientation < 0;
        if (found->components == 0 || found->components == components_.size())
            return nullptr;
        found->faces.resize(mesh_.triangle_count());
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            if (is_closed_part(t) && components_[component_of_[t]].orientation < 0)
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
        for (const Component& component : components_)
            if (component.orientation < 0)
                for (const uint32_t v : component.vertices)
                    flipped.insert(vertex_key(vertices_[v]));
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            if (orientation.is_uncounted(t)) {
                const Corners c = corners(t);
                if (std::all_of(c.begin(), c.end(),
                                [&](uint32_t v) { return flipped.contains(vertex_key(vertices_[v])); }))
                    orientation.faces[t] ^= Orientation::kReversed;
            }
    }

    /// A component that lies around another, and its winding number there before flipping.
    struct Enclosing {
        uint32_t component;
        int winding;
        bool touched;
    };

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
    /// False where the component's box contains no other component's box.
    bool may_enclose(uint32_t own) const {
        if (components_.size() > kFewComponents)
            return true;
        for (uint32_t i = 0; i < components_.size(); ++i)
            if (i != own && components_[own].box.contains(components_[i].box))
                return true;
        return false;
    }
    Vertex middle_of(const Corners& c) const {
        const auto middle = [&](int32_t Vertex::* axis) {
            return int32_t((int64_t(vertices_[c[0]].*axis) + vertices_[c[1]].*axis + vertices_[c[2]].*axis) / 3);
        };
        return {middle(&Vertex::x), middle(&Vertex::y), middle(&Vertex::z)};
    }
    TriangleBox box_of(uint32_t t) const {
        TriangleBox box;
        for (const uint32_t v : corners(t))
            box.add(vertices_[v]);
        return box;
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

    /// The winding numbers of larger components at a place, by the triangles above it. Of those that it touches the
    /// winding number is not known. `room`: 0 for a vertex, kNear for the middle of a triangle, which is rounded.
    std::vector<Enclosing> winding_at(uint32_t own, const Vertex& q, int room, const TriangleBvh& bvh) const {
        std::vector<Enclosing> found;
        auto at = [&](uint32_t component) -> Enclosing& {
            for (Enclosing& enclosing : found)
                if (enclosing.component == component)
                    return enclosing;
            return found.emplace_back(Enclosing{component, 0, false});
        };
        const TriangleBox above{{q.x - room, q.y - room, q.z - room}, {q.x + room, q.y + room, INT32_MAX}};
        bvh.find(above, [&](uint32_t t) {
            const uint32_t component = component_of_[t];
            if (component == kNoComponent || rank_[component] >= rank_[own])
                return;
            const Corners corner = corners(t);
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

    std::vector<Enclosing> find_enclosing(uint32_t own, const TriangleBvh& bvh) const {
        const Component& component = components_[own];
        std::vector<Enclosing> enclosing;
        const auto is_clear = [&] {
            return std::none_of(enclosing.begin(), enclosing.end(), [](const Enclosing& one) { return one.touched; });
        };
        for (const uint32_t vertex : component.vertices) {
            enclosing = winding_at(own, vertices_[vertex], 0, bvh);
            if (is_clear())
                break;
        }
        // All corners of a cavity may lie on other surface, where parts share edges.
        for (size_t i = 0; i < component.triangles.size() && !is_clear(); ++i)
            enclosing = winding_at(own, middle_of(corners(component.triangles[i])), kNear, bvh);
        std::erase_if(enclosing, [](const Enclosing& one) { return one.touched; });
        // A component whose surface is not near a triangle encloses all of it or none of it.
        std::vector<uint32_t> near;
        for (size_t from = 0; from < component.triangles.size() && !enclosing.empty(); from += kBatch) {
            const size_t to = std::min(from + kBatch, component.triangles.size());
            TriangleBox box;
            for (size_t i = from; i < to; ++i)
                box.add(box_of(component.triangles[i]));
            near.clear();
            bvh.find(box, [&](uint32_t t) {
                if (std::any_of(enclosing.begin(), enclosing.end(),
                                [&](const Enclosing& one) { return one.component == component_of_[t]; }))
                    near.push_back(t);
            });
            for (size_t i = from; i < to && !near.empty(); ++i)
                keep_enclosing(own, corners(component.triangles[i]), near, bvh, enclosing);
        }
        return enclosing;
    }

    /// Keeps the components that enclose a triangle as well.
    void keep_enclosing(uint32_t own, const Corners& c, const std::vector<uint32_t>& near, const TriangleBvh& bvh,
                        std::vector<Enclosing>& enclosing) const {
        std::array<std::vector<Enclosing>, 3> at;
        for (size_t i = 0; i < 3; ++i)
            at[i] = winding_at(own, vertices_[c[i]], 0, bvh);
        std::optional<std::vector<Enclosing>> at_middle;
        std::erase_if(enclosing, [&](const Enclosing& one) {
            size_t touched = 0;
            for (const std::vector<Enclosing>& here : at) {
                const auto other = std::find_if(here.begin(), here.end(), [&](const Enclosing& found) {
                    return found.component == one.component && (found.touched || found.winding == one.winding);
                });
                if (other == here.end())
                    return true;
                touched += other->touched;
            }
            if (touched < 3)
                return false;
            // What lies on the surface around it is no wall of a cavity.
            if (!at_middle)
                at_middle = winding_at(own, middle_of(c), kNear, bvh);
            return std::none_of(at_middle->begin(), at_middle->end(), [&](const Enclosing& found) {
                return found.component == one.component && !found.touched && found.winding == one.winding;
            });
        });
        TriangleBox box;
        for (const uint32_t v : c)
            box.add(vertices_[v]);
        for (const uint32_t t : near)
            if (box.overlaps(box_of(t)))
                std::erase_if(enclosing, [&](const Enclosing& one) {
                    return one.component == component_of_[t] && cross(c, corners(t));
                });
    }

    bool cross(const Corners& c, const Corners& d) const {
        auto at = [this](uint32_t v) -> const Vertex& { return vertices_[v]; };
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            if (passes(at(c[i]), at(c[j]), at(d[0]), at(d[1]), at(d[2])) ||
                passes(at(d[i]), at(d[j]), at(c[0]), at(c[1]), at(c[2])))
                return true;
        }
        return false;
    }

    const MeshView& mesh_;
    const std::vector<Vertex>& vertices_;
    const Orientation* orientation_;
    const HoleCaps* caps_;
    const Bodies* bodies_; // null where the surface is a manifold
    DisjointSets sets_;    // of vertices; of triangles where there are bodies
    bool is_one_;
    std::vector<uint32_t> component_of_; // by triangle
    std::vector<Component> components_;  // by first triangle
    std::vector<uint32_t> rank_;         // by component: larger ones first
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
