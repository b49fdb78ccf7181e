#include "breadth_first.h"

#include "shared_block_pool.h"

#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <atomic>

namespace voxrt::octree {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 12; // blocks per job
constexpr std::size_t kAhead = 8;                    // blocks whose memory is fetched before they are read

// What a block has in place of its address before its level is complete: the first reference to it, 8 x parent +
// octant. These numbers are higher than all addresses, and none is kUnmet.
constexpr Word kReference = Word{1} << 31;
constexpr Word kUnmet = ~Word{0};

void fetch([[maybe_unused]] const void* place) {
#if defined(__GNUC__)
    __builtin_prefetch(place);
#endif
}

// Level by level. Threads share the blocks of a level; each looks for the children of some. A child belongs to its
// first reference, which is the lowest number of all that were found, whichever thread came first.
template <typename Pool> class BreadthFirst {
public:
    BreadthFirst(const Pool& pool, int threads) : pool_(pool), workers_(threads), addresses_(pool.size() + 1) {
        for (Address& address : addresses_)
            address.store(kUnmet, std::memory_order_relaxed);
        addresses_[0].store(0, std::memory_order_relaxed); // of all leaves: a branch on them would be guessed wrongly
    }

    Words words(Node root) {
        order_.reserve(pool_.size());
        order_.push_back(root);
        address_of(root).store(1, std::memory_order_relaxed);
        for (std::size_t begin = 0; begin < order_.size();) {
            const std::size_t end = order_.size();
            add_children(begin, end);
            begin = end;
        }
        Words words(memory_size(order_.size()));
        words[0] = 1;
        for_each_piece(0, order_.size(), [&](std::size_t begin, std::size_t end) {
            visit(begin, end, [&](std::size_t i, unsigned octant, Node child, const Address& address) {
                words[block_address(i) + octant] = is_leaf(child) ? child : address.load(std::memory_order_relaxed);
            });
        });
        return words;
    }

private:
    using Address = std::atomic<Word>;
    struct Found {
        Node block;
        Word reference;
    };

    Address& address_of(Node node) { return addresses_[is_leaf(node) ? 0 : node + 1]; }

    template <typename Work> void for_each_piece(std::size_t begin, std::size_t end, Work work) {
        workers_.run((end - begin + kPiece - 1) / kPiece, [&](std::size_t piece, int) {
            voxelize::count_work(4 * kPiece);
            const std::size_t from = begin + piece * kPiece;
            work(from, std::min(end, from + kPiece));
        });
    }

    // Calls work(parent, octant, child, address of the child) for blocks begin ... end - 1 of the order.
    template <typename Work> void visit(std::size_t begin, std::size_t end, Work work) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i + 2 * kAhead < end)
                fetch(&pool_[order_[i + 2 * kAhead]]);
            if (i + kAhead < end)
                for (const Node child : pool_[order_[i + kAhead]])
                    fetch(&address_of(child));
            const Block& children = pool_[order_[i]];
            for (unsigned octant = 0; octant < 8; ++octant)
                work(i, octant, children[octant], address_of(children[octant]));
        }
    }

    // Appends the blocks that are first referred to by blocks begin ... end - 1 of the order.
    void add_children(std::size_t begin, std::size_t end) {
        std::vector<std::vector<Found>> found((end - begin + kPiece - 1) / kPiece);
        for_each_piece(begin, end, [&](std::size_t from, std::size_t to) {
            std::vector<Found>& own = found[(from - begin) / kPiece];
            visit(from, to, [&](std::size_t i, unsigned octant, Node child, Address& address) {
                const Word reference = kReference | static_cast<Word>(8 * i + octant);
                Word before = address.load(std::memory_order_relaxed);
                if (before <= reference)
                    return;
                while (before > reference &&
                       !address.compare_exchange_weak(before, reference, std::memory_order_relaxed)) {
                }
                own.push_back({child, reference});
            });
        });
        // Those that another piece has an earlier reference to are not this piece's.
        std::vector<std::size_t> starts{end};
        for_each_piece(begin, end, [&](std::size_t from, std::size_t) {
            std::erase_if(found[(from - begin) / kPiece], [&](const Found& one) {
                return address_of(one.block).load(std::memory_order_relaxed) != one.reference;
            });
        });
        for (const std::vector<Found>& own : found)
            starts.push_back(starts.back() + own.size());
        if (starts.back() > kBlockLimit)
            throw_too_many_blocks();
        order_.resize(starts.back());
        for_each_piece(begin, end, [&](std::size_t from, std::size_t) {
            const std::size_t piece = (from - begin) / kPiece;
            std::size_t to = starts[piece];
            for (const Found& one : found[piece]) {
                order_[to] = one.block;
                address_of(one.block).store(static_cast<Word>(block_address(to)), std::memory_order_relaxed);
                ++to;
            }
        });
    }

    const Pool& pool_;
    voxelize::Workers workers_;
    voxelize::LargeVector<Address> addresses_; // by 1 + number; 0: of leaves
    voxelize::LargeVector<Node> order_;
};

} // namespace

template <typename Pool> Words breadth_first_words(const Pool& pool, Node root, int threads) {
    if (is_leaf(root))
        return Words(1, root);
    return BreadthFirst<Pool>(pool, threads).words(root);
}

template Words breadth_first_words(const BlockPool&, Node, int);
template Words breadth_first_words(const SharedBlockPool&, Node, int);

} // namespace voxrt::octree
