#include "means.h"

#include "hidden.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace voxrt::octree {
namespace {

constexpr std::uint32_t kFull = 1 << 16;
constexpr std::uint64_t kSeen = std::uint64_t{1} << 40; // of a voxel

// What is seen of an octant: how much of its square along each axis lets nothing through, 1/kFull; how much surface it
// has, in squares of its own side, 1/kSeen; and the mean light of that.
struct Look {
    std::array<std::uint32_t, 3> coverage{};
    std::uint64_t surface = 0;
    LinearLight light{};
};

// Sums of light over surfaces.
class MeanLight {
public:
    void add(const LinearLight& light, __uint128_t surface) {
        surface_ += surface;
        for (unsigned channel = 0; channel < 3; ++channel)
            sums_[channel] += surface * light[channel];
    }
    bool empty() const { return surface_ == 0; }
    LinearLight mean() const {
        LinearLight light{};
        for (unsigned channel = 0; !empty() && channel < 3; ++channel)
            light[channel] = static_cast<std::uint16_t>((2 * sums_[channel] + surface_) / (2 * surface_));
        return light;
    }

private:
    __uint128_t surface_ = 0;
    std::array<__uint128_t, 3> sums_{};
};

// Octants that have one word in the memory and one in that of its covered voxels look the same.
class Looks {
public:
    Looks(const Memory& memory, const Memory& covered, const std::vector<LinearLight>& light)
        : memory_(memory), covered_(covered), light_(light) {
        count_octants();
        for (unsigned level = 1; level <= memory.depth; ++level)
            for (auto& [pair, octants] : levels_[level])
                octants.look = joined(pair, level);
    }

    // Calls visit(block's word, look, octants) for all blocks.
    template <class Visit> void each_block(Visit visit) const {
        for (const Level& level : levels_)
            for (const auto& [pair, octants] : level)
                if (const Word word = static_cast<Word>(pair >> 32); !is_leaf(word))
                    visit(word, octants.look, octants.count);
    }

private:
    struct Octants {
        std::uint64_t count = 0;
        Look look;
    };
    using Level = std::unordered_map<std::uint64_t, Octants>;

    static std::uint64_t pair_of(Word word, Word covered) { return std::uint64_t{word} << 32 | covered; }

    std::uint64_t child(std::uint64_t pair, unsigned octant, unsigned level) const {
        const Word word = static_cast<Word>(pair >> 32), covered = static_cast<Word>(pair);
        return pair_of(is_leaf(word) ? word : memory_.child(word, octant, level),
                       is_leaf(covered) ? covered : covered_.child(covered, octant, level));
    }

    // Whether octants have children to look at: not where all is one leaf, and seen or covered throughout.
    static bool has_children(std::uint64_t pair) {
        const Word word = static_cast<Word>(pair >> 32), covered = static_cast<Word>(pair);
        return is_leaf(covered) ? covered == kEmpty && !is_leaf(word) : true;
    }

    void count_octants() {
        levels_.resize(memory_.depth + 1);
        levels_[memory_.depth][pair_of(memory_.root(), covered_.root())].count = 1;
        for (unsigned level = memory_.depth; level > 0; --level)
            for (const auto& [pair, octants] : levels_[level]) {
                if (!has_children(pair))
                    continue;
                voxelize::count_work(8);
                for (unsigned octant = 0; octant < 8; ++octant)
                    if (const std::uint64_t below = child(pair, octant, level); has_children(below))
                        levels_[level - 1][below].count += octants.count;
            }
    }

    Look look_of(std::uint64_t pair, unsigned level) const {
        if (has_children(pair))
            return levels_[level].at(pair).look;
        const Word word = static_cast<Word>(pair >> 32), covered = static_cast<Word>(pair);
        if (covered != kEmpty)
            return {.coverage = {kFull, kFull, kFull}};
        const std::uint8_t of = material(word);
        if (of == 0)
            return {};
        return {{kFull, kFull, kFull}, kSeen << level, of < light_.size() ? light_[of] : LinearLight{}};
    }

    Look joined(std::uint64_t pair, unsigned level) const {
        if (!has_children(pair))
            return look_of(pair, level);
        voxelize::count_work(8);
        std::array<Look, 8> octants;
        for (unsigned octant = 0; octant < 8; ++octant)
            octants[octant] = look_of(child(pair, octant, level), level - 1);
        Look look;
        for (unsigned axis = 0; axis < 3; ++axis) {
            std::uint64_t columns = 0;
            for (unsigned octant = 0; octant < 8; ++octant)
                if ((octant >> axis & 1) == 0) {
                    const std::uint64_t open = kFull - octants[octant].coverage[axis];
                    const std::uint64_t behind = kFull - octants[octant | 1u << axis].coverage[axis];
                    columns += kFull - open * behind / kFull;
                }
            look.coverage[axis] = static_cast<std::uint32_t>(columns / 4);
        }
        MeanLight light;
        for (const Look& octant : octants) {
            look.surface += octant.surface;
            light.add(octant.light, octant.surface);
        }
        look.surface /= 4;
        look.light = light.mean();
        return look;
    }

    const Memory memory_;
    const Memory covered_;
    const std::vector<LinearLight>& light_;
    std::vector<Level> levels_; // by level: what occurs there, besides leaves
};

// The material that is nearest to a light.
class Palette {
public:
    explicit Palette(const std::vector<LinearLight>& light) : light_(light) {}

    std::uint8_t nearest(const LinearLight& light) {
        const std::uint64_t key =
            std::uint64_t{light[0]} | std::uint64_t{light[1]} << 16 | std::uint64_t{light[2]} << 32;
        const auto [entry, is_new] = nearest_.try_emplace(key, std::uint8_t{0});
        std::int64_t least = INT64_MAX;
        for (std::size_t id = 1; is_new && id < light_.size(); ++id) {
            std::int64_t distance = 0;
            for (unsigned channel = 0; channel < 3; ++channel) {
                const std::int64_t difference = std::int64_t{light[channel]} - light_[id][channel];
                distance += difference * difference;
            }
            if (distance < least) {
                least = distance;
                entry->second = static_cast<std::uint8_t>(id);
            }
        }
        return entry->second;
    }

private:
    const std::vector<LinearLight>& light_;
    std::unordered_map<std::uint64_t, std::uint8_t> nearest_;
};

// Whether rays along some axis find a gap in more than 5 parts of 16. A cell shown as solid makes a silhouette grow by
// what it does not fill along its emptiest axis, which a mean of the axes would hide.
bool is_sparse(const Look& look) {
    return 16 * std::uint64_t{*std::ranges::min_element(look.coverage)} < 11 * std::uint64_t{kFull};
}

} // namespace

std::vector<std::uint8_t> mean_materials(const Memory& memory, const std::vector<LinearLight>& light) {
    const Words words = covered_voxels(memory);
    const Looks looks(memory, {words.data(), words.size(), memory.depth}, light);
    std::vector<MeanLight> sums(block_count(memory.size));
    std::vector<std::uint8_t> sparse(sums.size());
    looks.each_block([&](Word block, const Look& look, std::uint64_t octants) {
        sums[block_number(block)].add(look.light, __uint128_t{look.surface} * octants);
        sparse[block_number(block)] = is_sparse(look);
    });
    Palette palette(light);
    std::vector<std::uint8_t> means(sums.size());
    for (std::size_t block = 0; block < means.size(); ++block)
        if (!sums[block].empty() && !sparse[block])
            means[block] = palette.nearest(sums[block].mean());
    return means;
}

} // namespace voxrt::octree
