#include "budget.h"

#include <algorithm>
#include <map>
#include <ranges>
#include <set>
#include <unordered_map>

#include "breadth_first.h"
#include "brick.h"
#include "hidden.h"
#include "levels.h"

namespace voxrt::octree {
namespace {

using Fine = Pattern<1>;   // 4x4x4 cells of the finest side
using Coarse = Pattern<8>; // 8x8x8

constexpr std::uint64_t kMostOctants = std::uint64_t{1} << 40; // more weigh the same; keeps costs in 64 bits

class Merging {
public:
    Merging(const Memory& base, const Memory& hidden, unsigned finest, const RecolourCosts& recolour,
            std::uint64_t fine_price, std::uint64_t coarse_price)
        : base_(base), hidden_(hidden), fine_level_(finest + 2), coarse_level_(finest + 3), recolour_(recolour),
          fine_price_(fine_price), coarse_price_(coarse_price) {}

    std::vector<Word> words() {
        const std::vector<std::vector<Occurrence>> levels = blocks_by_level(base_);
        if (fine_level_ <= base_.depth)
            merge_fine(levels[fine_level_]);
        if (coarse_level_ <= base_.depth)
            merge_coarse(levels[coarse_level_]);
        return breadth_first_words(pool_, node(base_.root(), base_.depth));
    }

private:
    using Cells64 = std::array<std::uint8_t, 64>;
    using Cells512 = std::array<std::uint8_t, 512>;

    // The cells of an octant, Morton order; `count` = 8 ** levels above the finest side.
    void read_cells(Word word, unsigned level, std::uint8_t* cells, unsigned count) const {
        if (is_leaf(word)) {
            std::fill_n(cells, count, material(word));
            return;
        }
        for (unsigned octant = 0; octant < 8; ++octant)
            read_cells(base_.child(word, octant, level), level - 1, cells + octant * (count / 8), count / 8);
    }

    template <unsigned Words> static Pattern<Words> pattern_of(const std::array<std::uint8_t, 64 * Words>& cells) {
        Pattern<Words> pattern{{}, cells, 0, 0};
        for (unsigned cell = 0; cell < 64 * Words; ++cell)
            pattern.mask[cell / 64] |= std::uint64_t{cells[cell] != 0} << (cell % 64);
        return pattern;
    }

    // What the patterns become in a world that is coarser by one level, ascending by cells.
    static std::vector<Fine> coarser(const std::vector<Fine>& patterns) {
        std::set<Cells64> seen;
        for (Cells64 cells : (patterns | std::views::transform(&Fine::cells))) {
            for (unsigned octant = 0; octant < 8; ++octant) {
                std::uint8_t* eight = cells.data() + 8 * octant;
                std::array<unsigned, 256> counts{};
                for (unsigned cell = 0; cell < 8; ++cell)
                    counts[eight[cell]] += eight[cell] != 0;
                std::fill_n(eight, 8, std::max_element(counts.begin(), counts.end()) - counts.begin());
            }
            seen.insert(cells);
        }
        std::vector<Fine> result;
        for (const Cells64& cells : seen)
            result.push_back(pattern_of<1>(cells));
        return result;
    }

