#include "orientation.h"

#include "closed_surface.h"
#include "edge_order.h"
#include "exact_predicates.h"
#include "patch_signs.h"
#include "sheets.h"

namespace voxrt::voxelize {
namespace {

using Uses = std::span<const EdgeUse>;

/// The sides of a face, as numbers.
constexpr uint32_t front(uint32_t face) { return 2 * face; }
constexpr uint32_t back(uint32_t face) { return 2 * face + 1; }

/// The sides of a face that one meets first, and last, walking around an edge counter-clockwise, seen against its
/// direction from low to high.
constexpr uint32_t first_side(const EdgeUse& use) { return use.is_upwards ? back(use.face) : front(use.face); }
constexpr uint32_t last_side(const EdgeUse& use) { return use.is_upwards ? front(use.face) : back(use.face); }

/// How many more faces walk an edge upwards.
int surplus_of(Uses uses) {
    int sum = 0;
    for (const EdgeUse& use : uses)
        sum += use.is_upwards ? 1 : -1;
    return sum;
}

/// Whether two faces meet at an edge, and walk it one way each.
bool is_pair(Uses uses) { return uses.size() == 2 && surplus_of(uses) == 0; }

/// Faces connected by edges.
struct Component {
    bool is_balanced = true;       // each edge is walked as often one way as the other, and no face contradicts another
    bool is_doubted = false;       // it may have two sides that are one
    bool is_two_sided = false;     // a face that is there once for each side parts inside from outside
    bool is_paired = true;         // each face is there as often for each side, and its pieces have two sides
    uint32_t outside = UINT32_MAX; // a cell
    int128 least = 0;              // its volume
    int64_t kept = 0, turned = 0;  // faces that part inside from outside: as authored, the other way around
    double enclosing_area = 0, loose_area = 0;
    bool is_settled() const { return outside != UINT32_MAX && kept + turned > 0 && (!is_balanced || is_two_sided); }
    /// Whether the file does not say which way its faces count.
    bool is_unsaid() const { return !is_balanced || is_paired; }
};

class Faces {
public:
    Faces(const MeshEdges& whole, const MeshEdges& edges, const Bodies& bodies, const std::vector<Vertex>& vertices,
          bool flat)
        : whole_(whole), edges_(edges), bodies_(bodies), at_(vertices), flat_(flat),
          count_(uint32_t(edges.face_count())), first_(bodies.first()) {
        component_of_.assign(count_, UINT32_MAX);
    }

    std::shared_ptr<const Orientation> orient() {
        find_components();
        find_repeated();
        join_sides();
        find_outsides();
        find_two_sided();
        tell_inside();
        auto found = std::make_shared<Orientation>();
        found->faces.assign(count_, 0);
        settle(*found);
        look(*found);
        turn_loose(*found);
        for (uint32_t f = 0; f < count_; ++f)
            if (first_[f] != f && is_ours(f) && changes(own(f))) {
                // The two faces of a sheet go on covering both layers beside a plane between voxels.
                const bool is_sheet = own(f).is_balanced && !own(f).is_settled();
                found->faces[f] =
                    uint8_t(Orientation::kUncounted | Orientation::kSettled | (is_sheet ? 0 : Orientation::kRepeated) |
                            (found->is_reversed(first_[f]) != (opposed_[f] && !is_sheet) ? Orientation::kReversed : 0));
            }
        const bool any =
            std::any_of(found->faces.begin(), found->faces.end(), [](uint8_t state) { return state != 0; });
        return any || found->one_sided > 0 || found->unsure > 0 ? found : nullptr;
    }

private:
    /// Finds the components that are not wound consistently or have repeated faces.
    void find_components() {
        bodies_.each_edge(edges_, [&](uint32_t, Uses uses) {
            const bool balanced = uses.size() == 1 || surplus_of(uses) == 0;
            if (!balanced || uses.size() > 2) {
                Component& component = found_at(uses[0].face);
                component.is_balanced &= balanced;
                component.is_doubted |= flat_;
            }
        });
        whole_.each([&](uint32_t, Uses uses) {
            each_repeated(uses, sorted_,
                          [&](const EdgeUse& first, const EdgeUse&) { found_at(first.face).is_doubted = true; });
        });
    }
    Component& found_at(uint32_t face) {
        uint32_t& index = component_of_[bodies_.of(face)];
        if (index == UINT32_MAX) {
            index = uint32_t(components_.size());
            components_.emplace_back();
        }
        return components_[index];
    }
    bool is_ours(uint32_t face) { return component_of_[bodies_.of(face)] != UINT32_MAX; }
    Component& own(uint32_t face) { return components_[component_of_[bodies_.of(face)]]; }
    static bool changes(const Component& component) { return component.is_settled() || component.is_unsaid(); }

    /// Whether faces are wound against the first ones with the same corners.
    void find_repeated() {
        std::vector<bool> is_known(count_, false);
        opposed_.assign(count_, false);
        surplus_.assign(count_, 1);
        whole_.each([&](uint32_t, Uses uses) {
            each_repeated(uses, sorted_, [&](const EdgeUse& first, const EdgeUse& again) {
                if (is_known[again.face])
                    return;
                is_known[again.face] = true;
                opposed_[again.face] = first.is_upwards != again.is_upwards;
                surplus_[first.face] += opposed_[again.face] ? -1 : 1;
            });
        });
    }

