#include "breadth_first.h"

#include "shared_block_pool.h"

#include <voxrt/voxelize/workers.h>

#include <algorithm>

namespace voxrt::octree {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 14; // blocks per job
constexpr std::size_t kBlockLimit = (std::size_t{1} << 28) - 1;

// Blocks in breadth-first order of first visit. What was visited is a bit per block, since a table of all blocks does
// not fit a cache. Leaves have a bit too: a branch on them would be guessed wrongly every other time.
template <typename Pool> std::vector<Node> breadth_first_order(const Pool& pool, Node root) {
    std::vector<std::uint64_t> visited(1 + (pool.size() + 63) / 64, 0);
    visited[0] = 1; // of leaves
    constexpr Node first = 64;
    std::vector<Node> order;
    const auto visit = [&](Node node) {
        const Node place = is_leaf(node) ? 0 : node + first;
        std::uint64_t& bits = visited[place / 64];
        const std::uint64_t bit = std::uint64_t{1} << place % 64;
        if ((bits & bit) == 0) {
            bits |= bit;
            order.push_back(node);
        }
    };
    visit(root);
    for (std::size_t next = 0; next < order.size(); ++next) {
        const Block children = pool[order[next]];
        for (const Node child : children)
            visit(child);
    }
    return order;
}

} // namespace

template <typename Pool> std::vector<Word> breadth_first_words(const Pool& pool, Node root, int threads) {
    if (is_leaf(root))
        return {root};
    const std::vector<Node> order = breadth_first_order(pool, root);
    if (order.size() > kBlockLimit)
        throw std::length_error(
            "the octree has more than 2**28 - 1 blocks, which 31-bit addresses cannot reach; lower the depth");
    const auto in_pieces = [&](auto work) {
        voxelize::Workers(threads).run((order.size() + kPiece - 1) / kPiece, [&](std::size_t piece, int) {
            voxelize::count_work(4 * kPiece);
            const std::size_t end = std::min(order.size(), (piece + 1) * kPiece);
            for (std::size_t i = piece * kPiece; i < end; ++i)
                work(i);
        });
    };
    std::vector<Word> address(pool.size());
    in_pieces([&](std::size_t i) { address[order[i]] = static_cast<Word>(1 + 8 * i); });
    std::vector<Word> words(1 + 8 * order.size());
    words[0] = 1;
    in_pieces([&](std::size_t i) {
        Word* to = words.data() + 1 + 8 * i;
        for (const Node child : pool[order[i]]) {
            const Word at = address[is_leaf(child) ? 0 : child];
            *to++ = is_leaf(child) ? child : at;
        }
    });
    return words;
}

template std::vector<Word> breadth_first_words(const BlockPool&, Node, int);
template std::vector<Word> breadth_first_words(const SharedBlockPool&, Node, int);

} // namespace voxrt::octree
