#include "voxelizer.h"

#include "convex_solids.h"
#include "solid_fill.h"
#include "survey.h"
#include "tile_order.h"
#include "tint.h"

#include <optional>

namespace voxrt {
namespace {

/// What a thread keeps from tile to tile.
struct Scratch {
    explicit Scratch(int side, size_t objects, size_t parts)
        : layer(side), tile(side), object_voxels(objects, 0), complex(parts, 0) {}
    ObjectLayer layer;
    TileVoxels tile;
    SolidFill fill;
    TileOrder order;
    std::vector<Vertex> vertices;
    std::vector<int64_t> object_voxels;
    std::vector<uint8_t> complex; // by part: winding numbers beyond 0 and 1 were seen
    StageSeconds seconds;
};

class TileWorker {
public:
    TileWorker(const std::vector<PartView>& parts, const Survey& survey, int side, bool fill)
        : parts_(parts), survey_(survey), side_(side), fill_(fill) {}

    void work(uint32_t index, Scratch& s, TileResult& out) const {
        const int tile_x = int(index) % survey_.tiles_a_side, tile_y = int(index) / survey_.tiles_a_side;
        const Window window{tile_x * kTileSide, std::min(tile_x * kTileSide + kTileSide, side_) - 1, tile_y * kTileSide,
                            std::min(tile_y * kTileSide + kTileSide, side_) - 1, side_ - 1};
        s.tile.clear();
        for (uint32_t i = survey_.starts[index], end = survey_.starts[index + 1]; i < end;) {
            const uint32_t part = survey_.items[i].part;
            uint32_t next = i + 1;
            while (next < end && survey_.items[next].part == part)
                ++next;
            const Item* items = survey_.items.data() + i;
            if (parts_[part].kind == PartKind::mesh) {
                add_mesh(part, {items, next - i}, window, s);
            } else {
                Lap lap;
                add_solid(parts_[part], window, s);
                s.seconds.coverage += lap();
            }
            i = next;
        }
        Lap lap;
        if (!s.tile.empty())
            s.order.order(s.tile, index, tile_x, tile_y, out);
        s.seconds.order += lap();
    }

private:
    void add_solid(const PartView& part, const Window& window, Scratch& s) const {
        const double* f = part.frame;
        auto whole = [&](int i) { return int64_t(snap(f[i], part.object)); };
        int64_t claimed = 0;
        if (part.kind == PartKind::box)
            claimed =
                claim_convex(s.tile, window, AxisBox{{whole(0), whole(1), whole(2)}, {whole(3), whole(4), whole(5)}},
                             fill_, part.material);
        else if (part.kind == PartKind::ball)
            claimed =
                claim_convex(s.tile, window, Ball{{whole(0), whole(1), whole(2)}, whole(3)}, fill_, part.material);
        else
            claimed = claim_convex(s.tile, window, Ellipsoid(f), fill_, part.material);
        s.object_voxels[part.object] += claimed;
    }

    void add_mesh(uint32_t index, std::span<const Item> items, const Window& window, Scratch& s) const {
        const PartView& part = parts_[index];
        const SurveyedMesh& surveyed = survey_.meshes[index];
        const std::vector<Vertex>* vertices = &surveyed.vertices;
        if (vertices->empty()) {
            s.vertices.resize(part.mesh->vertex_count());
            for (size_t v = 0; v < s.vertices.size(); ++v)
                s.vertices[v] = snap_vertex(part, v);
            vertices = &s.vertices;
        }
        s.layer.start(window.x0, window.y0);
        Lap lap;
        // What every instance kept of its holes would be more than all the rest.
        std::optional<OpenSurface> own;
        if (!surveyed.open && surveyed.boundary)
            own.emplace(surveyed.boundary, [vertices](uint32_t v) { return (*vertices)[v]; });
        const OpenSurface* open = own ? &*own : surveyed.open.get();
        s.seconds.holes += lap();
        if (fill_)
            cover<true>(part, surveyed, open, *vertices, items, window, s.layer);
        else
            cover<false>(part, surveyed, open, *vertices, items, window, s.layer);
        s.seconds.coverage += lap();
        const bool has_holes = open != nullptr && !open->holes.empty();
        if (s.layer.empty() && !has_holes)
            return;
        const uint8_t interior = part.material != 0 ? part.material : part.mesh->materials[0];
        const Claim claim = !fill_ ? s.fill.claim_shell(s.tile, s.layer)
                            : has_holes
                                ? s.fill.claim_open_solid(s.tile, s.layer, interior, open->holes, surveyed.box, window)
                                : s.fill.claim_solid(s.tile, s.layer, interior);
        s.object_voxels[part.object] += claim.voxels;
        s.complex[index] |= !claim.simple;
        (has_holes ? s.seconds.holes : s.seconds.fill) += lap();
    }

