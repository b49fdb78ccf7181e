#include "voxelizer.h"

#include "../rules/lone_thin_parts.h"
#include "../rules/rule_voxels.h"
#include "../rules/thin_parts.h"
#include "../vectors/instruction_sets.h"
#include "block_areas.h"
#include "gathered_tiles.h"
#include "gathered_volumes.h"
#include "tile_worker.h"

#include <optional>

namespace voxrt::voxelize {
namespace {

/// Bits 0, 2, 4 … of a Morton code in two dimensions.
uint32_t every_other_bit(uint64_t code) {
    uint32_t result = 0;
    for (int bit = 0; bit < 16; ++bit)
        result |= uint32_t(code >> 2 * bit & 1) << bit;
    return result;
}

/// Whether surfaces of parts have several materials. Those with rasters count as if they had.
bool have_several_materials(const std::vector<PartView>& parts) {
    uint8_t first = 0;
    const auto differs = [&first](uint8_t material) {
        first = first == 0 ? material : first;
        return material != first;
    };
    return std::any_of(parts.begin(), parts.end(), [&differs](const PartView& part) {
        if (part.material != 0)
            return differs(part.material);
        const MeshView& mesh = *part.mesh;
        return !mesh.rasters.sizes.empty() || std::any_of(mesh.materials.begin(), mesh.materials.end(), differs);
    });
}

/// Adds what the threads found of all objects, and forgets it.
void tally_objects(const std::vector<PartView>& parts, std::vector<std::unique_ptr<Scratch>>& scratch,
                   std::vector<ObjectTally>& out) {
    for (const auto& s : scratch) {
        if (!s)
            continue;
        for (size_t i = 0; i < out.size(); ++i)
            out[i].add(
                {s->object_voxels[i], s->shell_of_open[i], s->inside_of_open[i], 0, s->positive[i], s->negative[i]});
        for (size_t p = 0; p < parts.size(); ++p)
            out[parts[p].object].overlaps_itself |= int64_t{s->overlaps_itself[p]};
        std::fill(s->object_voxels.begin(), s->object_voxels.end(), 0);
        std::fill(s->shell_of_open.begin(), s->shell_of_open.end(), 0);
        std::fill(s->inside_of_open.begin(), s->inside_of_open.end(), 0);
        for (std::vector<uint8_t>* met : {&s->overlaps_itself, &s->positive, &s->negative})
            std::fill(met->begin(), met->end(), uint8_t{0});
    }
}

/// Sets the voxels, modes and notes of all objects.
void report_objects(const std::vector<PartView>& parts, const TriangleBins& bins,
                    const std::vector<ObjectTally>& tallies, SparseVoxels& out) {
    const size_t objects = tallies.size();
    out.object_voxels.resize(objects);
    out.object_modes.resize(objects);
    out.object_notes.assign(objects, ObjectNotes{});
    std::vector<ObjectFindings> found(objects);
    std::vector<Fill> fill_of(objects, Fill::solid);
    for (size_t i = 0; i < objects; ++i) {
        out.object_voxels[i] = tallies[i].voxels;
        found[i].overlaps_itself = tallies[i].overlaps_itself != 0;
    }
    for (size_t p = 0; p < parts.size(); ++p) {
        const MeshAnalysis& mesh = bins.meshes[p];
        ObjectFindings& object = found[parts[p].object];
        fill_of[parts[p].object] = parts[p].fill;
        object.has_boundary |= parts[p].kind == PartKind::mesh && !mesh.closed;
        object.has_open_enclosure |= mesh.hole_caps && mesh.hole_caps->has_open_enclosure;
        if (mesh.orientation) {
            ObjectNotes& notes = out.object_notes[parts[p].object];
            object.has_turned_faces |=
                mesh.closed && (mesh.orientation->components > 0 || mesh.orientation->turned > 0);
            notes[kFlippedComponents] += mesh.orientation->components;
            notes[kTurnedFaces] += mesh.orientation->turned;
            notes[kOneSidedPieces] += mesh.orientation->one_sided;
            notes[kInwardParts] += mesh.orientation->unsure;
        }
    }
    for (size_t i = 0; i < objects; ++i) {
        out.object_modes[i] = uint8_t(object_mode(fill_of[i], found[i]));
        out.object_notes[i][kInwardParts] += tallies[i].positive != 0 && tallies[i].negative != 0;
        out.object_notes[i][kMostlyFilled] = tallies[i].inside_of_open > tallies[i].shell_of_open;
    }
}

} // namespace

SparseVoxels voxelize(int depth, const std::vector<PartView>& parts, size_t objects, int threads, Thin thin,
                      const std::string& instructions) {
    SparseVoxels all;
    all.depth = unsigned(depth);
    all.clear();
    SparseVoxels report = voxelize_in_blocks(
        depth, parts, objects, threads, 1 << depth, [&](SparseVoxels&& block) { all = std::move(block); }, thin,
        instructions);
    all.object_voxels = std::move(report.object_voxels);
    all.object_modes = std::move(report.object_modes);
    all.object_notes = std::move(report.object_notes);
    all.seconds = report.seconds;
    return all;
}

SparseVoxels voxelize_in_blocks(int depth, const std::vector<PartView>& parts, size_t objects, int threads,
                                int block_side, const TakeBlock& take, Thin thin, const std::string& instructions) {
    BlockVoxelizer voxelizer(depth, parts, objects, threads, thin);
    voxelizer.use_instructions(instructions);
    const std::vector<ColumnBlock> blocks = voxelizer.blocks(block_side);
    std::vector<ObjectTally> tallies(objects);
    SparseVoxels report;
    if (blocks.empty())
        report = voxelizer.report(tallies);
    for (const ColumnBlock& block : blocks)
        take(&block == &blocks.back() ? voxelizer.last_block(block, tallies, report) : voxelizer.block(block, tallies));
    report.seconds = voxelizer.seconds();
    return report;
}

struct BlockVoxelizer::State {
    State(int depth, std::vector<PartView> scene_parts, size_t object_count, Thin thin_parts, int threads)
        : depth(unsigned(depth)), side(1 << depth), parts(std::move(scene_parts)), objects(object_count),
          thin(thin_parts), workers(threads), scratch(size_t(workers.threads())) {}

