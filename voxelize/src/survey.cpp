#include "survey.h"

#include "closure.h"

#include <unordered_map>

namespace voxrt {
namespace {

constexpr size_t kChunk = 16384;          // triangles or vertices a job
constexpr size_t kSharedTiles = 4;        // a part in so few tiles is listed as a whole,
constexpr size_t kSharedTriangles = 4096; // as is one with so few triangles over all its tiles

/// What triangles add up to.
struct Tally {
    uint64_t boundary = 0; // zero where they close
    double volume6 = 0;
    Bounds bounds;

    void add(const Tally& t) {
        boundary += t.boundary;
        volume6 += t.volume6;
        bounds.add(t.bounds);
    }
};

Tally tally(const MeshView& mesh, const std::vector<Vertex>& vertices, size_t from, size_t to) {
    Tally sum;
    const Vertex& origin = vertices[mesh.triangles[0]];
    pulse(5 * uint32_t(to - from));
    for (size_t t = from; t < to; ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
        sum.boundary += boundary_key(vertex_key(a), vertex_key(b), vertex_key(c));
        sum.volume6 += volume6(a, b, c, origin);
        for (const Vertex* v : {&a, &b, &c})
            sum.bounds.add(*v);
    }
    return sum;
}

/// What all instances of a mesh have in common, found on its own positions: equal positions are snapped to equal ones.
struct SharedMesh {
    Point low{}, high{};
    bool closed = false;
    double volume6 = 0;
    std::shared_ptr<const Boundary> boundary; // where not closed
    std::shared_ptr<const TurnedPieces> turned;
};

/// Points in a lattice of their own: so fine that those of a float32 file stay apart.
std::vector<Vertex> in_lattice(const std::vector<Point>& points, const Point& low, const Point& high) {
    const double scale = double(kReach) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
    std::vector<Vertex> vertices;
    vertices.reserve(points.size());
    auto whole = [scale](double v, double from) {
        return int32_t(std::clamp(std::nearbyint((v - from) * scale), 0.0, double(kReach)));
    };
    for (const Point& p : points)
        vertices.push_back({whole(p.x, low.x), whole(p.y, low.y), whole(p.z, low.z)});
    return vertices;
}

SharedMesh survey_shared(const MeshView& mesh, uint32_t object, bool fill) {
    SharedMesh shared;
    std::vector<Point> points(mesh.vertex_count());
    std::vector<uint64_t> keys(points.size());
    for (size_t v = 0; v < points.size(); ++v) {
        // Adding zero makes the two zeros one.
        points[v] = {mesh.positions[3 * v] + 0.0, mesh.positions[3 * v + 1] + 0.0, mesh.positions[3 * v + 2] + 0.0};
        if (!std::isfinite(points[v].x) || !std::isfinite(points[v].y) || !std::isfinite(points[v].z))
            throw OutOfReach(object);
        keys[v] = point_key(points[v].x, points[v].y, points[v].z);
    }
    shared.low = shared.high = points[mesh.triangles[0]];
    const Point& o = points[mesh.triangles[0]];
    uint64_t sum = 0;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
        pulse(5);
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        sum += boundary_key(keys[corner[0]], keys[corner[1]], keys[corner[2]]);
        shared.volume6 += volume6(points[corner[0]], points[corner[1]], points[corner[2]], o);
        for (int i = 0; i < 3; ++i) {
            const Point& p = points[corner[i]];
            shared.low = {std::min(shared.low.x, p.x), std::min(shared.low.y, p.y), std::min(shared.low.z, p.z)};
            shared.high = {std::max(shared.high.x, p.x), std::max(shared.high.y, p.y), std::max(shared.high.z, p.z)};
        }
    }
    shared.closed = sum == 0;
    if (fill && !shared.closed)
        shared.boundary = std::make_shared<const Boundary>(find_boundary(mesh, points));
    if (shared.closed || fill)
        shared.turned = find_turned_pieces(mesh, in_lattice(points, shared.low, shared.high), shared.boundary.get());
    return shared;
}

/// The box of an instance, from its mesh's: never too small.
Bounds instance_bounds(const SharedMesh& shared, const PartView& part) {
    Bounds bounds;
    for (int i = 0; i < 3; ++i) {
        const double* row = part.frame + 4 * i;
        double low = row[3], high = row[3];
        const double from[3] = {shared.low.x, shared.low.y, shared.low.z};
        const double to[3] = {shared.high.x, shared.high.y, shared.high.z};
        for (int j = 0; j < 3; ++j) {
            low += std::min(row[j] * from[j], row[j] * to[j]);
            high += std::max(row[j] * from[j], row[j] * to[j]);
        }
        bounds.min[i] = int64_t{snap(low, part.object)} - 1;
        bounds.max[i] = int64_t{snap(high, part.object)} + 1;
    }
    return bounds;
}

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
            const double reach = std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]) + 1;
            low = row[3] - reach;
            high = row[3] + reach;
        }
        bounds.min[i] = int64_t{snap(low, part.object)} - 1;
        bounds.max[i] = int64_t{snap(high, part.object)} + 1;
    }
    return bounds;
}