    /// At most, in a tile.
    static uint32_t columns_under(const Vertex& a, const Vertex& b, const Vertex& c) {
        const int64_t x = int64_t{std::max({a.x, b.x, c.x})} - std::min({a.x, b.x, c.x});
        const int64_t y = int64_t{std::max({a.y, b.y, c.y})} - std::min({a.y, b.y, c.y});
        auto voxels = [](int64_t extent) { return std::min<uint32_t>(uint32_t(extent >> kFractionBits), kTileSide); };
        return voxels(x) * voxels(y);
    }

    template <bool Cross>
    void cover(const PartView& part, const SurveyedMesh& surveyed, const OpenSurface* open,
               const std::vector<Vertex>& vertices, std::span<const Item> items, const Window& window,
               ObjectLayer& layer) const {
        const MeshView& mesh = *part.mesh;
        layer.set_material(part.material);
        const TurnedPieces* turned = surveyed.turned.get();
        auto close = [&](size_t cap) {
            pulse(10);
            const auto& [a, b, c] = open->caps[cap];
            cross_triangle(a, b, c, window, layer);
        };
        auto add = [&](size_t t) {
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
            pulse(10 + columns_under(a, b, c));
            if (part.material == 0)
                layer.set_material(mesh.materials[t]);
            auto add_to = [&](auto& sink) {
                if (open != nullptr && open->is_shell_only(t))
                    cover_triangle<false>(a, b, c, window, false, sink);
                else if (turned != nullptr && turned->is_turned(t))
                    cover_triangle<Cross>(a, c, b, window, surveyed.inverted, sink);
                else
                    cover_triangle<Cross>(a, b, c, window, surveyed.inverted, sink);
            };
            if (part.material != 0 || !mesh.tints.covers(t)) {
                add_to(layer);
            } else {
                const TintedTriangle triangle(a, b, c, mesh.tints, t);
                TintedLayer tinted(layer, triangle);
                add_to(tinted);
            }
        };
        if (items[0].triangle != kWhole) {
            for (const Item& item : items)
                if (item.triangle < mesh.triangle_count())
                    add(item.triangle);
                else if (item.triangle - mesh.triangle_count() < open->caps.size())
                    close(item.triangle - mesh.triangle_count());
            return;
        }
        for (size_t cap = 0; open != nullptr && cap < open->caps.size(); ++cap)
            close(cap);
        const int64_t x0 = window.x0 * kUnit, x1 = (window.x1 + 1) * kUnit;
        const int64_t y0 = window.y0 * kUnit, y1 = (window.y1 + 1) * kUnit;
        for (size_t t = 0; t < mesh.triangle_count(); ++t) {
            pulse(1);
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
            if (std::max({a.x, b.x, c.x}) >= x0 && std::min({a.x, b.x, c.x}) <= x1 && std::max({a.y, b.y, c.y}) >= y0 &&
                std::min({a.y, b.y, c.y}) <= y1)
                add(t);
        }
    }

