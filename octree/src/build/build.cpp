#include "build.h"

#include "../pool/breadth_first.h"
#include "../pool/shared_block_pool.h"
#include "brick.h"
#include "octree_builder.h"

#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace voxrt::octree {
namespace {

using voxelize::VoxelsView;

constexpr unsigned kBrickLevel = 3;

[[noreturn]] void refuse(const char* row, std::size_t index, const char* problem) {
    throw std::invalid_argument(std::string(row) + " " + std::to_string(index) + ": " + problem);
}

// Bit i of the result says whether byte i of `eight` is not zero.
std::uint8_t solid_bits(std::uint64_t eight) {
    constexpr std::uint64_t low7 = 0x7F7F7F7F7F7F7F7Fu;
    const std::uint64_t high = (((eight & low7) + low7) | eight) & ~low7;
    return static_cast<std::uint8_t>((high >> 7) * 0x0102040810204080u >> 56);
}

bool cells_match_mask(const std::uint8_t* cells, const std::uint64_t* mask) {
    std::uint64_t difference = 0;
    for (unsigned word = 0; word < 8; ++word) {
        std::uint64_t solid = 0;
        for (unsigned group = 0; group < 8; ++group) {
            std::uint64_t eight;
            std::memcpy(&eight, cells + 64 * word + 8 * group, 8);
            solid |= std::uint64_t{solid_bits(eight)} << (8 * group);
        }
        difference |= solid ^ mask[word];
    }
    return difference == 0;
}

using Writer = SharedBlockPool::Writer;
using Bricks = BrickBuilderFor<Writer>;

void check_brick(const VoxelsView& voxels, std::size_t i) {
    const std::uint64_t* mask = voxels.brick_masks + 8 * i;
    std::uint64_t any = 0;
    for (unsigned word = 0; word < 8; ++word)
        any |= mask[word];
    if (any == 0)
        refuse("brick", i, "is empty");
    if (voxels.depth < kBrickLevel) {
        std::uint64_t beyond = voxels.depth == 1 ? mask[0] >> 8 : 0;
        for (unsigned word = 1; word < 8; ++word)
            beyond |= mask[word];
        if (beyond != 0)
            refuse("brick", i, "has voxels outside the grid");
    }
    const std::int32_t row = voxels.brick_rows[i];
    if (row < 0) {
        if (voxels.brick_materials[i] == 0)
            refuse("brick", i, "has neither a material nor a row of cells");
        return;
    }
    if (static_cast<std::size_t>(row) >= voxels.rows)
        refuse("brick", i, "refers to a row of cells that is not there");
    if (!cells_match_mask(voxels.cells + 512 * static_cast<std::size_t>(row), mask))
        refuse("brick", i, "has cells that contradict its mask");
}

// The children of a brick in a world of at least 8 voxels per side.
Block brick_children(const VoxelsView& voxels, std::size_t i, Bricks& builder) {
    check_brick(voxels, i);
    const std::int32_t row = voxels.brick_rows[i];
    return row < 0 ? builder.children_from_mask(voxels.brick_masks + 8 * i, voxels.brick_materials[i])
                   : builder.children_from_cells(voxels.cells + 512 * static_cast<std::size_t>(row));
}

// A world of less than 8 voxels per side, which is one brick.
Node small_world(const VoxelsView& voxels, std::size_t i, Bricks& builder) {
    check_brick(voxels, i);
    const std::uint64_t mask = voxels.brick_masks[8 * i];
    const std::int32_t row = voxels.brick_rows[i];
    if (row < 0)
        return voxels.depth == 1 ? builder.from_mask8(static_cast<std::uint8_t>(mask), voxels.brick_materials[i])
                                 : builder.from_mask64(mask, voxels.brick_materials[i]);
    const std::uint8_t* cells = voxels.cells + 512 * static_cast<std::size_t>(row);
    return voxels.depth == 1 ? builder.from_cells8(cells) : builder.from_cells64(cells);
}

// Octants on their way to an octree. A brick waits while the place of its block is fetched from memory.
template <typename Builder> class Waiting {
public:
    Waiting(Writer& pool, Builder& octree) : pool_(pool), octree_(octree) {}

    void add_brick(std::uint64_t code, const Block& children) {
        Entry& entry = next();
        entry.level = kBrickLevel;
        entry.code = code;
        entry.children = children;
        entry.hash = pool_.prepare(children);
        entry.whole = false;
    }
    void add(unsigned level, std::uint64_t code, Node node) {
        Entry& entry = next();
        entry.level = level;
        entry.code = code;
        entry.children[0] = node;
        entry.whole = true;
    }
    void finish() {
        for (std::size_t i = 0; i < kPlaces; ++i)
            next();
        octree_.finish();
    }

private:
    static constexpr std::size_t kPlaces = 16;
    struct Entry {
        std::uint64_t code, hash;
        Block children;
        unsigned level;
        bool whole; // the node is children[0]
    };

    // The place of the oldest, which moves on.
    Entry& next() {
        Entry& entry = entries_[count_ % kPlaces];
        if (count_++ >= kPlaces && entry.level <= kMaxDepth) {
            octree_.add(entry.level, entry.code,
                        entry.whole ? entry.children[0] : pool_.intern(entry.children, entry.hash));
        }
        entry.level = kNone;
        return entry;
    }

    static constexpr unsigned kNone = kMaxDepth + 1;
    Writer& pool_;
    Builder& octree_;
    std::array<Entry, kPlaces> entries_;
    std::size_t count_ = 0;
};

// A run of the Morton curve: positions `begin` … `end` - 1, in bricks, and the first brick and octant there.
struct Chunk {
    std::uint64_t begin;
    std::uint64_t end;
    std::size_t brick;
    std::size_t octant;
};

// Chunks end where octants of this level do, so that no block below that level is shared between two.
constexpr unsigned kChunkLevel = 6;
constexpr std::size_t kChunkBricks = 2048;
constexpr std::uint32_t kChunkWork = 50 * kChunkBricks; // in units of interrupt.h

std::uint64_t octant_begin(const VoxelsView& voxels, std::size_t i) {
    const unsigned level = voxels.octant_levels[i];
    if (level < kBrickLevel || level > voxels.depth)
        refuse("octant", i, "has a level outside 3 ... depth");
    if (voxels.octant_codes[i] >= std::uint64_t{1} << (3 * (voxels.depth - level)))
        refuse("octant", i, "lies outside the grid");
    return voxels.octant_codes[i] << (3 * (level - kBrickLevel));
}

std::vector<Chunk> cut_into_chunks(const VoxelsView& voxels) {
    const std::uint64_t end = voxels.depth <= kBrickLevel ? 1 : std::uint64_t{1} << (3 * (voxels.depth - kBrickLevel));
    std::vector<Chunk> chunks{{0, end, 0, 0}};
    if (voxels.depth <= kChunkLevel)
        return chunks;
    for (std::size_t brick = kChunkBricks; brick < voxels.bricks; brick += kChunkBricks) {
        constexpr unsigned shift = 3 * (kChunkLevel - kBrickLevel);
        const std::uint64_t begin = voxels.brick_codes[brick] >> shift << shift;
        if (begin <= chunks.back().begin || begin >= end)
            continue;
        const std::uint64_t* first = std::lower_bound(voxels.brick_codes, voxels.brick_codes + voxels.bricks, begin);
        std::size_t low = chunks.back().octant;
        for (std::size_t high = voxels.octants; low < high;) {
            const std::size_t middle = low + (high - low) / 2;
            if (octant_begin(voxels, middle) < begin)
                low = middle + 1;
            else
                high = middle;
        }
        chunks.back().end = begin;
        chunks.push_back({begin, end, static_cast<std::size_t>(first - voxels.brick_codes), low});
    }
    return chunks;
}

// Adds the bricks and octants of `chunk` to `octree` in Morton order, up to those where the next chunk starts.
template <typename Builder>
void add_chunk(const VoxelsView& voxels, const Chunk& chunk, std::size_t brick_end, std::size_t octant_end,
               Writer& pool, Bricks& bricks, Builder& octree) {
    Waiting<Builder> waiting(pool, octree);
    std::uint64_t covered = chunk.begin;
    std::size_t brick = chunk.brick;
    std::size_t octant = chunk.octant;
    std::uint64_t next_octant = octant < octant_end ? octant_begin(voxels, octant) : 0;
    while (brick < brick_end || octant < octant_end) {
        if (brick < brick_end && (octant == octant_end || voxels.brick_codes[brick] < next_octant)) {
            const std::uint64_t code = voxels.brick_codes[brick];
            if (code >= chunk.end)
                refuse("brick", brick, "lies outside the grid or out of Morton order");
            if (code < covered)
                refuse("brick", brick, "is out of Morton order or overlaps what came before");
            if (voxels.depth < kBrickLevel)
                waiting.add(voxels.depth, code, small_world(voxels, brick, bricks));
            else
                waiting.add_brick(code, brick_children(voxels, brick, bricks));
            covered = code + 1;
            ++brick;
        } else {
            const unsigned level = voxels.octant_levels[octant];
            if (next_octant < covered)
                refuse("octant", octant, "is out of Morton order or overlaps what came before");
            if (voxels.octant_materials[octant] == 0)
                refuse("octant", octant, "has no material");
            waiting.add(level, voxels.octant_codes[octant], leaf(voxels.octant_materials[octant]));
            covered = next_octant + (std::uint64_t{1} << (3 * (level - kBrickLevel)));
            if (covered > chunk.end)
                refuse("octant", octant, "overlaps what comes after it");
            if (++octant < octant_end)
                next_octant = octant_begin(voxels, octant);
        }
    }
    waiting.finish();
}

// An octant of at least the chunk level.
struct Part {
    unsigned level;
    std::uint64_t code;
    Node node;
};

// What a thread keeps from chunk to chunk.
struct Scratch {
    explicit Scratch(SharedBlockPool& pool) : blocks(pool), bricks(blocks) {}
    Writer blocks;
    Bricks bricks;
};

} // namespace