    /// The faces at an edge without repeated ones.
    const std::vector<EdgeUse>& once_of(Uses uses) {
        once_.clear();
        for (const EdgeUse& use : uses)
            if (first_[use.face] == use.face)
                once_.push_back(use);
        return once_;
    }

    /// Calls visit(low, uses) for the edges of our components, without repeated faces.
    template <class Visit> void each_edge(Visit&& visit) {
        bodies_.each_edge(edges_, [&](uint32_t low, Uses uses) {
            if (is_ours(uses[0].face))
                visit(low, once_of(uses));
        });
    }

    /// Joins the sides of faces around edges: around edges of two faces to the sides of pieces, around all to cells.
    void join_sides() {
        pieces_ = DisjointSets(2 * size_t(count_));
        cells_ = DisjointSets(2 * size_t(count_));
        Sheets sheets(edges_, at_, [this](auto&& visit) { each_edge(visit); });
        each_edge([&](uint32_t low, std::vector<EdgeUse> once) {
            if (once.size() > 2)
                sort_about_edge(low, once, at_, [&](uint32_t face) { return sheets.rank_of(face); });
            for (size_t i = 0; i < once.size(); ++i) {
                const EdgeUse& next = once[(i + 1) % once.size()];
                cells_.merge(last_side(once[i]), first_side(next));
                if (once.size() == 2)
                    pieces_.merge(last_side(once[i]), first_side(next));
            }
        });
    }

    /// Finds the cell of least volume in each component.
    void find_outsides() {
        volumes_.assign(2 * size_t(count_), 0);
        each_first([&](uint32_t f, Component&) {
            const Corners c = edges_.corners(f), origin = edges_.corners(bodies_.of(f));
            const int128 volume = volume6_of(at_[c[0]], at_[c[1]], at_[c[2]], at_[origin[0]]);
            volumes_[cells_.find(back(f))] += volume;
            volumes_[cells_.find(front(f))] -= volume;
        });
        each_first([&](uint32_t f, Component& component) {
            for (const uint32_t cell : {cells_.find(front(f)), cells_.find(back(f))})
                if (volumes_[cell] < component.least) {
                    component.least = volumes_[cell];
                    component.outside = cell;
                }
        });
    }

    /// Finds components that are there once for each side as a whole; and those whose outside and inside are parted by
    /// faces that are: equal ones, or such that hold a cell without volume between them.
    void find_two_sided() {
        enum : uint8_t { kTouchesOutside = 1, kTouchesInside = 2, kBoth = 3 };
        std::vector<uint8_t> touches(2 * size_t(count_), 0);
        each_first([&](uint32_t f, Component& component) {
            component.is_paired &=
                component.is_doubted && surplus_[f] == 0 && pieces_.find(front(f)) != pieces_.find(back(f));
            const uint32_t cells[2] = {cells_.find(front(f)), cells_.find(back(f))};
            if (!component.is_doubted)
                return;
            for (int i = 0; i < 2; ++i) {
                const uint32_t own = cells[i], other = cells[1 - i];
                if (other == component.outside) {
                    component.is_two_sided |= volumes_[own] > 0 && surplus_[f] == 0;
                    touches[own] |= kTouchesOutside;
                } else if (volumes_[other] > 0) {
                    touches[own] |= kTouchesInside;
                }
                component.is_two_sided |= volumes_[own] == 0 && touches[own] == kBoth;
            }
        });
    }

    /// Counts the faces that part inside from outside, and the areas of those that touch the inside or do not.
    void tell_inside() {
        each_first([&](uint32_t f, Component& component) {
            const double area = area_of(f);
            const bool in_front = is_inside(front(f), component), behind = is_inside(back(f), component);
            (in_front || behind ? component.enclosing_area : component.loose_area) += area;
            component.kept += behind && !in_front;
            component.turned += in_front && !behind;
        });
    }

    /// Faces of components that enclose something.
    void settle(Orientation& found) {
        each_first([&](uint32_t f, Component& component) {
            if (!component.is_settled())
                return;
            const bool in_front = is_inside(front(f), component), behind = is_inside(back(f), component);
            // It may be the wall of a cavity where the file clearly says so.
            const bool inwards = component.turned > 2 * component.kept;
            bool reversed = in_front != inwards;
            uint8_t state = Orientation::kSettled;
            if (in_front != behind) {
                found.turned += reversed;
            } else if (in_front || component.loose_area < component.enclosing_area) {
                // Of two faces upon one another both cover the layer within.
                const bool flat_behind = volumes_[cells_.find(back(f))] == 0;
                reversed = (flat_behind || volumes_[cells_.find(front(f))] == 0) && flat_behind != inwards;
                state |= Orientation::kUncounted;
            } else {
                return;
            }
            found.faces[f] = uint8_t(state | (reversed ? Orientation::kReversed : 0));
        });
    }

