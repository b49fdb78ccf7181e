#include "orientation.h"

#include "../work/disjoint_sets.h"
#include "closed_surface.h"
#include "edge_order.h"
#include "exact_predicates.h"
#include "patches.h"
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

/// Calls visit(first, again) for each face at an edge that has the corners of an earlier one.
template <class Visit> void each_repeated(Uses uses, std::vector<EdgeUse>& sorted, Visit&& visit) {
    if (uses.size() < 2 || (uses.size() == 2 && uses[0].opposite != uses[1].opposite))
        return;
    sorted.assign(uses.begin(), uses.end());
    std::sort(sorted.begin(), sorted.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return a.opposite != b.opposite ? a.opposite < b.opposite : a.face < b.face;
    });
    for (size_t i = 1, first = 0; i < sorted.size(); ++i)
        if (sorted[i].opposite == sorted[first].opposite)
            visit(sorted[first], sorted[i]);
        else
            first = i;
}

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
    bool in_front_of_it = false;   // faces that have the outside in front of them, as authored
    bool behind_it = false;        // and behind
    bool contradicts = false;      // it has both, though it is balanced
    bool is_two_sided = false;     // a face that is there once for each side parts inside from outside
    bool is_paired = true;         // each face is there as often for each side, and its pieces have two sides
    uint32_t outside = UINT32_MAX; // a cell
    int128 least = 0;              // its volume
    int128 authored = 0;           // the signed volume that the file says
    int64_t kept = 0, turned = 0;  // faces that part inside from outside: as authored, the other way around
    double enclosing_area = 0, loose_area = 0;
    bool is_settled() const { return outside != UINT32_MAX && kept + turned > 0 && (!is_balanced || is_two_sided); }
    /// Whether the file does not say which way its faces count.
    bool is_unsaid() const { return !is_balanced || is_paired; }
};

class Faces {
public:
    Faces(const MeshEdges& whole, const MeshEdges& edges, const std::vector<Vertex>& vertices, bool flat)
        : whole_(whole), edges_(edges), at_(vertices), flat_(flat), count_(uint32_t(edges.face_count())),
          connected_(count_) {
        edges_.each([&](uint32_t, Uses uses) {
            for (const EdgeUse& use : uses)
                connected_.merge(use.face, uses[0].face);
        });
        component_of_.assign(count_, UINT32_MAX);
    }