double determinant(const double* f) {
    return f[0] * (f[5] * f[10] - f[6] * f[9]) - f[1] * (f[4] * f[10] - f[6] * f[8]) +
           f[2] * (f[4] * f[9] - f[5] * f[8]);
}

class PartSurvey {
public:
    PartSurvey(const Tiling& tiling, bool fill) : tiling_(tiling), fill_(fill) {}

    /// Surveys one part; `run` shares out jobs, `emit` takes lists in order.
    template <class Run, class Emit>
    void survey(SurveyedMesh& mesh, const PartView& part, uint32_t index, const SharedMesh* shared, Run&& run,
                Emit&& emit) const {
        const size_t triangle_count = part.mesh->triangle_count();
        if (triangle_count == 0)
            return;
        Tally sum;
        if (shared != nullptr) {
            sum.bounds = instance_bounds(*shared, part);
            sum.boundary = shared->closed ? 0 : 1;
            sum.volume6 = shared->volume6 * determinant(part.frame);
            if (stays_whole(sum.bounds, triangle_count)) {
                conclude(mesh, part, sum, shared);
                list_whole(emit(), sum.bounds, index);
                return;
            }
        }
        mesh.vertices.resize(part.mesh->vertex_count());
        run((mesh.vertices.size() + kChunk - 1) / kChunk, [&](size_t job) {
            for (size_t v = job * kChunk; v < std::min(mesh.vertices.size(), (job + 1) * kChunk); ++v)
                mesh.vertices[v] = snap_vertex(part, v);
        });
        const size_t chunks = (triangle_count + kChunk - 1) / kChunk;
        std::vector<Tally> tallies(chunks);
        std::vector<std::vector<TiledItem>> lists(chunks);
        run(chunks, [&](size_t job) {
            const size_t from = job * kChunk, to = std::min(triangle_count, from + kChunk);
            if (shared == nullptr)
                tallies[job] = tally(*part.mesh, mesh.vertices, from, to);
            lists[job].reserve((to - from) * 5 / 4);
            list_triangles(lists[job], *part.mesh, mesh.vertices, index, from, to);
        });
        for (const Tally& t : tallies)
            sum.add(t);
        conclude(mesh, part, sum, shared);
        if (mesh.boundary)
            mesh.open = std::make_unique<OpenSurface>(mesh.boundary, [&](uint32_t v) { return mesh.vertices[v]; });
        if (stays_whole(sum.bounds, triangle_count)) {
            mesh.vertices = {};
            list_whole(emit(), sum.bounds, index);
            return;
        }
        for (auto& list : lists)
            emit() = std::move(list);
        if (mesh.open)
            list_caps(emit(), *mesh.open, triangle_count, sum.bounds, index);
    }

    void list_whole(std::vector<TiledItem>& out, const Bounds& bounds, uint32_t index) const {
        tiling_.list(out, tiling_.touched(bounds), {index, kWhole});
    }

private:
    bool stays_whole(const Bounds& bounds, size_t triangles) const {
        const size_t tiles = tiling_.touched(bounds).count();
        return tiles <= kSharedTiles || tiles * triangles <= kSharedTriangles;
    }

    /// Draws the conclusions; an open part to be filled is looked at closely.
    void conclude(SurveyedMesh& mesh, const PartView& part, const Tally& sum, const SharedMesh* shared) const {
        mesh.closed = sum.boundary == 0;
        mesh.inverted = mesh.closed && sum.volume6 < 0;
        for (int i = 0; i < 3; ++i) {
            mesh.box.low[i] = voxel_floor(sum.bounds.min[i]);
            mesh.box.high[i] = voxel_below(sum.bounds.max[i]);
        }
        if (mesh.closed) {
            mesh.turned = shared != nullptr ? shared->turned : find_turned_pieces(*part.mesh, mesh.vertices, nullptr);
            if (mesh.turned)
                mesh.inverted = shared != nullptr && determinant(part.frame) < 0;
            return;
        }
        if (!fill_)
            return;
        auto boundary = shared != nullptr ? shared->boundary : nullptr;
        if (!boundary) {
            std::vector<Point> points(mesh.vertices.size());
            for (size_t v = 0; v < points.size(); ++v)
                points[v] = in_voxels(mesh.vertices[v]);
            boundary = std::make_shared<const Boundary>(find_boundary(*part.mesh, points));
        }
        mesh.turned =
            shared != nullptr ? shared->turned : find_turned_pieces(*part.mesh, mesh.vertices, boundary.get());
        mesh.boundary = std::move(boundary);
    }

