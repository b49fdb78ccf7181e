#include "budget.h"

#include "../pool/breadth_first.h"
#include "representatives.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace voxrt::octree {
namespace {

constexpr double kHighestPrice = 1e15; // of a block, in units of cost: no brick is worth it
constexpr double kPriceFactor = 0.7;   // from one price to the next
constexpr unsigned kBisections = 4;

/// Selects the representatives of a memory. This is a facility location problem: a representative costs blocks, and
/// each brick is shown as the selected one that looks most like it. It is solved by adding and dropping (A. A. Kuehn
/// and M. J. Hamburger, "A Heuristic Program for Locating Warehouses", 1963) at a falling price per block: a
/// representative is added where it improves the picture by more than it costs, and dropped where it no longer does,
/// until the memory is full.
class Selection {
public:
    /// `unfilled`: select patterns and coarsened ones alone. A block that no selected one has yet costs its price
    /// divided by how many representatives would share it, at most `sharing`.
    Selection(const Memory& base, unsigned level, Representatives& representatives, bool unfilled,
              std::uint32_t sharing)
        : base_(base), level_(level), representatives_(representatives), unfilled_(unfilled), sharing_(sharing),
          selected_(representatives.count()), uses_(representatives.pool().size()),
          sharers_(representatives.pool().size()) {
        for (std::uint32_t i = 0; i < selected_.size(); ++i) {
            selected_[i] = representatives_.uniform(i);
            for (const Node block : representatives_.blocks(i))
                sharers_[block] = std::min(sharers_[block] + 1, sharing_);
        }
    }

    /// A memory of at most `words` words; none where uniform bricks alone take more.
    std::optional<Words> fit(std::size_t words) {
        Words best = build_words();
        if (best.size() > words)
            return std::nullopt;
        const auto fits = [&] {
            Words found = build_words();
            if (found.size() > words)
                return false;
            best = std::move(found);
            return true;
        };
        State kept = state();
        double full = 0;
        for (double price = kHighestPrice; full == 0 && price > 1; price *= kPriceFactor) {
            if (!improve(price))
                continue;
            if (fits())
                kept = state();
            else
                full = price;
        }
        if (full == 0)
            return best;
        double room = full / kPriceFactor;
        for (unsigned i = 0; i < kBisections; ++i) {
            restore(kept);
            const double middle = std::sqrt(full * room);
            improve(middle);
            if (fits()) {
                room = middle;
                kept = state();
            } else {
                full = middle;
            }
        }
        // The rest is filled with what the next lower price would add first.
        restore(kept);
        const std::vector<std::uint32_t> next = add_where_worth(kPriceFactor * full);
        std::size_t fitting = 0;
        for (std::size_t over = next.size() + 1; over - fitting > 1;) {
            const std::size_t middle = (fitting + over) / 2;
            restore(kept);
            for (std::size_t i = 0; i < middle; ++i)
                select(next[i]);
            (fits() ? fitting : over) = middle;
        }
        return best;
    }

private:
    struct State {
        std::vector<bool> selected;
        std::vector<std::uint32_t> uses;
    };
    State state() const { return {selected_, uses_}; }
    void restore(const State& state) {
        selected_ = state.selected;
        uses_ = state.uses;
    }

    void select(std::uint32_t i) {
        selected_[i] = true;
        for (const Node block : representatives_.blocks(i))
            ++uses_[block];
    }

    // There is always one: uniform representatives are always selected, and hold every brick.
    const Match& chosen(std::uint32_t pattern) const {
        return *std::find_if(representatives_.choices(pattern).begin(), representatives_.choices(pattern).end(),
                             [&](const Match& choice) { return selected_[choice.brick]; });
    }

    std::vector<std::uint64_t> costs() const {
        std::vector<std::uint64_t> result(representatives_.patterns());
        for (std::uint32_t pattern = 0; pattern < result.size(); ++pattern)
            result[pattern] = chosen(pattern).cost;
        return result;
    }