    std::shared_ptr<const Orientation> orient() {
        find_components();
        find_repeated();
        join_sides();
        find_outsides();
        find_contradictions();
        find_voids();
        find_two_sided();
        tell_inside();
        auto found = std::make_shared<Orientation>();
        found->faces.assign(count_, 0);
        settle(*found);
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
        return any || found->one_sided > 0 ? found : nullptr;
    }

private:
    /// Finds the components that are not wound consistently or have repeated faces.
    void find_components() {
        edges_.each([&](uint32_t, Uses uses) {
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
        uint32_t& index = component_of_[connected_.find(face)];
        if (index == UINT32_MAX) {
            index = uint32_t(components_.size());
            components_.emplace_back();
        }
        return components_[index];
    }
    bool is_ours(uint32_t face) { return component_of_[connected_.find(face)] != UINT32_MAX; }
    Component& own(uint32_t face) { return components_[component_of_[connected_.find(face)]]; }
    static bool changes(const Component& component) { return component.is_settled() || component.is_unsaid(); }

    /// For each face the first one with the same corners, and whether that one is wound the other way.
    void find_repeated() {
        first_.resize(count_);
        std::iota(first_.begin(), first_.end(), 0u);
        opposed_.assign(count_, false);
        surplus_.assign(count_, 1);
        whole_.each([&](uint32_t, Uses uses) {
            each_repeated(uses, sorted_, [&](const EdgeUse& first, const EdgeUse& again) {
                if (first_[again.face] != again.face)
                    return;
                first_[again.face] = first.face;
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
        edges_.each([&](uint32_t low, Uses uses) {
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
        each_first([&](uint32_t f, Component& component) {
            const Corners c = edges_.corners(f), origin = edges_.corners(connected_.find(f));
            const int128 volume = volume6_of(at_[c[0]], at_[c[1]], at_[c[2]], at_[origin[0]]);
            component.authored += surplus_[f] * volume;
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

    /// Finds balanced components of which some faces have the outside in front of them, and others have it behind:
    /// parts that meet at edges, of which some are inside out.
    void find_contradictions() {
        is_void_.assign(2 * size_t(count_), false);
        each_first([&](uint32_t f, Component& component) {
            const bool outside_in_front = !is_inside(front(f), component);
            if (surplus_[f] == 0 || outside_in_front != is_inside(back(f), component))
                return;
            (outside_in_front == (surplus_[f] > 0) ? component.in_front_of_it : component.behind_it) = true;
        });
        // Where all parts face outwards, the file says no less volume than the cells of the inside have.
        for (Component& c : components_)
            c.contradicts =
                c.is_balanced && c.in_front_of_it && c.behind_it && c.authored < -c.least - (-c.least >> 20);
        if (std::any_of(components_.begin(), components_.end(), [](const Component& c) { return c.contradicts; }))
            deny_contradictions();
        for (Component& component : components_)
            component.is_balanced &= !component.contradicts;
    }

    /// Rounding may put faces at an edge in a wrong order, which a patch that faces outwards shows.
    void deny_contradictions() {
        Patches patches(
            edges_, at_, [this](auto&& visit) { each_edge(visit); },
            [this](auto&& visit) { each_first([&](uint32_t f, Component&) { visit(f); }); });
        each_first([&](uint32_t f, Component& component) {
            const int side = is_inside(back(f), component) - is_inside(front(f), component);
            component.contradicts &= patches.facing_of(f) * side >= 0;
        });
    }

    /// Finds cells that such parts enclose together and that are in none of them: an even number of faces is between
    /// one and the outside, on any way, and most of its faces have it in front of them.
    void find_voids() {
        if (std::none_of(components_.begin(), components_.end(), [](const Component& c) { return c.contradicts; }))
            return;
        DisjointSets parities(4 * size_t(count_)); // of cells: the cell, the opposite
        std::vector<double> faced(2 * size_t(count_), 0);
        each_first([&](uint32_t f, Component& component) {
            if (!component.contradicts)
                return;
            const uint32_t ahead = cells_.find(front(f)), behind = cells_.find(back(f));
            const uint32_t odd = uint32_t(surplus_[f]) & 1;
            parities.merge(2 * ahead, 2 * behind + odd);
            parities.merge(2 * ahead + 1, 2 * behind + 1 - odd);
            const double area = surplus_[f] * area_of(f);
            faced[ahead] += area;
            faced[behind] -= area;
        });
        each_first([&](uint32_t f, Component& component) {
            if (!component.contradicts)
                return;
            for (const uint32_t cell : {cells_.find(front(f)), cells_.find(back(f))})
                is_void_[cell] = cell != component.outside && volumes_[cell] > 0 && faced[cell] > 0 &&
                                 parities.find(2 * cell) == parities.find(2 * component.outside) &&
                                 parities.find(2 * cell) != parities.find(2 * cell + 1);
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
            const bool inwards = component.turned > component.kept;
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

    bool is_inside(uint32_t side, const Component& component) {
        const uint32_t cell = cells_.find(side);
        return cell != component.outside && !is_void_[cell];
    }

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
    const std::vector<Vertex>& at_;
    bool flat_;
    uint32_t count_;
    DisjointSets connected_;
    std::vector<uint32_t> component_of_; // by the first face of a component; UINT32_MAX where all is consistent
    std::vector<Component> components_;
    std::vector<uint32_t> first_;
    std::vector<bool> opposed_;
    std::vector<EdgeUse> sorted_;
    std::vector<int> surplus_; // of a face and those equal to it: how many more face as it does
    DisjointSets pieces_{0}, cells_{0};
    std::vector<int128> volumes_; // of cells, by side
    std::vector<bool> is_void_;   // likewise
    std::vector<EdgeUse> once_;
};

} // namespace

std::shared_ptr<const Orientation> find_orientation(const MeshEdges& whole, const MeshEdges& edges,
                                                    const std::vector<Vertex>& vertices, bool flat) {
    bool consistent = true;
    edges.each([&](uint32_t, Uses uses) { consistent = consistent && (uses.size() == 1 || is_pair(uses)); });
    std::vector<EdgeUse> sorted;
    whole.each([&](uint32_t, Uses uses) {
        each_repeated(uses, sorted, [&](const EdgeUse&, const EdgeUse&) { consistent = false; });
    });
    return consistent ? nullptr : Faces(whole, edges, vertices, flat).orient();
}

} // namespace voxrt::voxelize