    void list_triangles(std::vector<TiledItem>& out, const MeshView& mesh, const std::vector<Vertex>& vertices,
                        uint32_t part, size_t from, size_t to) const {
        for (size_t t = from; t < to; ++t) {
            Bounds bounds;
            for (int i = 0; i < 3; ++i)
                bounds.add(vertices[mesh.triangles[3 * t + i]]);
            tiling_.list(out, tiling_.touched(bounds), {part, uint32_t(t)});
        }
    }

    /// The caps of an open part, and a visit to every tile that it may enclose.
    void list_caps(std::vector<TiledItem>& out, const OpenSurface& open, size_t triangle_count, const Bounds& all,
                   uint32_t part) const {
        auto number = uint32_t(triangle_count);
        for (const auto& cap : open.caps) {
            Bounds bounds;
            for (const Vertex& v : cap)
                bounds.add(v);
            tiling_.list(out, tiling_.touched(bounds), {part, number++});
        }
        tiling_.list(out, tiling_.touched(all), {part, number});
    }

    const Tiling& tiling_;
    bool fill_;
};

/// The meshes that several parts share.
std::unordered_map<const MeshView*, SharedMesh> survey_instanced(const std::vector<PartView>& parts, bool fill,
                                                                 Workers& workers) {
    std::unordered_map<const MeshView*, std::pair<size_t, uint32_t>> uses;
    std::unordered_map<const MeshView*, SharedMesh> shared;
    std::vector<std::pair<SharedMesh*, uint32_t>> jobs;
    for (const PartView& part : parts)
        if (part.kind == PartKind::mesh && part.mesh->triangle_count() > 0) {
            auto& [count, object] = uses.try_emplace(part.mesh, 0, part.object).first->second;
            if (++count == 2)
                shared.try_emplace(part.mesh);
        }
    std::vector<std::pair<const MeshView* const, SharedMesh>*> entries;
    for (auto& entry : shared)
        entries.push_back(&entry);
    workers.run(entries.size(), [&](size_t job, int) {
        entries[job]->second = survey_shared(*entries[job]->first, uses.at(entries[job]->first).second, fill);
    });
    return shared;
}

/// A counting sort by tile; stable, so that items stay in authored order.
void sort_by_tile(Survey& survey, std::vector<std::vector<TiledItem>>& lists) {
    std::vector<uint32_t>& starts = survey.starts;
    starts.assign(size_t(survey.tiles_a_side) * survey.tiles_a_side + 1, 0);
    size_t total = 0;
    for (const auto& list : lists) {
        total += list.size();
        for (const TiledItem& entry : list)
            ++starts[entry.tile + 1];
    }
    if (total >= kWhole)
        throw std::length_error("more than 2^32 pieces of triangles in the grid's tiles; lower the depth");
    for (size_t t = 1; t < starts.size(); ++t)
        starts[t] += starts[t - 1];
    survey.items.resize(total);
    std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
    for (auto& list : lists) {
        for (const TiledItem& entry : list)
            survey.items[next[entry.tile]++] = entry.item;
        list = {};
    }
}

} // namespace

Survey survey_parts(const std::vector<PartView>& parts, int side, bool fill, Workers& workers) {
    const Tiling tiling(side);
    const PartSurvey part_survey(tiling, fill);
    Survey survey;
    survey.tiles_a_side = tiling.tiles_a_side();
    survey.meshes.resize(parts.size());
    const auto shared = survey_instanced(parts, fill, workers);
    auto shared_of = [&](const PartView& part) {
        const auto found = shared.find(part.mesh);
        return found == shared.end() ? nullptr : &found->second;
    };
    auto is_large = [](const PartView& part) {
        return part.kind == PartKind::mesh && part.mesh->triangle_count() > kChunk;
    };

    // Large parts one after another, a chunk a job; the small ones between them by groups.
    std::vector<std::vector<TiledItem>> lists; // in authored order
    for (size_t begin = 0; begin < parts.size();) {
        if (is_large(parts[begin])) {
            part_survey.survey(
                survey.meshes[begin], parts[begin], uint32_t(begin), shared_of(parts[begin]),
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
        std::vector<std::vector<std::vector<TiledItem>>> grouped(jobs);
        workers.run(jobs, [&](size_t job, int) {
            for (size_t p = begin + job * group; p < std::min(end, begin + (job + 1) * group); ++p) {
                if (parts[p].kind == PartKind::mesh)
                    part_survey.survey(
                        survey.meshes[p], parts[p], uint32_t(p), shared_of(parts[p]),
                        [](size_t count, auto&& work) {
                            for (size_t i = 0; i < count; ++i)
                                work(i);
                        },
                        [&]() -> auto& { return grouped[job].emplace_back(); });
                else
                    part_survey.list_whole(grouped[job].emplace_back(), solid_bounds(parts[p]), uint32_t(p));
            }
        });
        for (auto& some : grouped)
            for (auto& list : some)
                lists.push_back(std::move(list));
        begin = end;
    }
    Lap lap;
    sort_by_tile(survey, lists);
    survey.bin_seconds = lap();
    return survey;
}

} // namespace voxrt
