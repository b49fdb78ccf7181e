// Which bricks may represent which, and what that changes of the picture.
//
// That one subtree of a shared octree may represent others that resemble it is the idea of van der Laan, Scandolo and
// Eisemann, "Lossy Geometry Compression for High Resolution Voxel Scenes" (2020). Here a representative holds every
// solid cell of the bricks that it represents, so that no wall gets a hole, and its cost is how it looks
// (appearance.h).
#pragma once

#include "../build/brick.h"
#include "../words/memory.h"
#include "appearance.h"

#include <unordered_map>
#include <vector>

namespace voxrt::octree {

/// One end of a pair of a pattern and a representative, and the pair's cost in all the octants that show the pattern.
struct Match {
    std::uint64_t cost;
    std::uint32_t brick; // number of the other end
};

/// The patterns of a memory (its different bricks of 8x8x8 cells of side 2**finest) and their possible representatives:
/// the patterns themselves; each coarsened by one and by two levels; where there are few patterns also each, and each
/// coarsened by a level, with nearly full 4x4x4 parts filled; and the uniform bricks, which cost no block. Patterns
/// have the lowest numbers among the representatives.
///
/// Cost: the pairs of bricks that hold one another, within fixed limits.
class Representatives {
public:
    /// `hidden` are the hidden voxels of `base` (hidden.h): octants that no ray reaches change for less. The result
    /// does not depend on the number of threads.
    Representatives(const Memory& base, const Memory& hidden, unsigned finest, const AppearanceCosts& costs);

    std::uint32_t patterns() const { return static_cast<std::uint32_t>(octants_.size()); }
    std::uint32_t count() const { return static_cast<std::uint32_t>(bricks_.size()); }

    /// The number of the pattern of a block of `base`.
    std::uint32_t pattern(Word block) const { return pattern_of_.at(block); }

    /// Whether a representative is uniform: it holds every brick and costs no block.
    bool uniform(std::uint32_t i) const { return is_leaf(nodes_[i]); }

    /// Whether it is a pattern or a coarsened one, without filled parts.
    bool unfilled(std::uint32_t i) const { return i < unfilled_; }

    /// By pattern: its representatives, the cheapest first.
    const std::vector<Match>& choices(std::uint32_t pattern) const { return choices_[pattern]; }

    /// By representative: the patterns that it may represent.
    const std::vector<Match>& represented(std::uint32_t i) const { return represented_[i]; }

    /// The representative in pool(), and the numbers of the different blocks below it.
    Node node(std::uint32_t i) const { return nodes_[i]; }
    const std::vector<Node>& blocks(std::uint32_t i) const { return blocks_[i]; }
    BlockPool& pool() { return pool_; }

private:
    std::uint32_t add(const Cells512& cells);
    void read_patterns(const Memory& base, const Memory& hidden, unsigned level);
    void add_coarsened();
    void find_blocks();
    void match_all(const AppearanceCosts& costs);
    std::vector<Match> match(std::uint32_t pattern, const AppearanceCosts& costs) const;

    std::vector<BrickAppearance> bricks_; // patterns first
    std::vector<Node> nodes_;
    std::unordered_map<Node, std::uint32_t> numbers_;
    std::unordered_map<Word, std::uint32_t> pattern_of_;
    std::vector<std::uint64_t> octants_;                // how many octants show a pattern
    std::vector<std::uint64_t> visible_;                // how many of these are visible
    std::vector<std::vector<std::uint32_t>> fallbacks_; // representatives of a pattern whatever they cost
    std::uint32_t unfilled_ = 0;
    std::vector<std::uint32_t> ascending_; // representatives, those with the fewest solid cells first
    std::vector<Mask512> masks_;           // the masks of these: of most bricks nothing else is read
    std::vector<std::vector<Node>> blocks_;
    std::vector<std::vector<Match>> choices_;
    std::vector<std::vector<Match>> represented_;
    BlockPool pool_;
    BrickBuilder builder_{pool_};
};

} // namespace voxrt::octree
