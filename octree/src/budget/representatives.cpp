#include "representatives.h"

#include "../query/levels.h"
#include "../sight/hidden.h"

#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <numeric>

namespace voxrt::octree {
namespace {

constexpr std::uint64_t kMostOctants = std::uint64_t{1}
                                       << 20; // a larger number counts as this, so that sums of costs fit 64 bits
constexpr std::uint32_t kFewPatterns = 4000;
constexpr std::size_t kChoices = 32;             // per pattern
constexpr std::size_t kPairs = 24'000'000;       // pairs of a pattern and a representative that are tried in all
constexpr std::size_t kFewestPairs = 1000;       // pairs that are tried for each pattern at least
constexpr unsigned kNearlyFull[] = {24, 40, 52}; // of 64 cells

// The brick with its octants of `count` cells made uniform, of the material that most of their solid cells have.
Cells512 coarsened(const Cells512& cells, unsigned count) {
    Cells512 result;
    for (unsigned first = 0; first < 512; first += count) {
        std::array<unsigned, 256> counts{};
        for (unsigned cell = first; cell < first + count; ++cell)
            counts[cells[cell]] += cells[cell] != 0;
        std::fill_n(result.begin() + first, count,
                    static_cast<std::uint8_t>(std::max_element(counts.begin(), counts.end()) - counts.begin()));
    }
    return result;
}

void read_cells(const Memory& memory, Word word, unsigned level, std::uint8_t* cells, unsigned count) {
    if (is_leaf(word)) {
        std::fill_n(cells, count, material(word));
        return;
    }
    for (unsigned octant = 0; octant < 8; ++octant)
        read_cells(memory, memory.child(word, octant, level), level - 1, cells + octant * (count / 8), count / 8);
}

bool contains(const Mask512& mask, const Mask512& part) {
    for (unsigned word = 0; word < 8; word += 2)
        if ((part[word] & ~mask[word]) | (part[word + 1] & ~mask[word + 1]))
            return false;
    return true;
}

bool cheaper(const Match& a, const Match& b) { return a.cost != b.cost ? a.cost < b.cost : a.brick < b.brick; }

} // namespace

Representatives::Representatives(const Memory& base, const Memory& hidden, unsigned finest,
                                 const AppearanceCosts& costs) {
    read_patterns(base, hidden, finest + 3);
    add_coarsened();
    find_blocks();
    match_all(costs);
}

std::uint32_t Representatives::add(const Cells512& cells) {
    const Node node = builder_.from_cells(cells.data());
    const auto [entry, missing] = numbers_.try_emplace(node, count());
    if (missing) {
        bricks_.emplace_back(cells);
        nodes_.push_back(node);
    }
    return entry->second;
}

void Representatives::read_patterns(const Memory& base, const Memory& hidden, unsigned level) {
    const auto hidden_count = hidden_octants(base, hidden, level);
    std::vector<std::pair<Cells512, Occurrence>> found;
    const auto blocks = blocks_by_level(base);
    for (const Occurrence& block : blocks[level]) {
        found.push_back({{}, block});
        read_cells(base, block.block, level, found.back().first.data(), 512);
    }
    // Ascending by cells, so that nothing depends on how the words are laid out.
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : a.second.block < b.second.block;
    });
    for (const auto& [cells, block] : found) {
        const std::uint32_t pattern = add(cells);
        pattern_of_.emplace(block.block, pattern);
        octants_.resize(count());
        visible_.resize(count());
        const auto entry = hidden_count.find(block.block);
        octants_[pattern] += block.octants;
        visible_[pattern] += block.octants - (entry == hidden_count.end() ? 0 : entry->second);
    }
    for (std::uint32_t pattern = 0; pattern < patterns(); ++pattern) {
        octants_[pattern] = std::min(octants_[pattern], kMostOctants);
        visible_[pattern] = std::min(visible_[pattern], kMostOctants);
    }
}

void Representatives::add_coarsened() {
    std::array<bool, 256> used{};
    for (const BrickAppearance& brick : bricks_)
        for (const std::uint8_t id : brick.cells)
            used[id] = true;
    std::vector<std::uint32_t> uniform;
    for (unsigned id = 1; id < 256; ++id)
        if (used[id]) {
            Cells512 cells;
            cells.fill(static_cast<std::uint8_t>(id));
            uniform.push_back(add(cells));
        }
    for (std::uint32_t pattern = 0; pattern < patterns(); ++pattern) {
        const Cells512 cells = bricks_[pattern].cells;
        std::vector<std::uint32_t> fallbacks = uniform;
        fallbacks.push_back(add(coarsened(cells, 8)));
        fallbacks.push_back(add(coarsened(cells, 64)));
        std::sort(fallbacks.begin(), fallbacks.end());
        fallbacks.erase(std::unique(fallbacks.begin(), fallbacks.end()), fallbacks.end());
        fallbacks_.push_back(std::move(fallbacks));
    }
    unfilled_ = count();
    for (std::uint32_t pattern = 0; patterns() <= kFewPatterns && pattern < patterns(); ++pattern)
        for (const Cells512& cells : {bricks_[pattern].cells, coarsened(bricks_[pattern].cells, 8)}) {
            const Cells512 full = coarsened(cells, 64);
            for (const unsigned least : kNearlyFull) {
                Cells512 filled = cells;
                for (unsigned first = 0; first < 512; first += 64)
                    if (64 - std::count(cells.begin() + first, cells.begin() + first + 64, 0) >= least)
                        std::copy_n(full.begin() + first, 64, filled.begin() + first);
                add(filled);
            }
        }
}

