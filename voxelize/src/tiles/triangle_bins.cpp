#include "triangle_bins.h"

#include "../work/stage_seconds.h"

#include <map>
#include <set>

namespace voxrt::voxelize {
namespace {

constexpr size_t kChunk = 16384; // triangles or vertices per job

/// A part is listed as a whole where it touches so few tiles, or where its tiles together list so few triangles.
constexpr size_t kWholeTiles = 4;
constexpr size_t kWholeTriangles = 4096;

/// The bounds of a box, a ball or an ellipsoid; never too small.
Bounds solid_bounds(const PartView& part) {
    Bounds bounds;
    const double* f = part.frame;
    for (int i = 0; i < 3; ++i) {
        double low, high;
        if (part.kind == PartKind::box) {
            low = f[i];
            high = f[3 + i];
        } else if (part.kind == PartKind::ball) {
            low = f[i] - f[3];
            high = f[i] + f[3];
        } else {
            const double* row = f + 4 * i;
            const double extent = std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]) + 1;
            low = row[3] - extent;
            high = row[3] + extent;
        }
        bounds.min[i] = int64_t{snap(low, part.object)} - 1;
        bounds.max[i] = int64_t{snap(high, part.object)} + 1;
    }
    return bounds;
}

/// Analyses parts and lists their triangles by tile, unsorted.
class PartBinning {
public:
    explicit PartBinning(const Tiling& tiling) : tiling_(tiling) {}

    /// Adds one mesh part. `run(count, job)` calls job(index) for each index; `emit()` makes the next list of entries,
    /// in authored order.
    template <class Run, class Emit>
    void add_mesh(MeshAnalysis& analysis, const PartView& part, uint32_t index, const SharedMesh* shared, Run&& run,
                  Emit&& emit) const {
        const size_t triangle_count = part.mesh->triangle_count();
        if (triangle_count == 0)
            return;
        TriangleSums sums;
        if (shared != nullptr) {
            sums = instance_sums(*shared, part);
            if (stays_whole(sums.bounds, triangle_count)) {
                analyze_part(analysis, part, sums, shared, part.fill);
                list_whole(emit(), sums.bounds, index);
                return;
            }
        }
        analysis.vertices.resize(part.mesh->vertex_count());
        run((analysis.vertices.size() + kChunk - 1) / kChunk, [&](size_t job) {
            for (size_t v = job * kChunk; v < std::min(analysis.vertices.size(), (job + 1) * kChunk); ++v)
                analysis.vertices[v] = snap_vertex(part, v);
        });
        const size_t chunks = (triangle_count + kChunk - 1) / kChunk;
        std::vector<TriangleSums> chunk_sums(chunks);
        std::vector<std::vector<TileEntry>> lists(chunks);
        run(chunks, [&](size_t job) {
            const size_t from = job * kChunk, to = std::min(triangle_count, from + kChunk);
            if (shared == nullptr)
                chunk_sums[job] = sum_triangles(*part.mesh, analysis.vertices, from, to);
            lists[job].reserve((to - from) * 5 / 4);
            list_triangles(lists[job], *part.mesh, analysis.vertices, index, from, to);
        });
        for (const TriangleSums& chunk : chunk_sums)
            sums.add(chunk);
        analyze_part(analysis, part, sums, shared, part.fill);
        if (analysis.hole_caps)
            analysis.capped =
                std::make_unique<CappedSurface>(analysis.hole_caps, [&](uint32_t v) { return analysis.vertices[v]; });
        if (stays_whole(sums.bounds, triangle_count)) {
            analysis.vertices = {};
            list_whole(emit(), sums.bounds, index);
            return;
        }
        for (auto& list : lists) {
            if (analysis.orientation)
                std::erase_if(list, [&](const TileEntry& entry) {
                    return analysis.is_covered(*part.mesh, entry.triangle.triangle);
                });
            emit() = std::move(list);
        }
        if (analysis.capped)
            list_caps(emit(), *analysis.capped, triangle_count, sums.bounds, index);
    }

    void list_whole(std::vector<TileEntry>& out, const Bounds& bounds, uint32_t index) const {
        tiling_.list(out, tiling_.touched(bounds), {index, kWholePart});
    }

private:
    bool stays_whole(const Bounds& bounds, size_t triangles) const {
        const size_t tiles = tiling_.touched(bounds).count();
        return tiles <= kWholeTiles || tiles * triangles <= kWholeTriangles;
    }

    void list_triangles(std::vector<TileEntry>& out, const MeshView& mesh, const std::vector<Vertex>& vertices,
                        uint32_t part, size_t from, size_t to) const {
        for (size_t t = from; t < to; ++t) {
            Bounds bounds;
            for (int i = 0; i < 3; ++i)
                bounds.add(vertices[mesh.triangles[3 * t + i]]);
            tiling_.list(out, tiling_.touched(bounds), {part, uint32_t(t)});
        }
    }

    /// The caps of a part with holes, and an entry for every tile that it may enclose.
    void list_caps(std::vector<TileEntry>& out, const CappedSurface& capped, size_t triangle_count, const Bounds& all,
                   uint32_t part) const {
        auto number = uint32_t(triangle_count);
        for (const auto& cap : capped.caps) {
            Bounds bounds;
            for (const Vertex& v : cap)
                bounds.add(v);
            tiling_.list(out, tiling_.touched(bounds), {part, number++});
        }
        tiling_.list(out, tiling_.touched(all), {part, number});
    }