    const std::vector<PartView>& parts_;
    const Survey& survey_;
    int side_;
    bool fill_;
};

/// Eight equal octants in a row that share a parent become the parent.
void push_octant(std::vector<uint64_t>& codes, std::vector<uint8_t>& levels, std::vector<uint8_t>& materials,
                 uint64_t code, uint8_t level, uint8_t material) {
    codes.push_back(code);
    levels.push_back(level);
    materials.push_back(material);
    while (codes.size() >= 8 && (codes.back() & 7) == 7) {
        const size_t first = codes.size() - 8;
        for (size_t i = first; i < codes.size(); ++i)
            if (levels[i] != levels.back() || materials[i] != materials.back() || codes[i] >> 3 != codes.back() >> 3)
                return;
        codes.resize(first + 1);
        levels.resize(first + 1);
        materials.resize(first + 1);
        codes[first] >>= 3;
        ++levels[first];
    }
}

template <typename T> void keep(SparseVoxels::Array<T>& to, const std::vector<T>& from) {
    to.allocate(from.size());
    std::copy(from.begin(), from.end(), to.data.get());
}

void gather(std::vector<TileResult>& tiles, SparseVoxels& out, Workers& workers) {
    std::vector<CubeRun> runs;
    for (const TileResult& tile : tiles)
        runs.insert(runs.end(), tile.runs.begin(), tile.runs.end());
    std::sort(runs.begin(), runs.end(), [](const CubeRun& a, const CubeRun& b) { return a.code < b.code; });

    std::vector<size_t> brick_starts;
    size_t bricks = 0;
    std::vector<uint64_t> octant_codes;
    std::vector<uint8_t> octant_levels, octant_materials;
    for (const CubeRun& run : runs) {
        brick_starts.push_back(bricks);
        bricks += run.bricks_to - run.bricks_from;
        const TileResult& tile = tiles[run.tile];
        for (uint32_t i = run.octants_from; i < run.octants_to; ++i)
            push_octant(octant_codes, octant_levels, octant_materials, tile.octant_codes[i], tile.octant_levels[i],
                        tile.octant_materials[i]);
    }
    keep(out.octant_codes, octant_codes);
    keep(out.octant_levels, octant_levels);
    keep(out.octant_materials, octant_materials);

    out.brick_codes.allocate(bricks);
    out.brick_masks.allocate(bricks);
    out.brick_materials.allocate(bricks);
    out.brick_rows.allocate(bricks);
    // Rows keep the order of their bricks.
    std::vector<size_t> row_starts;
    size_t rows = 0;
    for (const CubeRun& run : runs) {
        row_starts.push_back(rows);
        for (uint32_t i = run.bricks_from; i < run.bricks_to; ++i)
            rows += tiles[run.tile].brick_rows[i] >= 0;
    }
    out.cells.allocate(rows);
    workers.run(runs.size(), [&](size_t r, int) {
        const CubeRun& run = runs[r];
        const TileResult& tile = tiles[run.tile];
        size_t to = brick_starts[r], row = row_starts[r];
        for (uint32_t i = run.bricks_from; i < run.bricks_to; ++i, ++to) {
            out.brick_codes.data[to] = tile.brick_codes[i];
            out.brick_masks.data[to] = tile.brick_masks[i];
            out.brick_materials.data[to] = tile.brick_materials[i];
            out.brick_rows.data[to] = -1;
            if (tile.brick_rows[i] >= 0) {
                out.brick_rows.data[to] = int32_t(row);
                out.cells.data[row++] = tile.cells[tile.brick_rows[i]];
            }
        }
    });
}

} // namespace

SparseVoxels voxelize(int depth, const std::vector<PartView>& parts, size_t objects, bool fill, Workers& workers) {
    const int side = 1 << depth;
    Lap lap;
    SparseVoxels out;
    Survey survey = survey_parts(parts, side, fill, workers);

    out.seconds.bin = survey.bin_seconds;
    out.seconds.survey = lap() - survey.bin_seconds;

    std::vector<uint32_t> occupied;
    for (uint32_t t = 0; t + 1 < survey.starts.size(); ++t)
        if (survey.starts[t] < survey.starts[t + 1])
            occupied.push_back(t);
    std::vector<TileResult> results(survey.starts.size() - 1);
    std::vector<std::unique_ptr<Scratch>> scratch(workers.threads());
    const TileWorker worker(parts, survey, side, fill);
    workers.run(occupied.size(), [&](size_t job, int thread) {
        if (!scratch[thread])
            scratch[thread] = std::make_unique<Scratch>(side, objects, parts.size());
        worker.work(occupied[job], *scratch[thread], results[occupied[job]]);
    });

    StageSeconds sum;
    for (const auto& s : scratch)
        if (s)
            sum.add_tiles(s->seconds, 1);
    if (sum.of_tiles() > 0)
        out.seconds.add_tiles(sum, lap() / sum.of_tiles());
    out.object_voxels.allocate(objects);
    out.object_modes.allocate(objects);
    std::fill_n(out.object_voxels.data.get(), objects, 0);
    std::fill_n(out.object_modes.data.get(), objects, uint8_t(fill ? Mode::exact : Mode::surface));
    for (const auto& s : scratch) {
        if (!s)
            continue;
        for (size_t i = 0; i < objects; ++i)
            out.object_voxels.data[i] += s->object_voxels[i];
        for (size_t p = 0; fill && p < parts.size(); ++p)
            if (s->complex[p] != 0)
                out.object_modes.data[parts[p].object] = uint8_t(Mode::winding);
    }
    for (size_t p = 0; fill && p < parts.size(); ++p)
        if (parts[p].kind == PartKind::mesh && !survey.meshes[p].closed)
            out.object_modes.data[parts[p].object] = uint8_t(Mode::winding);
    out.object_turned.allocate(objects);
    std::fill_n(out.object_turned.data.get(), objects, 0);
    for (size_t p = 0; p < parts.size(); ++p)
        if (survey.meshes[p].turned) {
            out.object_turned.data[parts[p].object] += survey.meshes[p].turned->count;
            if (survey.meshes[p].closed && fill)
                out.object_modes.data[parts[p].object] = uint8_t(Mode::turned);
        }
    for (size_t p = 0; fill && p < parts.size(); ++p)
        if (parts[p].kind == PartKind::mesh && survey.meshes[p].boundary && survey.meshes[p].boundary->stands_open)
            out.object_modes.data[parts[p].object] = uint8_t(Mode::open);
    scratch.clear();
    survey = {}; // memory stands highest in what follows
    gather(results, out, workers);
    out.seconds.gather = lap();
    return out;
}

} // namespace voxrt
