#include "mesh_edges.h"

namespace voxrt::voxelize {

MeshEdges::MeshEdges(const MeshView& mesh, std::vector<uint32_t> welded)
    : mesh_(mesh), welded_(std::move(welded)), starts_(welded_.size() + 1, 0) {
    const auto each_use = [&](auto&& visit) {
        for (size_t face = 0; face < face_count(); ++face) {
            count_work(5);
            const Corners c = corners(face);
            if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
                continue;
            for (int i = 0; i < 3; ++i) {
                const uint32_t from = c[size_t(i)], to = c[size_t(i + 1) % 3];
                visit(std::min(from, to), EdgeUse{std::max(from, to), uint32_t(face), c[size_t(i + 2) % 3], from < to});
            }
        }
    };
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

} // namespace voxrt::voxelize
