// Patterns of voxels stood for by others that are nearly the same.
//
// The idea of merging rare subtrees of a shared octree into frequent ones that resemble them is that of van der Laan,
// Scandolo and Eisemann, "Lossy Geometry Compression for High Resolution Voxel Scenes" (2020). Here a stand-in must
// hold every solid voxel of what it stands for, so that no wall gets a hole, and may hold more at a price.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "interrupt.h"

namespace voxrt::octree {

/// What a changed voxel costs: `kAppeared` where it was empty, `recoloured[a][b]` where material a becomes b.
constexpr std::uint64_t kAppeared = 256;
using RecolourCosts = std::array<std::array<std::uint16_t, 256>, 256>;

constexpr std::uint64_t kFree = ~std::uint64_t{0};

/// 64 * Words cells in Morton order: a bit each that says whether it is solid, and its material.
template <unsigned Words> struct Pattern {
    std::array<std::uint64_t, Words> mask;
    std::array<std::uint8_t, 64 * Words> cells;
    std::uint64_t octants; // that show it; kFree where it costs no block
    std::uint64_t visible; // of those, not hidden: where a change of material can be seen
};

/// Stand-ins for a set of patterns: pattern i is shown as `cells[chosen[i]]`.
template <unsigned Words> struct StandIns {
    std::vector<std::array<std::uint8_t, 64 * Words>> cells;
    std::vector<std::uint32_t> chosen;
};

/// Finds stand-ins that hold every solid voxel of what they stand for, each pattern joining one at a cost of at most
/// `price`, what a block less is worth. Frequent and full patterns come first; each joins the stand-in that costs
/// least, which grows to hold it, or becomes one. In a second round each pattern goes to the stand-in that fits best,
/// and the stand-ins shrink to what they hold. Bounded by the scan of the stand-ins with nearly as many solid voxels.
template <unsigned Words> class Clustering {
public:
    Clustering(const std::vector<Pattern<Words>>& patterns, const std::vector<Pattern<Words>>& seeds,
               const RecolourCosts& recolour, std::uint64_t price)
        : patterns_(patterns), recolour_(recolour), price_(price), by_solid_(64 * Words + 1) {
        for (const Pattern<Words>& seed : seeds)
            add({seed.mask, seed.cells, kFree, solid_cells(seed.mask), false});
    }

    StandIns<Words> run() {
        std::vector<std::uint32_t> order(patterns_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::vector<unsigned> solid(patterns_.size());
        for (std::size_t i = 0; i < patterns_.size(); ++i)
            solid[i] = solid_cells(patterns_[i].mask);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            if (patterns_[a].octants != patterns_[b].octants)
                return patterns_[a].octants > patterns_[b].octants;
            if (solid[a] != solid[b])
                return solid[a] > solid[b];
            return patterns_[a].cells < patterns_[b].cells;
        });
        std::vector<std::uint32_t> chosen(patterns_.size());
        for (const std::uint32_t i : order)
            chosen[i] = join(patterns_[i]);
        for (const std::uint32_t i : order)
            chosen[i] = best_holder(patterns_[i], chosen[i]);
        return shrunk(order, std::move(chosen));
    }

private:
    using Mask = std::array<std::uint64_t, Words>;

    struct StandIn {
        Mask mask;
        std::array<std::uint8_t, 64 * Words> cells;
        std::uint64_t octants; // of all that it stands for
        unsigned solid;
        bool used;
    };

    // Inline where the baseline of the processor has no instruction for it, which std::popcount is not.
    static unsigned ones(std::uint64_t word) {
        word -= word >> 1 & 0x5555555555555555u;
        word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
        return static_cast<unsigned>(((word + (word >> 4)) & 0x0F0F0F0F0F0F0F0Fu) * 0x0101010101010101u >> 56);
    }

    static unsigned solid_cells(const Mask& mask) {
        unsigned count = 0;
        for (const std::uint64_t word : mask)
            count += ones(word);
        return count;
    }

    static bool holds(const Mask& mask, const Mask& part) {
        std::uint64_t lacking = 0;
        for (unsigned word = 0; word < Words; ++word)
            lacking |= part[word] & ~mask[word];
        return lacking == 0;
    }

    // Voxels of `part` that `mask` lacks.
    static unsigned lacking(const Mask& mask, const Mask& part) {
        unsigned count = 0;
        for (unsigned word = 0; word < Words; ++word)
            count += ones(part[word] & ~mask[word]);
        return count;
    }

    std::uint64_t recolouring(const Pattern<Words>& pattern, const StandIn& stand_in) const {
        std::uint64_t cost = 0;
        for (unsigned cell = 0; cell < 64 * Words; ++cell)
            if (pattern.cells[cell] != stand_in.cells[cell] && pattern.cells[cell] != 0 && stand_in.cells[cell] != 0)
                cost += recolour_[pattern.cells[cell]][stand_in.cells[cell]];
        return cost;
    }

    // Calls `weigh(stand_in)` for all whose solid voxels are between `low` and `high`, fewest growth first.
    template <typename Weigh> void near(unsigned solid, unsigned low, unsigned high, Weigh weigh) {
        for (unsigned away = 0; solid + away <= high || solid >= low + away; ++away) {
            interrupt_.poll();
            if (solid + away <= high)
                for (const std::uint32_t i : by_solid_[solid + away])
                    weigh(i);
            if (away != 0 && solid >= low + away)
                for (const std::uint32_t i : by_solid_[solid - away])
                    weigh(i);
        }
    }