    TileRange tiles_of(const ColumnBlock& block) const {
        const int end = bins.tiles_per_side;
        const int step = std::max(1, (block.side + kTileSide - 1) / kTileSide);
        const int x0 = block.x / kTileSide, y0 = block.y / kTileSide;
        return {x0, std::min(x0 + step, end) - 1, y0, std::min(y0 + step, end) - 1};
    }

    std::vector<uint32_t> occupied(const ColumnBlock& block) const {
        std::vector<uint32_t> found;
        const TileRange range = tiles_of(block);
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x)
                if (const auto t = uint32_t(y * bins.tiles_per_side + x); bins.starts[t] < bins.starts[t + 1])
                    found.push_back(t);
        return found;
    }

    std::vector<TileResult> results(const std::vector<uint32_t>& tiles, std::vector<ObjectTally>& tallies,
                                    bool volumes = false) {
        lap();
        std::vector<TileResult> found(tiles.size());
        const TileWorker worker(parts, bins, side, engine, volumes);
        workers.run(tiles.size(), [&](size_t job, int thread) {
            if (!scratch[size_t(thread)])
                scratch[size_t(thread)] = std::make_unique<Scratch>(
                    side, objects, parts.size(),
                    has_rule && (volumes || !is_lone()) ? std::make_unique<RuleTile>(side, objects > 1, has_materials)
                                                        : nullptr,
                    !volumes && is_lone() ? std::make_unique<LoneRule>(parts[0].rule, thin) : nullptr);
            if (volumes)
                worker.find_volumes(tiles[job], *scratch[size_t(thread)], found[job]);
            else
                worker.work(tiles[job], uint32_t(job), *scratch[size_t(thread)], found[job]);
        });
        StageSeconds sum;
        for (const auto& s : scratch)
            if (s)
                sum.add_tiles(s->seconds, 1);
        StageSeconds fresh = sum;
        fresh.add_tiles(before, -1);
        before = sum;
        if (fresh.of_tiles() > 0)
            seconds.add_tiles(fresh, lap() / fresh.of_tiles());
        tally_objects(parts, scratch, tallies);
        return found;
    }

    SparseVoxels gathered(std::vector<TileResult> found) {
        SparseVoxels out;
        out.depth = depth;
        gather(found, out, workers);
        seconds.gather += lap();
        return out;
    }

