#include "dag_counts.h"

#include "mirror_pool.h"
#include "occupancy_dag.h"

#include <voxrt/voxelize/interrupt.h>

#include <bit>
#include <unordered_map>

namespace voxrt::octree {
namespace {

class MirroredBlocks {
public:
    explicit MirroredBlocks(const Memory& memory) : memory_(memory) {}

    Word reference(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        if (const auto known = references_.find(word); known != references_.end())
            return known->second;
        work_.count_step();
        Block octants;
        for (unsigned octant = 0; octant < 8; ++octant)
            octants[octant] = reference(memory_.child(word, octant, level), level - 1);
        const Word made = pool_.intern(octants);
        references_.emplace(word, made);
        return made;
    }

    std::size_t count() const { return pool_.size(); }

private:
    Memory memory_;
    MirrorPool pool_;
    std::unordered_map<Word, Word> references_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

// The bit of voxel (0, 0, 0) in the cube of 2 voxels per side that is an octant of a bitmap.
constexpr unsigned first_bit(unsigned octant) { return 2 * (octant & 1) + 8 * (octant >> 1 & 1) + 32 * (octant >> 2); }

constexpr unsigned bit_within(unsigned octant) { return (octant & 1) + 4 * (octant >> 1 & 1) + 16 * (octant >> 2); }

// Counts a graph: downwards where its nodes stand, upwards which are mirrors of one another.
class DagCounts {
public:
    DagCounts(const Words& words, unsigned depth)
        : words_(words), levels_(depth + 1), level_(words.size()), places_(words.size()) {}

    std::vector<DagLevel> levels() {
        level_[0] = levels_.size() - 1;
        places_[0] = 1;
        std::vector<std::size_t> nodes;
        for (std::size_t address = 0; address < words_.size(); address += size_of(address)) {
            nodes.push_back(address);
            count_places(address);
        }
        references_.resize(words_.size());
        for (; !nodes.empty(); nodes.pop_back())
            count_mirrored(nodes.back());
        return levels_;
    }

private:
    std::size_t size_of(std::size_t address) const {
        return level_[address] == kBitmapLevel ? 2 : 1 + std::popcount(words_[address]);
    }

    std::uint64_t bits_of(std::size_t address) const {
        return words_[address] | std::uint64_t{words_[address + 1]} << 32;
    }

    void count_places(std::size_t address) {
        const std::size_t size = size_of(address);
        const std::uint64_t places = places_[address];
        DagLevel& counts = levels_[level_[address]];
        counts.tree_nodes += places;
        counts.tree_words += places * size;
        counts.nodes += 1;
        counts.words += size;
        if (level_[address] != kBitmapLevel) {
            for (std::size_t i = 1; i < size; ++i) {
                level_[words_[address + i]] = level_[address] - 1;
                places_[words_[address + i]] += places;
            }
            return;
        }
        constexpr std::uint64_t cube = 0x00330033;
        for (unsigned octant = 0; octant < 8; ++octant)
            levels_[1].tree_nodes += (bits_of(address) >> first_bit(octant) & cube) != 0 ? places : 0;
        levels_[0].tree_nodes += places * std::popcount(bits_of(address));
    }

    void count_mirrored(std::size_t address) {
        Block octants;
        octants.fill(kEmpty);
        const bool bitmap = level_[address] == kBitmapLevel;
        std::size_t next = address;
        for (unsigned octant = 0; octant < 8; ++octant) {
            if (bitmap)
                octants[octant] = cube_of_two(bits_of(address) >> first_bit(octant));
            else if (words_[address] >> octant & 1)
                octants[octant] = references_[words_[++next]];
        }
        references_[address] = pool_.intern(octants);
        if (first_of_its_kind(references_[address], level_[address])) {
            levels_[level_[address]].mirrored_nodes += 1;
            levels_[level_[address]].mirrored_words += size_of(address);
        }
    }

    Word cube_of_two(std::uint64_t bits) {
        Block voxels;
        for (unsigned octant = 0; octant < 8; ++octant)
            voxels[octant] = leaf(bits >> bit_within(octant) & 1);
        return pool_.intern(voxels);
    }

    // Cubes of several sizes have one reference where they look alike. A cube all of which is solid is a leaf.
    bool first_of_its_kind(Word reference, unsigned level) {
        seen_.resize(pool_.size() + 1);
        std::uint32_t& levels = seen_[is_leaf(reference) ? 0 : 1 + reference / 8];
        const std::uint32_t bit = 1u << level;
        const bool first = (levels & bit) == 0;
        levels |= bit;
        return first;
    }

    const Words& words_;
    std::vector<DagLevel> levels_;
    std::vector<unsigned> level_;       // of the node at an address
    std::vector<std::uint64_t> places_; // where it stands in the tree without sharing
    std::vector<Word> references_;      // its own
    std::vector<std::uint32_t> seen_;   // by number + 1, the levels
    MirrorPool pool_;
};

} // namespace

std::vector<DagLevel> dag_levels(const Memory& memory) {
    const Words words = occupancy_dag(memory);
    return words.empty() ? std::vector<DagLevel>(memory.depth + 1) : DagCounts(words, memory.depth).levels();
}

std::size_t mirrored_blocks(const Memory& memory) {
    MirroredBlocks blocks(memory);
    blocks.reference(memory.root(), memory.depth);
    return blocks.count();
}

} // namespace voxrt::octree
