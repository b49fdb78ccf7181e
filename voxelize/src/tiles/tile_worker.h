// Voxelizes one tile: the surfaces of all parts that reach it, what they enclose, and what is solid by itself.
#pragma once

#include "../coverage/centre_crossings.h"
#include "../coverage/ellipsoid.h"
#include "../coverage/half_crossings.h"
#include "../coverage/material_raster.h"
#include "../coverage/vector_coverage.h"
#include "convex_solids.h"
#include "solid_fill.h"
#include "tile_halves.h"
#include "tile_order.h"
#include "triangle_bins.h"
#include "voxelizer.h"

namespace voxrt::voxelize {

/// Parts whose openings exceed this share of their area are noted where they are mostly filled. Those of a scan with
/// pinholes do not.
inline constexpr double kNotedOpening = 0.01;

/// What a thread keeps from tile to tile.
struct Scratch {
    /// `rule`, `lone`: null, or what one of them is to be.
    Scratch(int side, size_t objects, size_t parts, std::unique_ptr<RuleTile> of_rule,
            std::unique_ptr<LoneRule> of_lone)
        : surface(side), tile(side), rule(std::move(of_rule)), lone(std::move(of_lone)), object_voxels(objects, 0),
          shell_of_open(objects, 0), inside_of_open(objects, 0), overlaps_itself(parts, 0), positive(objects, 0),
          negative(objects, 0) {
        fill.use_rule(rule.get(), lone.get());
        if (lone && lone->asks_for_volumes())
            sheets = std::make_unique<ColumnSheets>();
    }
    TileSurface surface;
    TileVoxels tile;
    std::unique_ptr<RuleTile> rule; // these two are null where all parts have `touch`, or else one of them
    std::unique_ptr<LoneRule> lone;
    std::unique_ptr<ColumnSheets> sheets; // where that one asks for volumes
    SolidFill fill;
    TileSorter sorter;
    std::vector<Vertex> vertices;
    std::vector<int64_t> object_voxels;
    std::vector<int64_t> shell_of_open, inside_of_open; // by object: of parts with openings worth a note
    std::vector<uint8_t> overlaps_itself;               // by part: ObjectFindings
    std::vector<uint8_t> positive, negative;            // by object: winding numbers that were met
    StageSeconds seconds;
};

/// Receiver of cover_triangle that holds what it covers: every rule fills surfaces without inside.
class HeldSurface {
public:
    explicit HeldSurface(TileSurface& surface) : surface_(surface) {}
    int side() const { return surface_.side(); }
    void cover(int x, int y, int lo, int hi) { surface_.hold(x, y, lo, hi); }
    void cross(int, int, int, bool) {}

private:
    TileSurface& surface_;
};

class TileWorker : TileParts {
public:
    /// `finds_volumes`: whether find_volumes() is called, or else work().
    TileWorker(const std::vector<PartView>& parts, const TriangleBins& bins, int side, const CoverageEngine& engine,
               bool finds_volumes)
        : TileParts(parts, bins, side), engine_(engine), piece_limit_(finds_volumes ? kFineLimit : kHalfLimit) {}

    /// `slot`: the place of `out` among the results of a block.
    void work(uint32_t index, uint32_t slot, Scratch& s, TileResult& out) const {
        const int tile_x = int(index) % bins_.tiles_per_side, tile_y = int(index) / bins_.tiles_per_side;
        for_each_part(index, s, [](uint32_t) {});
        Stopwatch lap;
        if (s.lone)
            s.object_voxels[0] += take_lone(index, s, out);
        if (!s.tile.empty())
            s.sorter.sort(s.tile, slot, tile_x, tile_y, out);
        if (s.rule)
            if (const std::vector<HalfDoubt> doubts = s.rule->list(s.tile, out.rule_bricks, out.owned, out.mixed);
                !doubts.empty())
                TileHalves(parts_, bins_, side_)
                    .decide(doubts, index, s.rule.get(), s.rule->error_bound(), s.vertices, out.rule_bricks);
        s.seconds.order += lap();
    }