    /// The tiles beside a block that a rule looks at.
    std::vector<uint32_t> occupied_around(const ColumnBlock& block) const {
        static_assert(kThinReach < kTileSide);
        const TileRange range = tiles_of(block);
        std::vector<uint32_t> found;
        const int end = bins.tiles_per_side;
        for (int y = std::max(range.y0 - 1, 0); y <= std::min(range.y1 + 1, end - 1); ++y)
            for (int x = std::max(range.x0 - 1, 0); x <= std::min(range.x1 + 1, end - 1); ++x) {
                const bool inside = x >= range.x0 && x <= range.x1 && y >= range.y0 && y <= range.y1;
                if (const auto t = uint32_t(y * end + x); !inside && bins.starts[t] < bins.starts[t + 1])
                    found.push_back(t);
            }
        return found;
    }

    /// Whether a rule is for a single part of one material.
    bool is_lone() const {
        return has_rule && !has_materials && parts.size() == 1 && objects == 1 && parts[0].kind == PartKind::mesh;
    }

    /// The voxels of a block by the rule.
    SparseVoxels ruled(const ColumnBlock& block, std::vector<ObjectTally>& tallies) {
        std::vector<TileResult> found = results(occupied(block), tallies);
        if (!has_rule || (is_lone() && thin == Thin::drop))
            return gathered(std::move(found));
        RuleFindings findings;
        auto take_findings = [&](std::vector<TileResult>& from) {
            for (TileResult& tile : from) {
                findings.bricks.push_back(std::move(tile.rule_bricks));
                findings.owned.insert(findings.owned.end(), tile.owned.begin(), tile.owned.end());
                findings.mixed.insert(findings.mixed.end(), tile.mixed.begin(), tile.mixed.end());
                tile.mixed = {};
                tile.owned = {};
            }
        };
        take_findings(found);
        SparseVoxels around;
        const std::vector<uint32_t> beside = occupied_around(block);
        if (!beside.empty()) {
            std::vector<ObjectTally> of_others(objects);
            std::vector<TileResult> others = results(beside, of_others);
            take_findings(others);
            for (uint32_t i = 0; i < found.size(); ++i)
                others.push_back(found[i]);
            for (uint32_t i = 0; i < others.size(); ++i)
                for (CubeRun& run : others[i].runs)
                    run.tile = i;
            around = gathered(std::move(others));
        }
        SparseVoxels voxels = gathered(std::move(found));
        const TileRange range = tiles_of(block);
        const auto brick = [](int tile) { return uint32_t(tile) * kTileBricks; };
        const BrickArea area{brick(range.x0), brick(range.x1 + 1), brick(range.y0), brick(range.y1 + 1)};
        if (is_lone()) {
            const uint8_t material = parts[0].material != 0 ? parts[0].material : parts[0].mesh->materials[0];
            tallies[0].voxels += add_thin_parts(voxels, beside.empty() ? voxels : around, std::move(findings.bricks),
                                                area, material, workers);
            seconds.fill += lap();
            return voxels;
        }
        std::vector<int64_t> lost(objects, 0);
        const TileAreas tiles(parts, bins, side);
        apply_rule(
            voxels, beside.empty() ? voxels : around, std::move(findings), area, thin,
            [&](std::span<const uint64_t> codes) { return find_areas(tiles, bins.tiles_per_side, codes, workers); },
            lost, workers);
        for (size_t i = 0; i < objects; ++i)
            tallies[i].voxels -= lost[i];
        seconds.fill += lap();
        return voxels;
    }

    unsigned depth;
    int side;
    std::vector<PartView> parts;
    size_t objects;
    Thin thin;
    bool has_rule = false;      // some part has another rule than `touch`
    bool has_materials = false; // several, with a rule
    CoverageEngine engine = coverage_engines().front();
    Workers workers;
    TriangleBins bins;
    std::vector<std::unique_ptr<Scratch>> scratch;
    Stopwatch lap;
    StageSeconds seconds, before;
};

BlockVoxelizer::BlockVoxelizer(int depth, std::vector<PartView> parts, size_t objects, int threads, Thin thin,
                               std::span<const uint8_t> wanted)
    : state_(std::make_unique<State>(depth, std::move(parts), objects, thin, threads)) {
    State& s = *state_;
    for (const PartView& part : s.parts)
        s.has_rule |= part.rule != Rule::touch;
    s.has_materials = s.has_rule && have_several_materials(s.parts);
    s.bins = bin_triangles(s.parts, wanted, s.side, s.workers);
    s.seconds.bin = s.bins.seconds;
    s.seconds.analysis = s.lap() - s.bins.seconds;
}

