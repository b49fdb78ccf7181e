#include "survey.h"

namespace voxrt {
namespace {

constexpr size_t kChunk = 16384;          // triangles or vertices a job
constexpr size_t kSharedTiles = 4;        // a part in so few tiles is not expanded,
constexpr size_t kSharedTriangles = 4096; // nor one with so few triangles over all its tiles

struct TiledItem {
    uint32_t tile;
    Item item;
};

/// Tiles that a range of coordinates may cover, clipped to the grid; first > last when it is outside.
struct TileRange {
    int x0, x1, y0, y1;
    bool empty() const { return x0 > x1 || y0 > y1; }
    size_t count() const { return empty() ? 0 : size_t(x1 - x0 + 1) * size_t(y1 - y0 + 1); }
};

struct Bounds {
    int64_t min[3] = {INT64_MAX, INT64_MAX, INT64_MAX}, max[3] = {INT64_MIN, INT64_MIN, INT64_MIN};
    void add(int64_t x, int64_t y, int64_t z) {
        const int64_t v[3] = {x, y, z};
        for (int i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], v[i]);
            max[i] = std::max(max[i], v[i]);
        }
    }
    void add(const Bounds& b) {
        for (int i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], b.min[i]);
            max[i] = std::max(max[i], b.max[i]);
        }
    }
};

/// A surface in the plane below a voxel may belong to the voxel on either side, and on the grid's rim to its last.
TileRange tiles_of(const Bounds& b, int side) {
    const int64_t end = side * kUnit;
    TileRange none{0, -1, 0, -1};
    for (int i = 0; i < 3; ++i)
        if (b.min[i] > end || (i < 2 && b.max[i] < 0))
            return none;
    auto tile = [&](int64_t v) { return std::clamp(voxel_floor(v), 0, side - 1) / kTileSide; };
    return {tile(b.min[0] - 1), tile(b.max[0]), tile(b.min[1] - 1), tile(b.max[1])};
}

Bounds triangle_bounds(const Vertex& a, const Vertex& b, const Vertex& c) {
    Bounds bounds;
    for (const Vertex* v : {&a, &b, &c})
        bounds.add(v->x, v->y, v->z);
    return bounds;
}

/// What triangles add to the closure test.
struct Tally {
    uint64_t boundary = 0;
    double volume6 = 0;
    Bounds bounds;
};

Tally tally(const MeshView& mesh, const std::vector<Vertex>& vertices, size_t from, size_t to) {
    Tally sum;
    const Vertex& origin = vertices[mesh.triangles[0]];
    for (size_t t = from; t < to; ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
        sum.boundary += boundary_key(vertex_key(a), vertex_key(b), vertex_key(c));
        sum.volume6 += volume6(a, b, c, origin);
        for (const Vertex* v : {&a, &b, &c})
            sum.bounds.add(v->x, v->y, v->z);
    }
    return sum;
}

/// Draws the conclusions; an open part to be filled is looked at closely.
void conclude(SurveyedMesh& mesh, const MeshView& view, const std::vector<Vertex>& vertices, const Tally& sum,
              bool fill) {
    mesh.closed = sum.boundary == 0;
    mesh.inverted = mesh.closed && sum.volume6 < 0;
    for (int i = 0; i < 3; ++i) {
        mesh.box.low[i] = voxel_floor(sum.bounds.min[i]);
        mesh.box.high[i] = voxel_below(sum.bounds.max[i]);
    }
    if (fill && !mesh.closed)
        mesh.open = std::make_unique<OpenSurface>(open_surface(view, vertices));
}

void list_triangles(std::vector<TiledItem>& out, const MeshView& mesh, const std::vector<Vertex>& vertices,
                    uint32_t part, int side, int tiles_a_side, size_t from, size_t to) {
    for (size_t t = from; t < to; ++t) {
        const int32_t* corner = mesh.triangles.data() + 3 * t;
        const TileRange range =
            tiles_of(triangle_bounds(vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]), side);
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x)
                out.push_back({uint32_t(y * tiles_a_side + x), {part, uint32_t(t)}});
    }
}

void list_whole(std::vector<TiledItem>& out, const TileRange& range, uint32_t part, int tiles_a_side) {
    for (int y = range.y0; y <= range.y1; ++y)
        for (int x = range.x0; x <= range.x1; ++x)
            out.push_back({uint32_t(y * tiles_a_side + x), {part, kWhole}});
}

/// The caps of an open part, and a visit to every tile that it may enclose.
void list_caps(std::vector<TiledItem>& out, const SurveyedMesh& mesh, size_t triangle_count, const TileRange& range,
               uint32_t part, int side, int tiles_a_side) {
    auto number = uint32_t(triangle_count);
    for (const auto& [a, b, c] : mesh.open->caps) {
        const TileRange tiles = tiles_of(triangle_bounds(a, b, c), side);
        for (int y = tiles.y0; y <= tiles.y1; ++y)
            for (int x = tiles.x0; x <= tiles.x1; ++x)
                out.push_back({uint32_t(y * tiles_a_side + x), {part, number}});
        ++number;
    }
    for (int y = range.y0; y <= range.y1; ++y)
        for (int x = range.x0; x <= range.x1; ++x)
            out.push_back({uint32_t(y * tiles_a_side + x), {part, number}});
}

