#include "budget.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "breadth_first.h"
#include "interrupt.h"
#include "stand_ins.h"

namespace voxrt::octree {
namespace {

constexpr double kHighest = 1e15; // price of a block, in units of cost; dearer than any brick is worth
constexpr double kFall = 0.7;
constexpr unsigned kHalvings = 4;

/// Chooses which stand-ins a memory has: a facility location problem, since to have one costs blocks, and each brick is
/// shown as the one there is that looks most like it. Solved by adding and dropping (A. A. Kuehn and M. J. Hamburger,
/// "A Heuristic Program for Locating Warehouses", 1963) at a falling price of a block: those are added that better the
/// picture by more than they cost, and dropped that no longer do, until the memory is full.
class Choice {
public:
    /// With `plain`, only bricks as they are and coarser ones. A block that nothing has yet costs its price divided by
    /// how many stand-ins would share it, at most `sharing`.
    Choice(const Memory& base, unsigned level, StandIns& stand_ins, bool plain, std::uint32_t sharing)
        : base_(base), level_(level), stand_ins_(stand_ins), plain_(plain), sharing_(sharing), open_(stand_ins.count()),
          uses_(stand_ins.pool().size()), sharers_(stand_ins.pool().size()) {
        for (std::uint32_t i = 0; i < open_.size(); ++i) {
            open_[i] = stand_ins_.uniform(i);
            for (const Node part : stand_ins_.parts(i))
                sharers_[part] = std::min(sharers_[part] + 1, sharing_);
        }
    }

    std::optional<std::vector<Word>> fit(std::size_t words) {
        std::vector<Word> best = built();
        if (best.size() > words)
            return std::nullopt;
        const auto fits = [&] {
            std::vector<Word> found = built();
            if (found.size() > words)
                return false;
            best = std::move(found);
            return true;
        };
        State kept = state();
        double full = 0;
        for (double price = kHighest; full == 0 && price > 1; price *= kFall) {
            if (!settle(price))
                continue;
            if (fits())
                kept = state();
            else
                full = price;
        }
        if (full == 0)
            return best;
        double room = full / kFall;
        for (unsigned i = 0; i < kHalvings; ++i) {
            restore(kept);
            const double middle = std::sqrt(full * room);
            settle(middle);
            if (fits()) {
                room = middle;
                kept = state();
            } else {
                full = middle;
            }
        }
        // What would be added first as the price falls on fills the rest.
        restore(kept);
        const std::vector<std::uint32_t> next = add_where_worth(kFall * full);
        std::size_t fitting = 0;
        for (std::size_t over = next.size() + 1; over - fitting > 1;) {
            const std::size_t middle = (fitting + over) / 2;
            restore(kept);
            for (std::size_t i = 0; i < middle; ++i)
                open(next[i]);
            (fits() ? fitting : over) = middle;
        }
        return best;
    }

private:
    struct State {
        std::vector<bool> open;
        std::vector<std::uint32_t> uses;
    };
    State state() const { return {open_, uses_}; }
    void restore(const State& state) {
        open_ = state.open;
        uses_ = state.uses;
    }

    void open(std::uint32_t i) {
        open_[i] = true;
        for (const Node part : stand_ins_.parts(i))
            ++uses_[part];
    }

    // The uniform stand-ins hold every brick and are always open.
    const Match& chosen(std::uint32_t pattern) const {
        return *std::find_if(stand_ins_.choices(pattern).begin(), stand_ins_.choices(pattern).end(),
                             [&](const Match& choice) { return open_[choice.brick]; });
    }

    std::vector<std::uint64_t> costs() const {
        std::vector<std::uint64_t> result(stand_ins_.patterns());
        for (std::uint32_t pattern = 0; pattern < result.size(); ++pattern)
            result[pattern] = chosen(pattern).cost;
        return result;
    }

    // Blocks that come with a stand-in, or go with it: those below it with `users` users.
    double blocks(std::uint32_t i, std::uint32_t users) const {
        double result = 1;
        for (const Node part : stand_ins_.parts(i))
            if (uses_[part] == users)
                result += 1.0 / sharers_[part];
        return result;
    }

    std::vector<std::uint32_t> add_where_worth(double price) {
        std::vector<std::uint64_t> cost = costs();
        std::vector<std::uint32_t> added;
        for (std::uint32_t i = 0; i < open_.size(); ++i) {
            if (open_[i] || (plain_ && !stand_ins_.plain(i)))
                continue;
            std::uint64_t gain = 0;
            for (const Match& user : stand_ins_.users(i))
                gain += cost[user.brick] - std::min(cost[user.brick], user.cost);
            if (static_cast<double>(gain) <= price || static_cast<double>(gain) <= price * blocks(i, 0))
                continue;
            open(i);
            added.push_back(i);
            for (const Match& user : stand_ins_.users(i))
                cost[user.brick] = std::min(cost[user.brick], user.cost);
        }
        return added;
    }

    bool drop_where_not(double price) {
        std::vector<std::uint64_t> cost = costs();
        bool dropped = false;
        for (std::uint32_t i = 0; i < open_.size(); ++i) {
            if (!open_[i] || stand_ins_.uniform(i))
                continue;
            open_[i] = false;
            std::uint64_t loss = 0;
            for (const Match& user : stand_ins_.users(i))
                if (cost[user.brick] == user.cost)
                    loss += chosen(user.brick).cost - user.cost;
            if (static_cast<double>(loss) > price * blocks(i, 1)) {
                open_[i] = true;
                continue;
            }
            dropped = true;
            for (const Node part : stand_ins_.parts(i))
                --uses_[part];
            for (const Match& user : stand_ins_.users(i))
                cost[user.brick] = chosen(user.brick).cost;
        }
        return dropped;
    }

    // Whether anything changed.
    bool settle(double price) {
        bool changed = false;
        for (unsigned round = 0; round < 2; ++round) {
            Interrupt::check();
            const bool added = !add_where_worth(price).empty();
            changed |= added | drop_where_not(price);
        }
        return changed;
    }

    std::vector<Word> built() {
        nodes_.clear();
        return breadth_first_words(stand_ins_.pool(), node(base_.root(), base_.depth));
    }

    Node node(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        if (level == level_)
            return stand_ins_.node(chosen(stand_ins_.pattern(word)).brick);
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto known = nodes_.find(key); known != nodes_.end())
            return known->second;
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(base_.child(word, octant, level), level - 1);
        return nodes_[key] = stand_ins_.pool().intern(children);
    }

    Memory base_;
    unsigned level_;
    StandIns& stand_ins_;
    bool plain_;
    std::uint32_t sharing_;
    std::vector<bool> open_;
    std::vector<std::uint32_t> uses_;    // of a block in the pool, by open stand-ins
    std::vector<std::uint32_t> sharers_; // stand-ins that have the block, open or not
    std::unordered_map<std::uint64_t, Node> nodes_;
};

} // namespace

std::vector<std::vector<Word>> fit_bricks(const Memory& base, const Memory& hidden, unsigned finest,
                                          const SightCosts& costs, std::size_t words) {
    const unsigned level = finest + 3;
    if (base.depth < level || is_leaf(base.root()))
        return {};
    StandIns stand_ins(base, hidden, finest, costs);
    std::vector<std::vector<Word>> result;
    for (const bool plain : {true, false})
        for (const std::uint32_t sharing : {1u, 3u})
            if (auto found = Choice(base, level, stand_ins, plain, sharing).fit(words))
                result.push_back(std::move(*found));
    return result;
}

} // namespace voxrt::octree