BlockVoxelizer::~BlockVoxelizer() = default;

void BlockVoxelizer::use_threads(int threads) {
    state_->workers = Workers(threads);
    state_->scratch.resize(std::max(state_->scratch.size(), size_t(state_->workers.threads())));
}

void BlockVoxelizer::use_instructions(const std::string& instructions) {
    state_->engine = engine_of(coverage_engines(), instructions);
}

std::vector<ColumnBlock> BlockVoxelizer::blocks(int block_side) const {
    const int tiles = state_->bins.tiles_per_side;
    const int step = std::clamp((block_side + kTileSide - 1) / kTileSide, 1, tiles);
    const int per_side = (tiles + step - 1) / step;
    uint64_t codes = 1; // of blocks, in Morton order
    while (codes < uint64_t(per_side))
        codes *= 2;
    codes *= codes;
    std::vector<ColumnBlock> found;
    for (uint64_t code = 0; code < codes; ++code) {
        const int x = int(every_other_bit(code)) * step, y = int(every_other_bit(code >> 1)) * step;
        const ColumnBlock block{x * kTileSide, y * kTileSide, step * kTileSide};
        if (x < tiles && y < tiles && !state_->occupied(block).empty())
            found.push_back(block);
    }
    return found;
}

std::vector<uint8_t> BlockVoxelizer::objects_of(const ColumnBlock& block) const {
    const TriangleBins& bins = state_->bins;
    std::vector<uint8_t> found(state_->objects, 0);
    std::vector<uint32_t> tiles = state_->occupied(block);
    if (state_->has_rule) {
        const std::vector<uint32_t> beside = state_->occupied_around(block);
        tiles.insert(tiles.end(), beside.begin(), beside.end());
    }
    for (const uint32_t tile : tiles)
        for (uint32_t i = bins.starts[tile]; i < bins.starts[tile + 1]; ++i)
            found[state_->parts[bins.triangles[i].part].object] = 1;
    return found;
}

SparseVoxels BlockVoxelizer::block(const ColumnBlock& block, std::vector<ObjectTally>& tallies) {
    return state_->ruled(block, tallies);
}

SparseVoxels BlockVoxelizer::last_block(const ColumnBlock& block, std::vector<ObjectTally>& tallies,
                                        SparseVoxels& report) {
    if (state_->has_rule) {
        SparseVoxels last = state_->ruled(block, tallies);
        report = this->report(tallies);
        return last;
    }
    std::vector<TileResult> results = state_->results(state_->occupied(block), tallies);
    report = this->report(tallies);
    state_->scratch.clear(); // the peak of memory use is in what follows
    state_->bins = {};
    return state_->gathered(std::move(results));
}

SparseVoxels BlockVoxelizer::report(const std::vector<ObjectTally>& tallies) const {
    SparseVoxels out;
    out.depth = state_->depth;
    out.clear();
    report_objects(state_->parts, state_->bins, tallies, out);
    return out;
}

ObjectVolumes find_volumes(int depth, std::vector<PartView> parts, size_t objects, int threads,
                           const std::string& instructions) {
    for (PartView& part : parts) {
        part.rule = Rule::half;
        part.fill = Fill::solid;
    }
    BlockVoxelizer voxelizer(depth, parts, objects, threads);
    voxelizer.use_instructions(instructions);
    return voxelizer.volumes();
}

ObjectVolumes BlockVoxelizer::volumes() {
    State& s = *state_;
    ObjectVolumes out;
    out.known.assign(s.objects, 1);
    for (size_t p = 0; p < s.parts.size(); ++p) {
        const PartKind kind = s.parts[p].kind;
        if (kind == PartKind::ball || kind == PartKind::ellipsoid ||
            (kind == PartKind::mesh && !s.bins.meshes[p].closed))
            out.known[s.parts[p].object] = 0;
    }
    std::vector<ObjectTally> tallies(s.objects);
    std::vector<TileResult> tiles = s.results(s.occupied({0, 0, s.side}), tallies, true);
    const std::vector<size_t> counts = gather_volumes(tiles, out, s.workers);
    for (size_t object = 0; object < s.objects; ++object)
        out.whole.push_back(tallies[object].voxels - int64_t(counts[object]));
    return out;
}

const StageSeconds& BlockVoxelizer::seconds() const { return state_->seconds; }

} // namespace voxrt::voxelize