    /// Corrects components of several patches that do not count as one sees them from outside.
    void look(Orientation& found) {
        std::vector<BodyPatches> bodies;
        for (const Component& component : components_)
            bodies.emplace_back(component.is_balanced && (component.kept > 0) != (component.turned > 0));
        const auto patches_of = [&](const Component& component) -> BodyPatches& {
            return bodies[size_t(&component - components_.data())];
        };
        each_first([&](uint32_t f, Component& component) {
            const Corners c = edges_.corners(f);
            const uint32_t ahead = pieces_.find(front(f)), behind = pieces_.find(back(f));
            if (ahead == behind)
                patches_of(component).leave_out(); // it has one side only
            patches_of(component).add({f,
                                       std::min(ahead, behind),
                                       ahead < behind ? 1 : -1,
                                       counted(f, found),
                                       {at_[c[0]], at_[c[1]], at_[c[2]]}});
        });
        each_edge([&](uint32_t, const std::vector<EdgeUse>& uses) {
            const Component& component = own(uses[0].face);
            if (uses.size() == 1 && !component.is_settled())
                patches_of(component).leave_out(); // open, and wound as the file says
            else if (uses.size() != 2)
                patches_of(component).add_edge(uses);
        });
        for (size_t i = 0; i < bodies.size(); ++i) {
            const PatchSigns signs = bodies[i].look();
            found.unsure += !signs.are_sure;
            for (const auto& [f, sign] : signs.by_face) {
                found.turned += (sign < 0) - (found.is_reversed(f) && !found.is_uncounted(f));
                found.faces[f] = uint8_t(Orientation::kSettled | (sign == 0 ? Orientation::kUncounted : 0) |
                                         (sign < 0 ? Orientation::kReversed : 0));
                components_[i].is_balanced = false;
                components_[i].kept = 1;
            }
        }
    }

    /// How often a face counts as authored; less where it counts the other way around.
    int counted(uint32_t f, const Orientation& found) const {
        return found.faces[f] == 0 ? surplus_[f] : found.is_uncounted(f) ? 0 : found.is_reversed(f) ? -1 : 1;
    }

    /// Turns the faces of the other pieces as most of each are.
    void turn_loose(Orientation& found) {
        std::vector<uint32_t> fronts(2 * size_t(count_), 0); // by side of a piece
        const auto is_loose = [&](uint32_t f, const Component& component) {
            return found.faces[f] == 0 && component.is_unsaid();
        };
        each_first([&](uint32_t f, Component& component) {
            if (is_loose(f, component))
                ++fronts[pieces_.find(front(f))];
        });
        std::vector<uint32_t> reversed;
        each_first([&](uint32_t f, Component& component) {
            if (!is_loose(f, component))
                return;
            const uint32_t own = pieces_.find(front(f)), other = pieces_.find(back(f));
            if (own == other) {
                found.one_sided += own == front(f);
            } else if (fronts[own] < fronts[other] || (fronts[own] == fronts[other] && own > other)) {
                reversed.push_back(f);
                found.turned += !component.is_balanced;
            }
        });
        for (const uint32_t f : reversed)
            found.faces[f] = Orientation::kReversed;
    }

    bool is_inside(uint32_t side, const Component& component) { return cells_.find(side) != component.outside; }

    /// Calls visit(face, component) for the faces of our components, those with edges, each once.
    template <class Visit> void each_first(Visit&& visit) {
        for (uint32_t f = 0; f < count_; ++f)
            if (is_ours(f) && first_[f] == f) {
                count_work(5);
                visit(f, own(f));
            }
    }

    /// Twice the area of a face.
    double area_of(uint32_t face) const {
        const Corners corners = edges_.corners(face);
        const Vertex &a = at_[corners[0]], &b = at_[corners[1]], &c = at_[corners[2]];
        const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
        const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
        return std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
    }

    const MeshEdges &whole_, &edges_;
    const Bodies& bodies_;
    const std::vector<Vertex>& at_;
    bool flat_;
    uint32_t count_;
    std::vector<uint32_t> component_of_; // by the first face of a component; UINT32_MAX where all is consistent
    std::vector<Component> components_;
    const std::vector<uint32_t>& first_;
    std::vector<bool> opposed_;
    std::vector<EdgeUse> sorted_;
    std::vector<int> surplus_; // of a face and those equal to it: how many more face as it does
    DisjointSets pieces_{0}, cells_{0};
    std::vector<int128> volumes_; // of cells, by side
    std::vector<EdgeUse> once_;
};

} // namespace

std::shared_ptr<const Orientation> find_orientation(const MeshEdges& whole, const MeshEdges& edges,
                                                    const Bodies& bodies, const std::vector<Vertex>& vertices,
                                                    bool flat) {
    bool consistent = true;
    bodies.each_edge(edges,
                     [&](uint32_t, Uses uses) { consistent = consistent && (uses.size() == 1 || is_pair(uses)); });
    for (uint32_t f = 0; f < edges.face_count(); ++f)
        consistent = consistent && bodies.first()[f] == f;
    return consistent ? nullptr : Faces(whole, edges, bodies, vertices, flat).orient();
}

} // namespace voxrt::voxelize