Words build(const VoxelsView& voxels, int threads) {
    const std::vector<Chunk> chunks = cut_into_chunks(voxels);
    const unsigned top = std::min(voxels.depth, kChunkLevel);
    const voxelize::Workers workers(threads);
    SharedBlockPool pool(voxels.bricks);
    std::vector<std::unique_ptr<Scratch>> scratch(static_cast<std::size_t>(workers.threads()));
    std::vector<std::vector<Part>> parts(chunks.size());
    workers.run(chunks.size(), [&](std::size_t i, int thread) {
        voxelize::count_work(kChunkWork);
        std::unique_ptr<Scratch>& own = scratch[static_cast<std::size_t>(thread)];
        if (!own)
            own = std::make_unique<Scratch>(pool);
        const auto keep = [&](unsigned level, std::uint64_t code, Node node) {
            parts[i].push_back({level, code, node});
        };
        OctreeBuilder octree(own->blocks, top, keep);
        const bool last = i + 1 == chunks.size();
        add_chunk(voxels, chunks[i], last ? voxels.bricks : chunks[i + 1].brick,
                  last ? voxels.octants : chunks[i + 1].octant, own->blocks, own->bricks, octree);
    });
    scratch.clear();

    Writer blocks(pool);
    Node root = kEmpty;
    OctreeBuilder octree(blocks, voxels.depth, [&](unsigned, std::uint64_t, Node node) { root = node; });
    for (const std::vector<Part>& chunk : parts)
        for (const Part& part : chunk)
            octree.add(part.level, part.code, part.node);
    octree.finish();
    return breadth_first_words(pool, root, threads);
}

Words build_points(const std::uint64_t* codes, const std::uint8_t* materials, std::size_t count, unsigned depth) {
    BlockPool pool;
    Node root = kEmpty;
    OctreeBuilder octree(pool, depth, [&](unsigned, std::uint64_t, Node node) { root = node; });
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    std::uint64_t next = 0; // lowest code that may follow
    for (std::size_t i = 0; i < count; ++i) {
        work.count_step();
        if (codes[i] >= std::uint64_t{1} << (3 * depth))
            refuse("voxel", i, "lies outside the grid");
        if (codes[i] < next)
            refuse("voxel", i, "is out of Morton order or repeated");
        if (materials[i] == 0)
            refuse("voxel", i, "has no material");
        octree.add(0, codes[i], leaf(materials[i]));
        next = codes[i] + 1;
    }
    octree.finish();
    return breadth_first_words(pool, root);
}

} // namespace voxrt::octree
