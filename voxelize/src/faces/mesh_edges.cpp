#include "mesh_edges.h"

namespace voxrt::voxelize {

std::vector<uint32_t> weld(const std::vector<uint64_t>& keys) {
    std::vector<uint32_t> order(keys.size()), first(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    WorkCounter& work = WorkCounter::current();
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        work.count(1);
        return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && keys[order[i]] == keys[order[i - 1]];
        first[order[i]] = again ? first[order[i - 1]] : order[i];
    }
    return first;
}

template <class EachUse> void MeshEdges::sort_uses(EachUse&& each_use) {
    starts_.assign(welded_.size() + 1, 0);
    each_use([&](uint32_t low, const EdgeUse&) { ++starts_[low + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    uses_.resize(starts_.back());
    std::vector<size_t> next(starts_.begin(), starts_.end() - 1);
    each_use([&](uint32_t low, const EdgeUse& use) { uses_[next[low]++] = use; });
    WorkCounter& work = WorkCounter::current();
    for (size_t low = 0; low + 1 < starts_.size(); ++low)
        std::sort(uses_.begin() + ptrdiff_t(starts_[low]), uses_.begin() + ptrdiff_t(starts_[low + 1]),
                  [&work](const EdgeUse& a, const EdgeUse& b) {
                      work.count(1);
                      return a.high != b.high ? a.high < b.high : a.face < b.face;
                  });
}

MeshEdges::MeshEdges(const MeshView& mesh, std::vector<uint32_t> welded) : mesh_(mesh), welded_(std::move(welded)) {
    sort_uses([&](auto&& visit) {
        for (size_t face = 0; face < face_count(); ++face) {
            count_work(5);
            const Corners c = corners(face);
            if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
                continue;
            for (int i = 0; i < 3; ++i) {
                const uint32_t from = c[size_t(i)], to = c[size_t(i + 1) % 3];
                visit(std::min(from, to),
                      EdgeUse{std::max(from, to), c[size_t(i + 2) % 3], uint32_t(face) & 0x7FFF'FFFF, from < to});
            }
        }
    });
}

MeshEdges::MeshEdges(const MeshEdges& whole, const std::vector<EdgeCut>& cuts)
    : mesh_(whole.mesh_), welded_(whole.welded_) {
    sort_uses([&](auto&& visit) {
        auto cut = cuts.begin();
        whole.each([&](uint32_t low, std::span<const EdgeUse> uses) {
            const uint32_t high = uses[0].high;
            const bool is_cut = cut != cuts.end() && cut->low == low && cut->high == high;
            const size_t pieces = is_cut ? cut->at.size() + 1 : 1;
            for (size_t i = 0; i < pieces; ++i) {
                const uint32_t from = i == 0 ? low : cut->at[i - 1], to = i + 1 == pieces ? high : cut->at[i];
                for (EdgeUse use : uses) {
                    use.high = std::max(from, to);
                    use.is_upwards = (use.is_upwards != 0) == (from < to);
                    visit(std::min(from, to), use);
                }
            }
            cut += is_cut;
        });
    });
}

} // namespace voxrt::voxelize