    const Tiling& tiling_;
};

struct Wanted {
    std::span<const uint8_t> objects;
    bool operator()(const PartView& part) const { return objects.empty() || objects[part.object] != 0; }
};

/// A mesh, and the fill of the parts that share its analysis.
using MeshUse = std::pair<const MeshView*, Fill>;

MeshUse use_of(const PartView& part) { return {part.mesh, part.fill}; }

using SharedMeshes = std::map<MeshUse, SharedMesh>;

/// The meshes of several parts.
SharedMeshes analyze_instanced(const std::vector<PartView>& parts, const Wanted& wanted, const Workers& workers) {
    std::map<MeshUse, std::pair<size_t, uint32_t>> uses; // how many, and the first object
    SharedMeshes shared;
    for (const PartView& part : parts)
        if (part.kind == PartKind::mesh && part.mesh->triangle_count() > 0) {
            auto& [count, object] = uses.try_emplace(use_of(part), 0, part.object).first->second;
            if (++count == 2)
                shared.try_emplace(use_of(part));
        }
    std::set<MeshUse> needed;
    for (const PartView& part : parts)
        if (wanted(part))
            needed.insert(use_of(part));
    std::vector<SharedMeshes::value_type*> entries;
    for (auto& entry : shared)
        if (needed.contains(entry.first))
            entries.push_back(&entry);
    workers.run(entries.size(), [&](size_t job, int) {
        auto& [use, found] = *entries[job];
        found = analyze_shared(*use.first, uses.at(use).second, use.second);
    });
    return shared;
}

/// A counting sort by tile; stable, so that the triangles stay in authored order.
void sort_by_tile(TriangleBins& bins, std::vector<std::vector<TileEntry>>& lists) {
    std::vector<uint32_t>& starts = bins.starts;
    starts.assign(size_t(bins.tiles_per_side) * bins.tiles_per_side + 1, 0);
    size_t total = 0;
    for (const auto& list : lists) {
        total += list.size();
        for (const TileEntry& entry : list)
            ++starts[entry.tile + 1];
    }
    if (total >= kWholePart)
        throw std::length_error("the grid's tiles would list 2^32 triangles or more; lower the depth");
    for (size_t t = 1; t < starts.size(); ++t)
        starts[t] += starts[t - 1];
    bins.triangles.resize(total);
    std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
    for (auto& list : lists) {
        for (const TileEntry& entry : list)
            bins.triangles[next[entry.tile]++] = entry.triangle;
        list = {};
    }
}

} // namespace

TriangleBins bin_triangles(const std::vector<PartView>& parts, std::span<const uint8_t> wanted_objects, int side,
                           const Workers& workers) {
    const Wanted wanted{wanted_objects};
    const Tiling tiling(side);
    const PartBinning binning(tiling);
    TriangleBins bins;
    bins.tiles_per_side = tiling.tiles_per_side();
    bins.meshes.resize(parts.size());
    const SharedMeshes shared = analyze_instanced(parts, wanted, workers);
    auto shared_of = [&](const PartView& part) {
        const auto found = shared.find(use_of(part));
        return found == shared.end() ? nullptr : &found->second;
    };
    auto is_large = [](const PartView& part) {
        return part.kind == PartKind::mesh && part.mesh->triangle_count() > kChunk;
    };

    // Large parts one after another, a job per chunk; the small ones between them in groups.
    std::vector<std::vector<TileEntry>> lists; // in authored order
    for (size_t begin = 0; begin < parts.size();) {
        if (is_large(parts[begin])) {
            if (!wanted(parts[begin])) {
                ++begin;
                continue;
            }
            binning.add_mesh(
                bins.meshes[begin], parts[begin], uint32_t(begin), shared_of(parts[begin]),
                [&](size_t count, auto&& job) { workers.run(count, [&](size_t i, int) { job(i); }); },
                [&]() -> auto& { return lists.emplace_back(); });
            ++begin;
            continue;
        }
        size_t end = begin;
        while (end < parts.size() && end - begin < 65536 && !is_large(parts[end]))
            ++end;
        constexpr size_t group = 16;
        const size_t jobs = (end - begin + group - 1) / group;
        std::vector<std::vector<std::vector<TileEntry>>> grouped(jobs);
        workers.run(jobs, [&](size_t job, int) {
            for (size_t p = begin + job * group; p < std::min(end, begin + (job + 1) * group); ++p) {
                if (!wanted(parts[p]))
                    continue;
                if (parts[p].kind == PartKind::mesh)
                    binning.add_mesh(
                        bins.meshes[p], parts[p], uint32_t(p), shared_of(parts[p]),
                        [](size_t count, auto&& work) {
                            for (size_t i = 0; i < count; ++i)
                                work(i);
                        },
                        [&]() -> auto& { return grouped[job].emplace_back(); });
                else
                    binning.list_whole(grouped[job].emplace_back(), solid_bounds(parts[p]), uint32_t(p));
            }
        });
        for (auto& some : grouped)
            for (auto& list : some)
                lists.push_back(std::move(list));
        begin = end;
    }
    Stopwatch lap;
    sort_by_tile(bins, lists);
    bins.seconds = lap();
    return bins;
}

} // namespace voxrt::voxelize