    // Blocks that come or go with a representative: its own, and those below it that `uses` selected ones use.
    double block_count(std::uint32_t i, std::uint32_t uses) const {
        double result = 1;
        for (const Node block : representatives_.blocks(i))
            if (uses_[block] == uses)
                result += 1.0 / sharers_[block];
        return result;
    }

    // Adds what improves the picture by more than `price` per block; returns it.
    std::vector<std::uint32_t> add_where_worth(double price) {
        std::vector<std::uint64_t> cost = costs();
        std::vector<std::uint32_t> added;
        for (std::uint32_t i = 0; i < selected_.size(); ++i) {
            if (selected_[i] || (unfilled_ && !representatives_.unfilled(i)))
                continue;
            std::uint64_t gain = 0;
            for (const Match& user : representatives_.represented(i))
                gain += cost[user.brick] - std::min(cost[user.brick], user.cost);
            if (static_cast<double>(gain) <= price || static_cast<double>(gain) <= price * block_count(i, 0))
                continue;
            select(i);
            added.push_back(i);
            for (const Match& user : representatives_.represented(i))
                cost[user.brick] = std::min(cost[user.brick], user.cost);
        }
        return added;
    }

    // Drops what is no longer worth `price` per block; returns whether there was any.
    bool drop_where_not_worth(double price) {
        std::vector<std::uint64_t> cost = costs();
        bool dropped = false;
        for (std::uint32_t i = 0; i < selected_.size(); ++i) {
            if (!selected_[i] || representatives_.uniform(i))
                continue;
            selected_[i] = false;
            std::uint64_t loss = 0;
            for (const Match& user : representatives_.represented(i))
                if (cost[user.brick] == user.cost)
                    loss += chosen(user.brick).cost - user.cost;
            if (static_cast<double>(loss) > price * block_count(i, 1)) {
                selected_[i] = true;
                continue;
            }
            dropped = true;
            for (const Node block : representatives_.blocks(i))
                --uses_[block];
            for (const Match& user : representatives_.represented(i))
                cost[user.brick] = chosen(user.brick).cost;
        }
        return dropped;
    }

    // Adds and drops; returns whether anything changed.
    bool improve(double price) {
        bool changed = false;
        for (unsigned round = 0; round < 2; ++round) {
            voxelize::WorkCounter::current().check();
            const bool added = !add_where_worth(price).empty();
            changed |= added | drop_where_not_worth(price);
        }
        return changed;
    }

    Words build_words() {
        nodes_.clear();
        return breadth_first_words(representatives_.pool(), node(base_.root(), base_.depth));
    }

    Node node(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        if (level == level_)
            return representatives_.node(chosen(representatives_.pattern(word)).brick);
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto entry = nodes_.find(key); entry != nodes_.end())
            return entry->second;
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(base_.child(word, octant, level), level - 1);
        return nodes_[key] = representatives_.pool().intern(children);
    }

    Memory base_;
    unsigned level_;
    Representatives& representatives_;
    bool unfilled_;
    std::uint32_t sharing_;
    std::vector<bool> selected_;
    std::vector<std::uint32_t> uses_;    // of a block in the pool, by selected representatives
    std::vector<std::uint32_t> sharers_; // representatives that have the block, selected or not
    std::unordered_map<std::uint64_t, Node> nodes_;
};

} // namespace

std::vector<Words> fit_bricks(const Memory& base, const Memory& hidden, unsigned finest, const AppearanceCosts& costs,
                              std::size_t words) {
    const unsigned level = finest + 3;
    if (base.depth < level || is_leaf(base.root()))
        return {};
    Representatives representatives(base, hidden, finest, costs);
    std::vector<Words> result;
    for (const bool unfilled : {true, false})
        for (const std::uint32_t sharing : {1u, 3u})
            if (auto found = Selection(base, level, representatives, unfilled, sharing).fit(words))
                result.push_back(std::move(*found));
    return result;
}

} // namespace voxrt::octree