    /// Finds the volumes of each object in one tile, as if it were alone.
    void find_volumes(uint32_t index, Scratch& s, TileResult& out) const {
        uint32_t last = kNone;
        for_each_part(index, s, [&](uint32_t object) {
            if (last != kNone && object != last) {
                s.rule->take_volumes(out.volumes);
                s.tile.clear();
            }
            last = object;
        });
        s.rule->take_volumes(out.volumes);
    }

private:
    /// Takes what a lone part's rule has found in a tile. Returns how many voxels more it fills.
    int64_t take_lone(uint32_t index, Scratch& s, TileResult& out) const {
        int64_t added = 0;
        if (!s.lone->doubts().empty()) {
            TileHalves(parts_, bins_, side_)
                .decide(s.lone->doubts(), index, nullptr, s.lone->error_bound(), s.vertices, s.lone->bricks());
            for (const HalfDoubt& doubt : s.lone->doubts())
                if (const Slices& filled = s.lone->bricks()[doubt.brick].filled; !is_empty(filled))
                    added += s.tile.claim(doubt.column, doubt.k, filled, material_of(parts_[0]), nullptr);
        }
        s.lone->take_bricks(s.tile, out.rule_bricks);
        return added;
    }

    /// The material of what a part encloses.
    static uint8_t material_of(const PartView& part) {
        return part.material != 0 ? part.material : part.mesh->materials[0];
    }

    /// Claims what the parts of a tile cover. `begin`: called with the object of each part before it is claimed.
    template <class Begin> void for_each_part(uint32_t index, Scratch& s, Begin begin) const {
        const int tile_x = int(index) % bins_.tiles_per_side, tile_y = int(index) / bins_.tiles_per_side;
        const Window window{tile_x * kTileSide, std::min(tile_x * kTileSide + kTileSide, side_) - 1, tile_y * kTileSide,
                            std::min(tile_y * kTileSide + kTileSide, side_) - 1, side_ - 1};
        s.tile.clear();
        if (s.rule)
            s.rule->clear(tile_x, tile_y);
        for_each_run(index, [&](uint32_t part, std::span<const BinnedTriangle> triangles) {
            begin(parts_[part].object);
            const size_t listed = triangles[0].triangle != kWholePart   ? triangles.size()
                                  : parts_[part].kind == PartKind::mesh ? parts_[part].mesh->triangle_count()
                                                                        : 0;
            if (s.rule)
                s.rule->begin(part, parts_[part].object, parts_[part].rule, listed);
            if (s.lone)
                s.lone->clear(tile_x, tile_y, listed);
            if (parts_[part].kind == PartKind::mesh) {
                add_mesh(part, triangles, window, s);
            } else {
                Stopwatch lap;
                add_solid(parts_[part], window, s);
                s.seconds.coverage += lap();
            }
        });
    }

    void add_solid(const PartView& part, const Window& window, Scratch& s) const {
        int64_t claimed = 0;
        if (part.kind == PartKind::box)
            claimed = claim_convex(s.tile, s.rule.get(), window, box_of(part), fills(part.fill), part.material);
        else if (part.kind == PartKind::ball)
            claimed = claim_convex(s.tile, s.rule.get(), window, ball_of(part), fills(part.fill), part.material);
        else
            claimed =
                claim_convex(s.tile, s.rule.get(), window, Ellipsoid(part.frame), fills(part.fill), part.material);
        s.object_voxels[part.object] += claimed;
    }

    void add_mesh(uint32_t index, std::span<const BinnedTriangle> triangles, const Window& window, Scratch& s) const {
        const PartView& part = parts_[index];
        const MeshAnalysis& analysis = bins_.meshes[index];
        const std::vector<Vertex>* vertices = &vertices_of(index, s.vertices);
        s.surface.reset(window.x0, window.y0);
        s.surface.note_mixed(s.rule != nullptr);
        Stopwatch lap;
        std::optional<CappedSurface> own;
        const CappedSurface* capped = capped_of(index, *vertices, own);
        s.seconds.holes += lap();
        // Sheets take a surface whose triangles meet along all their edges. Vectors alone find them (not on the page).
        const bool has_sheets = engine_.cover_by_vectors != nullptr && fills(part.fill) && analysis.closed &&
                                analysis.orientation == nullptr && capped == nullptr;
        ColumnSheets* sheets = has_sheets ? s.sheets.get() : nullptr;
        s.fill.use_sheets(sheets);
        if (sheets != nullptr)
            sheets->clear();
        if (fills(part.fill))
            cover<true>(part, analysis, capped, *vertices, triangles, window, part.rule != Rule::touch, sheets,
                        s.surface);
        else
            cover<false>(part, analysis, capped, *vertices, triangles, window, false, nullptr, s.surface);
        if (sheets != nullptr) {
            engine_.find_doubts(*sheets, window.top);
            add_to_sheets(true, *part.mesh, *vertices, triangles, window, *sheets, s.surface);
            place_half_crossings(*sheets, s.lone->error_bound(), s.surface);
            if (sheets->has_doubtful())
                add_to_sheets(false, *part.mesh, *vertices, triangles, window, *sheets, s.surface);
        }
        s.seconds.coverage += lap();
        const bool has_holes = capped != nullptr && !capped->cap_winding.empty();
        if (s.surface.empty() && !has_holes)
            return;
        const uint8_t interior = material_of(part);
        const Claim claim = !fills(part.fill) ? s.fill.claim_shell(s.tile, s.surface)
                            : has_holes ? s.fill.claim_capped_solid(s.tile, s.surface, interior, capped->cap_winding,
                                                                    analysis.box, window)
                                        : s.fill.claim_solid(s.tile, s.surface, interior);
        s.object_voxels[part.object] += claim.voxels;
        s.overlaps_itself[index] |= !claim.simple;
        if (analysis.closed || (analysis.hole_caps && analysis.hole_caps->are_seams())) {
            s.positive[part.object] |= claim.positive;
            s.negative[part.object] |= claim.negative;
        }
        if (has_holes && capped->hole_caps->opening > kNotedOpening) {
            s.shell_of_open[part.object] += claim.shell;
            s.inside_of_open[part.object] += claim.inside;
        }
        (has_holes ? s.seconds.holes : s.seconds.fill) += lap();
    }

