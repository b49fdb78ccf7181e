#include "interior.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "breadth_first.h"
#include "coarsen.h"
#include "dont_care.h"
#include "interrupt.h"
#include "levels.h"
#include "query.h"

namespace voxrt::octree {
namespace {

// Blocks that so many octants show are shared well as they are: a whole face of a box, for instance.
constexpr std::uint64_t kManyOctants = 256;

// How many octants show a block.
using Octants = std::unordered_map<Word, std::uint64_t>;

// A memory whose hidden voxels are all made one leaf, in a pool; blocks that `kept` octants or more show are kept.
class Painting {
public:
    Painting(const Memory& memory, const Memory& hidden, Node paint, BlockPool& pool, const Octants& octants,
             std::uint64_t kept)
        : memory_(memory), hidden_(hidden), paint_(paint), pool_(pool), octants_(octants), kept_(kept) {
        if (memory.depth != hidden.depth)
            throw std::invalid_argument("the hidden voxels are those of a world of another depth");
    }

    Node root() { return node(memory_.root(), hidden_.root(), memory_.depth); }

private:
    struct Place {
        Word word;
        Word hidden;
        unsigned level;

        bool operator==(const Place&) const = default;
    };
    struct HashOfPlace {
        std::size_t operator()(const Place& place) const {
            const std::uint64_t mixed = (std::uint64_t{place.word} << 32 | place.hidden) * 0x9E3779B97F4A7C15u;
            return (mixed ^ mixed >> 32 ^ place.level) * 0xD6E8FEB86659FD93u;
        }
    };

    Node node(Word word, Word hidden, unsigned level) {
        if (is_leaf(hidden) && hidden != kEmpty)
            return paint_;
        if (is_leaf(word) && is_leaf(hidden))
            return word;
        const Place place{word, hidden, level};
        if (const auto known = nodes_.find(place); known != nodes_.end())
            return known->second;
        interrupt_.poll();
        if (const auto shown = octants_.find(word); shown != octants_.end() && shown->second >= kept_)
            hidden = kEmpty;
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = node(is_leaf(word) ? word : memory_.child(word, octant, level),
                                    is_leaf(hidden) ? hidden : hidden_.child(hidden, octant, level), level - 1);
        return nodes_[place] = pool_.intern(children);
    }

    Memory memory_;
    Memory hidden_;
    Node paint_;
    BlockPool& pool_;
    const Octants& octants_;
    std::uint64_t kept_;
    std::unordered_map<Place, Node, HashOfPlace> nodes_;
    Interrupt interrupt_;
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

std::vector<Word> fill_hidden(const Memory& memory, const Memory& hidden, std::uint8_t material) {
    BlockPool pool;
    const Octants none;
    const Node root = Painting(memory, hidden, leaf(material), pool, none, 0).root();
    return breadth_first_words(pool, root);
}

std::vector<Word> share_hidden(const Memory& memory, const Memory& hidden) {
    BlockPool canonical;
    std::vector<Word> best = breadth_first_words(canonical, coarsen(memory, 0, canonical));
    const std::vector<Word> words = best;
    const Memory whole{words.data(), words.size(), memory.depth};
    const auto keep_smaller = [&](std::vector<Word> other) {
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
        BlockPool painted;
        const Node root = Painting(whole, hidden, kAnySolid, painted, octants, kept).root();
        BlockPool pool;
        const Node shared = root == kAnySolid ? common : DontCareSharing(painted).shared(root, common, pool);
        keep_smaller(breadth_first_words(pool, shared));
    }
    return best;
}

} // namespace voxrt::octree
