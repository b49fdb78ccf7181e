#include "octant_edits.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

namespace voxrt::octree {
namespace {

// Calls change(child, octant) for the children of a word, and returns the word of what it returns.
template <typename Change> Word change_children(CountedBlocks& blocks, Word word, Change change) {
    voxelize::WorkCounter::current().count_step();
    Block children = blocks.children(word);
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = change(children[octant], octant);
    return blocks.intern(children);
}

Word set_range(CountedBlocks& blocks, Word word, unsigned level, const VoxelEdit* begin, const VoxelEdit* end) {
    if (begin == end)
        return word;
    if (level == 0)
        return leaf(begin->material);
    const unsigned shift = 3 * (level - 1);
    return change_children(blocks, word, [&](Word child, unsigned octant) {
        const VoxelEdit* first = begin;
        begin = std::find_if(begin, end, [&](const VoxelEdit& edit) { return (edit.code >> shift & 7) != octant; });
        return set_range(blocks, child, level - 1, first, begin);
    });
}

template <typename AnyShape> class Filling {
public:
    Filling(CountedBlocks& blocks, const AnyShape& shape, std::uint8_t material, bool solid_only)
        : blocks_(blocks), shape_(shape), leaf_(leaf(material)), solid_only_(solid_only) {}

    Word node(Word word, unsigned level, const Place& corner) {
        if (word == leaf_ || (solid_only_ && word == kEmpty))
            return word;
        switch (cover(shape_, corner, level)) {
        case Cover::none:
            return word;
        case Cover::all:
            return solid_only_ ? painted(word) : leaf_;
        default:
            return change_children(blocks_, word, [&](Word child, unsigned octant) {
                return node(child, level - 1, child_corner(corner, octant, std::int64_t{1} << (level - 1)));
            });
        }
    }

private:
    Word painted(Word word) {
        if (is_leaf(word))
            return word == kEmpty ? word : leaf_;
        if (const auto entry = painted_.find(word); entry != painted_.end())
            return entry->second;
        const Word result = change_children(blocks_, word, [&](Word child, unsigned) { return painted(child); });
        painted_.emplace(word, result);
        return result;
    }

    CountedBlocks& blocks_;
    const AnyShape& shape_;
    Word leaf_;
    bool solid_only_;
    std::unordered_map<Word, Word> painted_;
};

Word fill(CountedBlocks& blocks, Word root, unsigned depth, const Shape& shape, std::uint8_t material,
          bool solid_only) {
    return std::visit(
        [&](const auto& one) { return Filling(blocks, one, material, solid_only).node(root, depth, {0, 0, 0}); },
        shape);
}

class Overlay {
public:
    Overlay(CountedBlocks& blocks, const BlockPool& pool) : blocks_(blocks), pool_(pool) {}

    Word node(Word word, Node piece) {
        if (is_leaf(piece))
            return piece == kEmpty ? word : piece;
        const std::uint64_t key = std::uint64_t{word} << 32 | piece;
        if (const auto entry = results_.find(key); entry != results_.end())
            return entry->second;
        const Word result = change_children(
            blocks_, word, [&](Word child, unsigned octant) { return node(child, pool_[piece][octant]); });
        results_.emplace(key, result);
        return result;
    }

private:
    CountedBlocks& blocks_;
    const BlockPool& pool_;
    std::unordered_map<std::uint64_t, Word> results_;
};

class Changes {
public:
    explicit Changes(CountedBlocks& blocks) : blocks_(blocks) {}

    Word node(Word word, Word before, Word after) {
        if (before == after)
            return word;
        if (word == before || word == after || (is_leaf(before) && is_leaf(after)))
            return after;
        const std::array<Word, 3> key{word, before, after};
        if (const auto entry = results_.find(key); entry != results_.end())
            return entry->second;
        const Block old = blocks_.children(before), made = blocks_.children(after);
        const Word result = change_children(
            blocks_, word, [&](Word child, unsigned octant) { return node(child, old[octant], made[octant]); });
        results_.emplace(key, result);
        return result;
    }

private:
    CountedBlocks& blocks_;
    std::map<std::array<Word, 3>, Word> results_;
};

} // namespace

Word set_voxels(CountedBlocks& blocks, Word root, unsigned depth, const std::vector<VoxelEdit>& edits) {
    return set_range(blocks, root, depth, edits.data(), edits.data() + edits.size());
}

Word fill_shape(CountedBlocks& blocks, Word root, unsigned depth, const Shape& shape, std::uint8_t material) {
    return fill(blocks, root, depth, shape, material, false);
}

Word paint_shape(CountedBlocks& blocks, Word root, unsigned depth, const Shape& shape, std::uint8_t material) {
    return fill(blocks, root, depth, shape, material, true);
}

Word overlay(CountedBlocks& blocks, Word root, const BlockPool& pool, Node piece) {
    return Overlay(blocks, pool).node(root, piece);
}

Word with_changes(CountedBlocks& blocks, Word root, Word before, Word after) {
    return Changes(blocks).node(root, before, after);
}

} // namespace voxrt::octree
