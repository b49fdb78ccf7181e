#include "interior.h"

#include "../build/coarsen.h"
#include "../pool/breadth_first.h"
#include "../query/levels.h"
#include "../query/query.h"
#include "dont_care.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace voxrt::octree {
namespace {

// Blocks that so many octants show are shared well already, such as those of a face of a box.
constexpr std::uint64_t kManyOctants = 256;

// How many octants show a block.
using Octants = std::unordered_map<Word, std::uint64_t>;

// A memory whose hidden voxels are all replaced by one leaf, in a pool; blocks that `kept` octants or more show stay.
class HiddenReplacement {
public:
    HiddenReplacement(const Memory& memory, const Memory& hidden, Node replacement, BlockPool& pool,
                      const Octants& octants, std::uint64_t kept)
        : memory_(memory), hidden_(hidden), replacement_(replacement), pool_(pool), octants_(octants), kept_(kept) {
        if (memory.depth != hidden.depth)
            throw std::invalid_argument("the hidden voxels are those of a world of another depth");
    }

    Node root() { return node(memory_.root(), hidden_.root(), memory_.depth); }

private:
    struct Pair {
        Word word;
        Word hidden;
        unsigned level;

        bool operator==(const Pair&) const = default;
    };
    struct HashOfPair {
        std::size_t operator()(const Pair& pair) const {
            const std::uint64_t mixed = (std::uint64_t{pair.word} << 32 | pair.hidden) * 0x9E3779B97F4A7C15u;
            return (mixed ^ mixed >> 32 ^ pair.level) * 0xD6E8FEB86659FD93u;
        }
    };

    Node node(Word word, Word hidden, unsigned level) {
        if (is_leaf(hidden) && hidden != kEmpty)
            return replacement_;
        if (is_leaf(word) && is_leaf(hidden))
            return word;
        const Pair pair{word, hidden, level};
        if (const auto entry = nodes_.find(pair); entry != nodes_.end())
            return entry->second;
        work_.count_step();
        if (const auto shown = octants_.find(word); shown != octants_.end() && shown->second >= kept_)
            hidden = kEmpty;
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(is_leaf(word) ? word : memory_.child(word, octant, level),
                                    is_leaf(hidden) ? hidden : hidden_.child(hidden, octant, level), level - 1);
        return nodes_[pair] = pool_.intern(children);
    }

    Memory memory_;
    Memory hidden_;
    Node replacement_;
    BlockPool& pool_;
    const Octants& octants_;
    std::uint64_t kept_;
    std::unordered_map<Pair, Node, HashOfPair> nodes_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

// The material that most solid voxels have, the lowest id where several do.
Node commonest(const Memory& memory) {
    const std::vector<std::uint64_t> leaves = leaf_counts(memory);
    std::array<std::uint64_t, 256> voxels{};
    for (std::size_t i = 0; i < leaves.size(); ++i)
        voxels[i % 256] += leaves[i] * voxels_at(static_cast<unsigned>(i / 256));
    return leaf(static_cast<std::uint8_t>(std::max_element(voxels.begin() + 1, voxels.end()) - voxels.begin()));
}

} // namespace

Words fill_hidden(const Memory& memory, const Memory& hidden, std::uint8_t material) {
    BlockPool pool;
    const Octants none;
    const Node root = HiddenReplacement(memory, hidden, leaf(material), pool, none, 0).root();
    return breadth_first_words(pool, root);
}

Words share_hidden(const Memory& memory, const Memory& hidden) {
    Words best = coarsened(memory, 0);
    const Words words = best;
    const Memory whole{words.data(), words.size(), memory.depth};
    const auto keep_smaller = [&](Words other) {
        if (other.size() < best.size())
            best = std::move(other);
    };
    const Node common = commonest(whole);
    keep_smaller(fill_hidden(whole, hidden, material(common)));
    Octants octants;
    for (const std::vector<Occurrence>& level : blocks_by_level(whole))
        for (const Occurrence& block : level)
            octants[block.block] += block.octants;
    for (const std::uint64_t kept : {kManyOctants, ~std::uint64_t{0}}) {
        BlockPool replaced;
        const Node root = HiddenReplacement(whole, hidden, kAnySolid, replaced, octants, kept).root();
        BlockPool pool;
        const Node shared = root == kAnySolid ? common : DontCareSharing(replaced).shared(root, common, pool);
        keep_smaller(breadth_first_words(pool, shared));
    }
    return best;
}

} // namespace voxrt::octree