    /// An upper bound of the columns of one tile that a triangle covers.
    static uint32_t columns_under(const Vertex& a, const Vertex& b, const Vertex& c) {
        const int64_t x = int64_t{std::max({a.x, b.x, c.x})} - std::min({a.x, b.x, c.x});
        const int64_t y = int64_t{std::max({a.y, b.y, c.y})} - std::min({a.y, b.y, c.y});
        auto voxels = [](int64_t extent) { return std::min<uint32_t>(uint32_t(extent >> kFractionBits), kTileSide); };
        return voxels(x) * voxels(y);
    }

    template <bool Cross>
    void cover(const PartView& part, const MeshAnalysis& analysis, const CappedSurface* capped,
               const std::vector<Vertex>& vertices, std::span<const BinnedTriangle> triangles, const Window& window,
               bool has_rule, ColumnSheets* sheets, TileSurface& surface) const {
        const MeshView& mesh = *part.mesh;
        surface.set_material(part.material);
        const Orientation* orientation = analysis.orientation.get();
        auto add_cap = [&](size_t cap) {
            count_work(10);
            const auto& [a, b, c] = capped->caps[cap];
            cross_triangle(a, b, c, window, surface);
        };
        // The winding number of a capped surface is taken at the sample points, beside the centres: caps may pass
        // these.
        const bool has_caps = capped != nullptr && !capped->cap_winding.empty();
        auto add = [&](size_t t) {
            if (analysis.is_covered(mesh, t))
                return;
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const bool reversed = orientation != nullptr && orientation->is_reversed(t);
            const bool is_shell_only = capped != nullptr && capped->is_shell_only(t);
            const bool counts = !is_shell_only && !(orientation != nullptr && orientation->is_uncounted(t));
            const Vertex &a = vertices[corner[0]], &b = vertices[corner[reversed ? 2 : 1]],
                         &c = vertices[corner[reversed ? 1 : 2]];
            count_work(10 + columns_under(a, b, c));
            if (part.material == 0)
                surface.set_material(mesh.materials[t]);
            auto cover_with = [&](auto& receiver) {
                if (counts && !(Cross && has_rule))
                    cover_triangle<Cross>(a, b, c, window, analysis.inverted, receiver);
                else
                    cover_triangle<false>(a, b, c, window, analysis.inverted, receiver);
            };
            const bool by_vectors = engine_.cover_by_vectors != nullptr &&
                                    (part.material != 0 || !mesh.rasters.has_raster(t)) && fits_vectors(a, b, c);
            Wanted wanted{counts && Cross && !has_rule};
            if (Cross && has_rule) {
                if (is_shell_only) {
                    HeldSurface held(surface);
                    cover_triangle<false>(a, b, c, window, analysis.inverted, held);
                } else {
                    const bool by_volume = part.rule == Rule::half && !has_caps;
                    const bool crosses = counts && !has_caps;
                    const bool has_sheets = sheets != nullptr && counts;
                    if (by_vectors && !is_upright(a, b, c))
                        wanted = {crosses, true, !by_volume || has_sheets};
                    else if (crosses || !by_volume)
                        find_centres(a, b, c, window, crosses, !by_volume, surface);
                    if (has_sheets) {
                        if (wanted.centres)
                            wanted.sheets = sheets;
                        else
                            sheets->doubt(columns_near(a, b, c, window));
                    }
                    if (counts && has_caps)
                        cross_triangle(a, b, c, window, surface);
                    wanted.pieces = sheets == nullptr && counts && by_volume && by_vectors &&
                                    fits_pieces(a, b, c, window.top, piece_limit_);
                    if (sheets == nullptr && counts && by_volume && !wanted.pieces)
                        add_pieces(a, b, c, window, surface);
                }
            }
            if (by_vectors) {
                engine_.cover_by_vectors(a, b, c, window, wanted, surface);
            } else if (part.material != 0 || !mesh.rasters.has_raster(t)) {
                cover_with(surface);
            } else {
                const TriangleRaster raster(a, reversed ? c : b, reversed ? b : c, mesh.rasters, t); // as authored
                RasterSurface rastered(surface, raster);
                cover_with(rastered);
            }
        };
        for_each_triangle(mesh, capped, vertices, triangles, window, add, add_cap);
    }