    std::uint32_t join(const Pattern<Words>& pattern) {
        const unsigned solid = solid_cells(pattern.mask);
        std::uint64_t least = price_;
        std::uint64_t least_recolouring = 0;
        std::uint32_t best = kNone;
        if (pattern.octants != kFree) {
            // Earlier ones are at least as frequent, so a difference of one voxel costs at least this.
            const std::uint64_t reach = price_ / (kAppeared * pattern.octants);
            const unsigned low = solid > reach ? solid - static_cast<unsigned>(reach) : 0;
            const unsigned high = static_cast<unsigned>(std::min<std::uint64_t>(64 * Words, solid + reach));
            near(solid, low, high, [&](std::uint32_t i) {
                const StandIn& stand_in = stand_ins_[i];
                unsigned missing = 0;
                if (!holds(stand_in.mask, pattern.mask)) {
                    const std::uint64_t affordable = price_ / kAppeared / stand_in.octants;
                    if (affordable == 0 || affordable < (missing = lacking(stand_in.mask, pattern.mask)))
                        return;
                }
                const unsigned extra = stand_in.solid + missing - solid;
                std::uint64_t cost = kAppeared * (extra * pattern.octants + (missing ? missing * stand_in.octants : 0));
                if (cost > least)
                    return;
                const std::uint64_t recoloured = recolouring(pattern, stand_in);
                cost += recoloured * pattern.visible;
                if (cost < least || (cost == least && (best == kNone || recoloured < least_recolouring))) {
                    least = cost;
                    least_recolouring = recoloured;
                    best = i;
                }
            });
        }
        if (best == kNone) {
            best = add({pattern.mask, pattern.cells, pattern.octants, solid, true});
        } else {
            stand_ins_[best].used = true;
            if (stand_ins_[best].octants != kFree)
                grow(best, pattern);
        }
        return best;
    }

    std::uint32_t add(const StandIn& stand_in) {
        const std::uint32_t i = static_cast<std::uint32_t>(stand_ins_.size());
        stand_ins_.push_back(stand_in);
        by_solid_[stand_in.solid].push_back(i);
        return i;
    }

    void grow(std::uint32_t i, const Pattern<Words>& pattern) {
        StandIn& stand_in = stand_ins_[i];
        stand_in.octants += pattern.octants;
        for (unsigned cell = 0; cell < 64 * Words; ++cell)
            if (stand_in.cells[cell] == 0)
                stand_in.cells[cell] = pattern.cells[cell];
        for (unsigned word = 0; word < Words; ++word)
            stand_in.mask[word] |= pattern.mask[word];
        const unsigned solid = solid_cells(stand_in.mask);
        if (solid == stand_in.solid)
            return;
        std::erase(by_solid_[stand_in.solid], i);
        by_solid_[solid].push_back(i);
        stand_in.solid = solid;
    }

    // The stand-in that holds `pattern` at the least cost; `chosen` does hold it.
    std::uint32_t best_holder(const Pattern<Words>& pattern, std::uint32_t chosen) {
        if (pattern.octants == kFree)
            return chosen;
        const unsigned solid = solid_cells(pattern.mask);
        const auto cost_of = [&](const StandIn& stand_in) {
            return kAppeared * (stand_in.solid - solid) * pattern.octants +
                   recolouring(pattern, stand_in) * pattern.visible;
        };
        std::uint64_t least = cost_of(stand_ins_[chosen]);
        near(solid, solid, stand_ins_[chosen].solid, [&](std::uint32_t i) {
            const StandIn& stand_in = stand_ins_[i];
            if (!stand_in.used || kAppeared * (stand_in.solid - solid) * pattern.octants >= least ||
                !holds(stand_in.mask, pattern.mask))
                return;
            const std::uint64_t cost = cost_of(stand_in);
            if (cost < least) {
                least = cost;
                chosen = i;
            }
        });
        return chosen;
    }

    // The unions of what each stand-in holds, materials from the first that holds them; seeds as they are.
    StandIns<Words> shrunk(const std::vector<std::uint32_t>& order, std::vector<std::uint32_t> chosen) const {
        StandIns<Words> result{{}, std::move(chosen)};
        for (const StandIn& stand_in : stand_ins_)
            result.cells.push_back(stand_in.octants == kFree ? stand_in.cells : decltype(stand_in.cells){});
        for (const std::uint32_t i : order)
            for (unsigned cell = 0; cell < 64 * Words; ++cell)
                if (std::uint8_t& shown = result.cells[result.chosen[i]][cell]; shown == 0)
                    shown = patterns_[i].cells[cell];
        return result;
    }

    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    const std::vector<Pattern<Words>>& patterns_;
    const RecolourCosts& recolour_;
    std::uint64_t price_;
    std::vector<StandIn> stand_ins_;
    std::vector<std::vector<std::uint32_t>> by_solid_; // numbers of the stand-ins with as many solid voxels
    Interrupt interrupt_;
};

} // namespace voxrt::octree
