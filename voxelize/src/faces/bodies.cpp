#include "bodies.h"

namespace voxrt::voxelize {
namespace {

constexpr int kMostRounds = 8; // that set bodies apart: without those of one round, others may close

} // namespace

Bodies::Bodies(const MeshEdges& whole, const MeshEdges& edges)
    : first_(edges.face_count()), bodies_(edges.face_count(), kNone), is_open_(edges.face_count(), false) {
    std::iota(first_.begin(), first_.end(), 0u);
    std::vector<EdgeUse> sorted;
    whole.each([&](uint32_t, std::span<const EdgeUse> uses) {
        each_repeated(uses, sorted,
                      [&](const EdgeUse& first, const EdgeUse& again) { first_[again.face] = first.face; });
    });
    uint32_t left = 0, apart = 1;
    for (uint32_t f = 0; f < first_.size(); ++f)
        left += first_[f] == f;
    for (int round = 0; round < kMostRounds && left > 0 && apart > 0; ++round)
        left -= apart = set_apart(edges);
    DisjointSets connected(bodies_.size());
    if (left > 0)
        connect_rest(edges, connected);
    for (uint32_t f = 0; f < bodies_.size(); ++f)
        if (bodies_[f] != kNone || first_[f] != f)
            connected.merge(f, first_[f] != f ? first_[f] : bodies_[f]);
    for (uint32_t f = 0; f < bodies_.size(); ++f)
        bodies_[f] = connected.find(f);
}

void Bodies::connect_rest(const MeshEdges& edges, DisjointSets& connected) const {
    each_edge_left(edges, [&](std::span<const EdgeUse>, const std::vector<uint32_t>& left) {
        for (const uint32_t face : left)
            connected.merge(left[0], face);
    });
    // A fin belongs to the bodies that it is on, as does what they close.
    each_edge_left(edges, [&](std::span<const EdgeUse> uses, const std::vector<uint32_t>& left) {
        if (left.size() % 2 != 0)
            for (const EdgeUse& use : uses)
                connected.merge(left[0], use.face);
    });
}

template <class Visit> void Bodies::each_edge_left(const MeshEdges& edges, Visit&& visit) const {
    std::vector<uint32_t> left;
    edges.each([&](uint32_t, std::span<const EdgeUse> uses) {
        left.clear();
        for (const EdgeUse& use : uses)
            if (is_left(use.face))
                left.push_back(use.face);
        if (!left.empty())
            visit(uses, left);
    });
}

uint32_t Bodies::set_apart(const MeshEdges& edges) {
    DisjointSets patches(bodies_.size());
    std::vector<uint32_t> shared; // faces at edges of other than two
    std::vector<size_t> ends;     // of those at each
    each_edge_left(edges, [&](std::span<const EdgeUse>, const std::vector<uint32_t>& left) {
        if (left.size() == 2) {
            patches.merge(left[0], left[1]);
        } else {
            shared.insert(shared.end(), left.begin(), left.end());
            ends.push_back(shared.size());
        }
    });
    for (uint32_t& face : shared)
        face = patches.find(face);
    std::vector<bool> is_open(bodies_.size(), false);
    size_t i = 0;
    for (const size_t end : ends) {
        std::sort(shared.begin() + ptrdiff_t(i), shared.begin() + ptrdiff_t(end));
        for (size_t next; i < end; i = next) {
            for (next = i + 1; next < end && shared[next] == shared[i];)
                ++next;
            if ((next - i) % 2 != 0)
                is_open[shared[i]] = true;
        }
    }
    uint32_t apart = 0;
    for (uint32_t f = 0; f < bodies_.size(); ++f)
        if (const uint32_t patch = patches.find(f); is_left(f) && !is_open[patch]) {
            bodies_[f] = patch;
            ++apart;
        }
    return apart;
}

} // namespace voxrt::voxelize