bool stays_whole(const TileRange& range, size_t triangles) {
    return range.count() <= kSharedTiles || range.count() * triangles <= kSharedTriangles;
}

TileRange solid_tiles(const PartView& part, int side) {
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
        bounds.min[i] = snap(low, part.object) - 1;
        bounds.max[i] = snap(high, part.object) + 1;
    }
    return tiles_of(bounds, side);
}

/// Parts with many triangles are shared out among the threads, a chunk a job.
void survey_large(SurveyedMesh& mesh, const PartView& part, uint32_t index, int side, int tiles_a_side, bool fill,
                  std::vector<std::vector<TiledItem>>& lists, Workers& workers) {
    const size_t vertex_count = part.mesh->vertex_count(), triangle_count = part.mesh->triangle_count();
    mesh.vertices.resize(vertex_count);
    workers.run((vertex_count + kChunk - 1) / kChunk, [&](size_t job, int) {
        for (size_t v = job * kChunk; v < std::min(vertex_count, (job + 1) * kChunk); ++v)
            mesh.vertices[v] = snap_vertex(part, v);
    });
    const size_t chunks = (triangle_count + kChunk - 1) / kChunk;
    std::vector<Tally> tallies(chunks);
    std::vector<std::vector<TiledItem>> chunk_lists(chunks);
    workers.run(chunks, [&](size_t job, int) {
        const size_t from = job * kChunk, to = std::min(triangle_count, from + kChunk);
        tallies[job] = tally(*part.mesh, mesh.vertices, from, to);
        chunk_lists[job].reserve((to - from) * 5 / 4);
        list_triangles(chunk_lists[job], *part.mesh, mesh.vertices, index, side, tiles_a_side, from, to);
    });
    Tally sum;
    for (const Tally& t : tallies) {
        sum.boundary += t.boundary;
        sum.volume6 += t.volume6;
        sum.bounds.add(t.bounds);
    }
    conclude(mesh, *part.mesh, mesh.vertices, sum, fill);
    const TileRange range = tiles_of(sum.bounds, side);
    if (stays_whole(range, triangle_count)) {
        mesh.vertices = {};
        list_whole(lists.emplace_back(), range, index, tiles_a_side);
        return;
    }
    for (auto& list : chunk_lists)
        lists.push_back(std::move(list));
    if (mesh.open)
        list_caps(lists.emplace_back(), mesh, triangle_count, range, index, side, tiles_a_side);
}

void survey_small(SurveyedMesh& mesh, const PartView& part, uint32_t index, int side, int tiles_a_side, bool fill,
                  std::vector<TiledItem>& list) {
    const size_t triangle_count = part.mesh->triangle_count();
    if (triangle_count == 0)
        return;
    std::vector<Vertex> vertices(part.mesh->vertex_count());
    for (size_t v = 0; v < vertices.size(); ++v)
        vertices[v] = snap_vertex(part, v);
    const Tally sum = tally(*part.mesh, vertices, 0, triangle_count);
    conclude(mesh, *part.mesh, vertices, sum, fill);
    const TileRange range = tiles_of(sum.bounds, side);
    if (stays_whole(range, triangle_count)) {
        list_whole(list, range, index, tiles_a_side);
    } else {
        list_triangles(list, *part.mesh, vertices, index, side, tiles_a_side, 0, triangle_count);
        if (mesh.open)
            list_caps(list, mesh, triangle_count, range, index, side, tiles_a_side);
        mesh.vertices = std::move(vertices);
    }
}

} // namespace

Survey survey_parts(const std::vector<PartView>& parts, int side, bool fill, Workers& workers) {
    Survey survey;
    survey.tiles_a_side = (side + kTileSide - 1) / kTileSide;
    survey.meshes.resize(parts.size());
    std::vector<std::vector<TiledItem>> lists; // in authored order

    for (size_t begin = 0; begin < parts.size();) {
        const PartView& first = parts[begin];
        if (first.kind == PartKind::mesh && first.mesh->triangle_count() > kChunk) {
            survey_large(survey.meshes[begin], first, uint32_t(begin), side, survey.tiles_a_side, fill, lists, workers);
            ++begin;
            continue;
        }
        size_t end = begin;
        while (end < parts.size() && end - begin < 65536 &&
               !(parts[end].kind == PartKind::mesh && parts[end].mesh->triangle_count() > kChunk))
            ++end;
        constexpr size_t group = 16;
        const size_t jobs = (end - begin + group - 1) / group, offset = lists.size();
        lists.resize(offset + jobs);
        workers.run(jobs, [&](size_t job, int) {
            for (size_t p = begin + job * group; p < std::min(end, begin + (job + 1) * group); ++p) {
                std::vector<TiledItem>& list = lists[offset + job];
                if (parts[p].kind == PartKind::mesh)
                    survey_small(survey.meshes[p], parts[p], uint32_t(p), side, survey.tiles_a_side, fill, list);
                else
                    list_whole(list, solid_tiles(parts[p], side), uint32_t(p), survey.tiles_a_side);
            }
        });
        begin = end;
    }

    // A counting sort by tile; stable, so that items stay in authored order.
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
    return survey;
}

} // namespace voxrt
