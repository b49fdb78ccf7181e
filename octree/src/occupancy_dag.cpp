#include "occupancy_dag.h"

#include <voxrt/voxelize/interrupt.h>

#include <bit>
#include <string>
#include <unordered_map>

namespace voxrt::octree {
namespace {

// In the pool a node of level 2 is {kBitmap, low, high, 0 ...}; no block has that number. A node above it has the nodes
// of its octants; kEmpty is one without solid voxels.
constexpr Word kBitmap = 0x7FFFFFFFu;

constexpr unsigned bit_of(unsigned octant, unsigned inner) {
    const unsigned x = 2 * (octant & 1) + (inner & 1);
    const unsigned y = 2 * (octant >> 1 & 1) + (inner >> 1 & 1);
    const unsigned z = 2 * (octant >> 2) + (inner >> 2);
    return x + 4 * y + 16 * z;
}

class Encoding {
public:
    explicit Encoding(const Memory& memory) : memory_(memory) {}

    Words words() {
        const Node root = node(memory_.root(), memory_.depth);
        if (is_leaf(root))
            return {};
        order_.assign(1, root);
        address_.assign(pool_.size(), kUnknown);
        address_[root] = 0;
        std::size_t end = size_of(root);
        for (std::size_t next = 0; next < order_.size(); ++next) {
            const Block& block = pool_[order_[next]];
            if (block[0] == kBitmap)
                continue;
            for (const Node child : block) {
                if (is_leaf(child) || address_[child] != kUnknown)
                    continue;
                if (end >= kUnknown)
                    throw std::length_error("the graph has more than 2**32 words; lower the depth");
                address_[child] = static_cast<Word>(end);
                end += size_of(child);
                order_.push_back(child);
            }
        }
        Words words;
        words.reserve(end);
        for (const Node each : order_)
            write(pool_[each], words);
        return words;
    }

private:
    static constexpr Word kUnknown = 0xFFFFFFFFu;

    Node node(Word word, unsigned level) {
        if (word == kEmpty)
            return kEmpty;
        const std::uint64_t key = std::uint64_t{is_leaf(word) ? kTag : word} << 8 | level;
        if (const auto known = nodes_.find(key); known != nodes_.end())
            return known->second;
        work_.count_step();
        Block block{};
        if (level == kBitmapLevel) {
            const std::uint64_t bits = bitmap(word);
            block = {kBitmap, static_cast<Word>(bits), static_cast<Word>(bits >> 32)};
        } else {
            for (unsigned octant = 0; octant < 8; ++octant)
                block[octant] = node(is_leaf(word) ? word : memory_.child(word, octant, level), level - 1);
        }
        const Node made = pool_.intern(block);
        nodes_.emplace(key, made);
        return made;
    }

    std::uint64_t bitmap(Word word) const {
        std::uint64_t bits = 0;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child = is_leaf(word) ? word : memory_.child(word, octant, 2);
            for (unsigned inner = 0; inner < 8; ++inner) {
                const Word voxel = is_leaf(child) ? child : memory_.child(child, inner, 1);
                if (!is_leaf(voxel))
                    throw std::invalid_argument("the words are not a valid octree: a pointer leads below its depth");
                bits |= std::uint64_t{voxel != kEmpty} << bit_of(octant, inner);
            }
        }
        return bits;
    }

    std::size_t size_of(Node node) const {
        const Block& block = pool_[node];
        return block[0] == kBitmap ? 2 : 1 + std::popcount(mask_of(block));
    }

    static Word mask_of(const Block& block) {
        Word mask = 0;
        for (unsigned octant = 0; octant < 8; ++octant)
            mask |= Word{!is_leaf(block[octant])} << octant;
        return mask;
    }

    void write(const Block& block, Words& words) const {
        if (block[0] == kBitmap) {
            words.insert(words.end(), {block[1], block[2]});
            return;
        }
        words.push_back(mask_of(block));
        for (const Node child : block)
            if (!is_leaf(child))
                words.push_back(address_[child]);
    }

    Memory memory_;
    BlockPool pool_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::vector<Node> order_;
    std::vector<Word> address_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

class Decoding {
public:
    Decoding(const Word* words, std::size_t size, BlockPool& pool) : words_(words), size_(size), pool_(pool) {}

    Node node(std::size_t address, unsigned level) {
        const std::uint64_t key = std::uint64_t{address} << 8 | level;
        if (const auto known = nodes_.find(key); known != nodes_.end())
            return known->second;
        work_.count_step();
        const Node made = level == kBitmapLevel ? bitmap(address) : inner(address, level);
        nodes_.emplace(key, made);
        return made;
    }

private:
    Node inner(std::size_t address, unsigned level) {
        const Word mask = words_[address];
        if (mask == 0 || mask > 0xFF)
            refuse(address, "is no child mask of 1 ... 255");
        require_words(address, 1 + std::popcount(mask));
        Block children;
        std::size_t next = address;
        for (unsigned octant = 0; octant < 8; ++octant) {
            children[octant] = kEmpty;
            if ((mask >> octant & 1) == 0)
                continue;
            if (words_[++next] >= size_)
                refuse(next, "leads behind the last word");
            children[octant] = node(words_[next], level - 1);
        }
        return pool_.intern(children);
    }

    Node bitmap(std::size_t address) {
        require_words(address, 2);
        const std::uint64_t bits = words_[address] | std::uint64_t{words_[address + 1]} << 32;
        if (bits == 0)
            refuse(address, "begins a node without solid voxels");
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant) {
            Block voxels;
            for (unsigned inner = 0; inner < 8; ++inner)
                voxels[inner] = leaf(bits >> bit_of(octant, inner) & 1);
            children[octant] = pool_.intern(voxels);
        }
        return pool_.intern(children);
    }

    void require_words(std::size_t address, std::size_t count) const {
        if (size_ - address < count)
            refuse(address, "begins a node that ends behind the last word");
    }

    [[noreturn]] static void refuse(std::size_t address, const char* problem) {
        throw std::invalid_argument("word " + std::to_string(address) + " " + problem);
    }

    const Word* words_;
    std::size_t size_;
    BlockPool& pool_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

void require_depth(unsigned depth) {
    if (depth < kBitmapLevel || depth > kMaxDepth)
        throw std::invalid_argument("a graph has 2 ... 16 levels");
}

} // namespace

Words occupancy_dag(const Memory& memory) {
    require_depth(memory.depth);
    return Encoding(memory).words();
}

Node occupied_octree(const Word* words, std::size_t size, unsigned depth, BlockPool& pool) {
    require_depth(depth);
    return size == 0 ? kEmpty : Decoding(words, size, pool).node(0, depth);
}

} // namespace voxrt::octree
