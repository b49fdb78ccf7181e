// Which bricks may stand for which, and what is seen of it.
//
// That one subtree of a shared octree may stand for others that resemble it is the idea of van der Laan, Scandolo and
// Eisemann, "Lossy Geometry Compression for High Resolution Voxel Scenes" (2020). Here a stand-in holds every solid
// cell of what it stands for, so that no wall gets a hole, and its price is how it looks.
#pragma once

#include <unordered_map>
#include <vector>

#include "appearance.h"
#include "brick.h"
#include "memory.h"

namespace voxrt::octree {

/// One end of a pair of brick and stand-in, and the pair's cost in all the octants that show the brick.
struct Match {
    std::uint64_t cost;
    std::uint32_t brick;
};

/// Bricks of 8x8x8 cells of side 2**finest and their possible stand-ins: the bricks themselves; each made coarser by
/// one and by two levels; for few bricks also each, and each made coarser by a level, with nearly full 4x4x4 parts
/// filled up; and the uniform ones, which cost no block. Bounded by the pairs of bricks that hold one another.
class StandIns {
public:
    /// `hidden` are the hidden voxels of `base` (hidden.h): octants that nobody sees change for less. The same whatever
    /// the number of threads.
    StandIns(const Memory& base, const Memory& hidden, unsigned finest, const SightCosts& costs);

    std::uint32_t patterns() const { return static_cast<std::uint32_t>(octants_.size()); }
    std::uint32_t count() const { return static_cast<std::uint32_t>(bricks_.size()); }
    std::uint32_t pattern(Word block) const { return pattern_of_.at(block); }
    bool uniform(std::uint32_t i) const { return is_leaf(nodes_[i]); }

    /// A pattern or a mere coarser version of one, and not filled up here and there.
    bool plain(std::uint32_t i) const { return i < plain_; }

    /// By pattern: its stand-ins, the cheapest first. By stand-in: the patterns that it may stand for.
    const std::vector<Match>& choices(std::uint32_t pattern) const { return choices_[pattern]; }
    const std::vector<Match>& users(std::uint32_t i) const { return users_[i]; }

    /// The stand-in in `pool()`, and the numbers of the different blocks below it.
    Node node(std::uint32_t i) const { return nodes_[i]; }
    const std::vector<Node>& parts(std::uint32_t i) const { return parts_[i]; }
    BlockPool& pool() { return pool_; }

private:
    std::uint32_t add(const Cells512& cells);
    void read_patterns(const Memory& base, const Memory& hidden, unsigned level);
    void add_coarser();
    void find_parts();
    void match(const SightCosts& costs);
    std::vector<Match> match(std::uint32_t pattern, const SightCosts& costs) const;

    std::vector<Brick> bricks_; // patterns first
    std::vector<Node> nodes_;
    std::unordered_map<Node, std::uint32_t> numbers_;
    std::unordered_map<Word, std::uint32_t> pattern_of_;
    std::vector<std::uint64_t> octants_;             // that show a pattern
    std::vector<std::uint64_t> visible_;             // of those, not hidden
    std::vector<std::vector<std::uint32_t>> always_; // stand-ins of a pattern however dear
    std::uint32_t plain_ = 0;
    std::vector<std::uint32_t> ascending_; // stand-ins, those with the fewest solid cells first
    std::vector<Mask512> masks_;           // theirs, side by side since most are looked at and no more
    std::vector<std::vector<Node>> parts_;
    std::vector<std::vector<Match>> choices_;
    std::vector<std::vector<Match>> users_;
    BlockPool pool_;
    BrickBuilder builder_{pool_};
};

} // namespace voxrt::octree