    /// Adds volumes to sheets, or pieces in doubtful columns to the surface.
    void add_to_sheets(bool halves, const MeshView& mesh, const std::vector<Vertex>& vertices,
                       std::span<const BinnedTriangle> triangles, const Window& window, ColumnSheets& sheets,
                       TileSurface& surface) const {
        const auto add = [&](size_t t) {
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
            count_work(10);
            const bool sheet = faces_down(a, b, c);
            if (!ColumnSheets::has_any(halves ? sheets.halved[sheet] : sheets.doubtful,
                                       columns_near(a, b, c, window)) ||
                is_upright(a, b, c))
                return;
            if (fits_vectors(a, b, c) && fits_pieces(a, b, c, window.top, piece_limit_)) {
                (halves ? engine_.add_to_halved : engine_.add_to_doubtful)(a, b, c, window, sheets, surface);
            } else {
                SheetPieces receiver(sheets, sheet, halves, window, surface);
                add_pieces(a, b, c, window, receiver);
            }
        };
        for_each_triangle(mesh, nullptr, vertices, triangles, window, add, [](size_t) {});
    }

    /// The columns that a triangle may cover, from the tile's lowest one. One further at each side: a triangle in a
    /// plane between voxels counts for those beside it.
    static ColumnBox columns_near(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w) {
        const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
        const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
        return {std::max(voxel_below(low_x), w.x0) - w.x0, std::min(voxel_floor(high_x), w.x1) - w.x0,
                std::max(voxel_below(low_y), w.y0) - w.y0, std::min(voxel_floor(high_y), w.y1) - w.y0};
    }

    /// Calls add(t) with the triangles of a tile, and add_cap(cap) with its caps.
    template <class Add, class AddCap>
    static void for_each_triangle(const MeshView& mesh, const CappedSurface* capped,
                                  const std::vector<Vertex>& vertices, std::span<const BinnedTriangle> triangles,
                                  const Window& window, const Add& add, const AddCap& add_cap) {
        if (triangles[0].triangle != kWholePart) {
            for (const BinnedTriangle& binned : triangles)
                if (binned.triangle < mesh.triangle_count())
                    add(binned.triangle);
                else if (binned.triangle - mesh.triangle_count() < capped->caps.size())
                    add_cap(binned.triangle - mesh.triangle_count());
            return;
        }
        for (size_t cap = 0; capped != nullptr && cap < capped->caps.size(); ++cap)
            add_cap(cap);
        const int64_t x0 = window.x0 * kUnit, x1 = (window.x1 + 1) * kUnit;
        const int64_t y0 = window.y0 * kUnit, y1 = (window.y1 + 1) * kUnit;
        for (size_t t = 0; t < mesh.triangle_count(); ++t) {
            count_work(1);
            const int32_t* corner = mesh.triangles.data() + 3 * t;
            const Vertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
            if (std::max({a.x, b.x, c.x}) >= x0 && std::min({a.x, b.x, c.x}) <= x1 && std::max({a.y, b.y, c.y}) >= y0 &&
                std::min({a.y, b.y, c.y}) <= y1)
                add(t);
        }
    }

    CoverageEngine engine_;
    double piece_limit_;
};

} // namespace voxrt::voxelize