void Representatives::find_blocks() {
    for (const Node node : nodes_) {
        std::vector<Node> parts;
        if (!is_leaf(node))
            for (const Node part : pool_[node])
                if (!is_leaf(part)) {
                    parts.push_back(part);
                    for (const Node cube : pool_[part])
                        if (!is_leaf(cube))
                            parts.push_back(cube);
                }
        std::sort(parts.begin(), parts.end());
        parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
        blocks_.push_back(std::move(parts));
    }
}

void Representatives::match_all(const AppearanceCosts& costs) {
    ascending_.resize(count());
    std::iota(ascending_.begin(), ascending_.end(), 0u);
    std::stable_sort(ascending_.begin(), ascending_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return bricks_[a].solid < bricks_[b].solid; });
    for (const std::uint32_t i : ascending_)
        masks_.push_back(bricks_[i].mask);
    choices_.resize(patterns());
    constexpr std::uint32_t kChunk = 64;
    const std::size_t chunks = (patterns() + kChunk - 1) / kChunk;
    voxelize::Workers(0).run(chunks, [&](std::size_t chunk, int) {
        const auto first = static_cast<std::uint32_t>(chunk) * kChunk;
        for (std::uint32_t pattern = first; pattern < std::min(first + kChunk, patterns()); ++pattern)
            choices_[pattern] = match(pattern, costs);
    });
    represented_.resize(count());
    for (std::uint32_t pattern = 0; pattern < patterns(); ++pattern)
        for (const Match& choice : choices_[pattern])
            represented_[choice.brick].push_back({choice.cost, pattern});
}

std::vector<Match> Representatives::match(std::uint32_t pattern, const AppearanceCosts& costs) const {
    constexpr std::uint64_t kAny = ~std::uint64_t{0};
    const BrickAppearance& brick = bricks_[pattern];
    const std::vector<std::uint32_t>& fallbacks = fallbacks_[pattern];
    const auto added_cost = [&](std::uint32_t i) {
        return octants_[pattern] * kAddedCellCost * (bricks_[i].solid - brick.solid);
    };
    const std::uint64_t visible = visible_[pattern];
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    std::vector<Match> choices; // a heap, the most expensive on top
    std::uint64_t worst = kAny;
    const auto lowest = std::lower_bound(ascending_.begin(), ascending_.end(), brick.solid,
                                         [&](std::uint32_t i, unsigned solid) { return bricks_[i].solid < solid; });
    const std::size_t begin = static_cast<std::size_t>(lowest - ascending_.begin());
    const std::size_t pairs = std::max(kFewestPairs, kPairs / patterns());
    work.count(static_cast<std::uint32_t>(pairs / 4));
    for (std::size_t rank = begin; rank < std::min(begin + pairs, masks_.size()); ++rank) {
        if (!contains(masks_[rank], brick.mask))
            continue;
        const std::uint32_t i = ascending_[rank];
        if (added_cost(i) >= worst)
            break;
        if (std::binary_search(fallbacks.begin(), fallbacks.end(), i))
            continue;
        const std::uint64_t limit =
            worst == kAny ? kAny : (worst - added_cost(i)) / std::max<std::uint64_t>(visible, 1) + 1;
        work.count(50);
        const std::uint64_t cost = added_cost(i) + visible * appearance_cost(brick, bricks_[i], costs, limit);
        if (cost >= worst)
            continue;
        choices.push_back({cost, i});
        std::push_heap(choices.begin(), choices.end(), cheaper);
        if (choices.size() > kChoices) {
            std::pop_heap(choices.begin(), choices.end(), cheaper);
            choices.pop_back();
            worst = choices.front().cost;
        }
    }
    for (const std::uint32_t i : fallbacks)
        choices.push_back({added_cost(i) + visible * appearance_cost(brick, bricks_[i], costs, kAny), i});
    std::sort(choices.begin(), choices.end(), cheaper);
    return choices;
}

} // namespace voxrt::octree