    // Equal patterns once, their octants summed, ascending by cells; `cells_of(block)` says what a block shows.
    template <unsigned Words, typename CellsOf>
    std::map<std::array<std::uint8_t, 64 * Words>, std::array<std::uint8_t, 64 * Words>>
    stand_ins(const std::vector<Occurrence>& blocks, unsigned level, CellsOf cells_of) {
        using Cells = std::array<std::uint8_t, 64 * Words>;
        const std::unordered_map<Word, std::uint64_t> hidden = hidden_octants(base_, hidden_, level);
        std::map<Cells, std::pair<std::uint64_t, std::uint64_t>> sums; // octants, visible ones
        for (unsigned id = 1; id < 256; ++id)
            if (used_[id]) {
                Cells uniform;
                uniform.fill(static_cast<std::uint8_t>(id));
                sums[uniform] = {kFree, 0};
            }
        for (const Occurrence& block : blocks) {
            auto& [octants, visible] = sums[cells_of(block.block)];
            if (octants == kFree)
                continue;
            const auto entry = hidden.find(block.block);
            octants += block.octants;
            visible += block.octants - (entry == hidden.end() ? 0 : entry->second);
        }
        std::vector<Pattern<Words>> patterns;
        for (const auto& [cells, count] : sums) {
            patterns.push_back(pattern_of<Words>(cells));
            patterns.back().octants = count.first == kFree ? kFree : std::min(count.first, kMostOctants);
            patterns.back().visible = std::min(count.second, kMostOctants);
        }
        std::vector<Pattern<Words>> seeds;
        if constexpr (Words == 1)
            seeds = coarser(patterns);
        const StandIns<Words> found =
            Clustering<Words>(patterns, seeds, recolour_, Words == 1 ? fine_price_ : coarse_price_).run();
        std::map<Cells, Cells> result;
        for (std::size_t i = 0; i < patterns.size(); ++i)
            result.emplace(patterns[i].cells, found.cells[found.chosen[i]]);
        return result;
    }

    void merge_fine(const std::vector<Occurrence>& blocks) {
        std::unordered_map<Word, Cells64> before;
        for (const Occurrence& block : blocks) {
            read_cells(block.block, fine_level_, before[block.block].data(), 64);
            for (const std::uint8_t id : before[block.block])
                used_[id] = true;
        }
        const auto after = stand_ins<1>(blocks, fine_level_, [&](Word block) { return before.at(block); });
        for (const auto& [block, cells] : before)
            fine_.emplace(block, after.at(cells));
    }

    void merge_coarse(const std::vector<Occurrence>& blocks) {
        std::unordered_map<Word, Cells512> before;
        for (const Occurrence& block : blocks) {
            Cells512& cells = before[block.block];
            for (unsigned octant = 0; octant < 8; ++octant) {
                const Word child = base_.child(block.block, octant, coarse_level_);
                if (const auto merged = fine_.find(child); merged != fine_.end())
                    std::copy(merged->second.begin(), merged->second.end(), cells.begin() + 64 * octant);
                else
                    read_cells(child, fine_level_, cells.data() + 64 * octant, 64);
            }
            for (const std::uint8_t id : cells)
                used_[id] = true;
        }
        const auto after = stand_ins<8>(blocks, coarse_level_, [&](Word block) { return before.at(block); });
        for (const auto& [block, cells] : before)
            coarse_.emplace(block, after.at(cells));
    }

    Node node(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto known = nodes_.find(key); known != nodes_.end())
            return known->second;
        Node result;
        if (level == coarse_level_) {
            result = bricks_.from_cells(coarse_.at(word).data());
        } else if (level == fine_level_) {
            result = bricks_.from_cells64(fine_.at(word).data());
        } else {
            Block children;
            for (unsigned octant = 0; octant < 8; ++octant)
                children[octant] = node(base_.child(word, octant, level), level - 1);
            result = pool_.intern(children);
        }
        nodes_.emplace(key, result);
        return result;
    }

    Memory base_;
    Memory hidden_;
    unsigned fine_level_;
    unsigned coarse_level_;
    const RecolourCosts& recolour_;
    std::uint64_t fine_price_;
    std::uint64_t coarse_price_;
    std::array<bool, 256> used_{};
    std::unordered_map<Word, Cells64> fine_;
    std::unordered_map<Word, Cells512> coarse_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    BlockPool pool_;
    BrickBuilder bricks_{pool_};
};

} // namespace

std::vector<Word> merge_blocks(const Memory& base, const Memory& hidden, unsigned finest, const RecolourCosts& recolour,
                               std::uint64_t fine_price, std::uint64_t coarse_price) {
    return Merging(base, hidden, finest, recolour, fine_price, coarse_price).words();
}

} // namespace voxrt::octree
