#include "world.h"

#include "../build/coarsen.h"
#include "../files/join.h"
#include "../pool/breadth_first.h"
#include "octant_edits.h"
#include "pieces.h"

#include <voxrt/voxelize/grid/morton.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace voxrt::octree {
namespace {

constexpr std::array<std::uint8_t, 256> same_materials() {
    std::array<std::uint8_t, 256> materials{};
    for (unsigned id = 0; id < 256; ++id)
        materials[id] = static_cast<std::uint8_t>(id);
    return materials;
}

constexpr std::size_t blocks_in(std::size_t words) { return words == 0 ? 0 : block_count(words - 1); }

// Where the lowest corner of a box at 0, 0, 0 stands after its octree of so many voxels per side was turned.
Place turned_corner(const Place& size, std::int64_t side, unsigned quarters) {
    switch (quarters % 4) {
    case 0:
        return {0, 0, 0};
    case 1:
        return {0, 0, side - size[0]};
    case 2:
        return {side - size[0], 0, side - size[2]};
    default:
        return {side - size[2], 0, 0};
    }
}

struct Settling {
    CountedBlocks& blocks;
    ~Settling() { blocks.settle(); }
};

} // namespace

World::World(const Memory& memory, const WorldLimits& limits, std::optional<std::size_t> place)
    : depth_(memory.depth), limits_(limits), history_(blocks_, limits.undo_steps) {
    const VerifiedMemory verified(memory);
    Words shared;
    if (!blocks_.load(memory, place)) {
        shared = coarsened(memory, 0);
        blocks_.load({shared.data(), shared.size(), depth_});
        place.reset();
    }
    root_ = shared.empty() ? memory.root() : shared[0];
    if (memory_size(blocks_.size()) > limits.words)
        throw std::length_error("the octree has " + std::to_string(memory_size(blocks_.size())) +
                                " words, and its memory would have " + std::to_string(limits.words));
    blocks_.set_limit(std::min(blocks_in(limits.words), kBlockLimit));
    const std::size_t root_place = place.value_or(0);
    if (root_place != 0)
        add_places(block_address(block_number(static_cast<Word>(root_place - 1))), root_place);
    roots_->add({root_place, root_});
    blocks_.retain(root_);
}

bool World::set(const std::int64_t* points, const std::uint8_t* materials, std::size_t count) {
    std::vector<VoxelEdit> edits(count);
    for (std::size_t i = 0; i < count; ++i)
        edits[i] = {voxelize::morton(static_cast<std::uint32_t>(points[3 * i]),
                                     static_cast<std::uint32_t>(points[3 * i + 1]),
                                     static_cast<std::uint32_t>(points[3 * i + 2])),
                    materials[i]};
    std::stable_sort(edits.begin(), edits.end(),
                     [](const VoxelEdit& a, const VoxelEdit& b) { return a.code < b.code; });
    // The last of those with one code stays.
    const auto last = std::unique(edits.rbegin(), edits.rend(),
                                  [](const VoxelEdit& a, const VoxelEdit& b) { return a.code == b.code; });
    edits.erase(edits.begin(), last.base());
    return change([&] { return set_voxels(blocks_, root_, depth_, edits); });
}

bool World::fill(const Shape& shape, std::uint8_t material) {
    return change([&] { return fill_shape(blocks_, root_, depth_, shape, material); });
}

bool World::paint(const Shape& shape, std::uint8_t material) {
    return change([&] { return paint_shape(blocks_, root_, depth_, shape, material); });
}

bool World::paste(const Memory& piece, const Place& size, const Place& at, unsigned quarters,
                  const std::array<std::uint8_t, 256>& materials) {
    BlockPool pool;
    Node node = turned(cut_out(piece, {{0, 0, 0}, size}, materials, pool), quarters, pool);
    const Place corner = turned_corner(size, std::int64_t{1} << piece.depth, quarters);
    node = moved(node, piece.depth, {at[0] - corner[0], at[1] - corner[1], at[2] - corner[2]}, depth_, pool);
    return change([&] { return overlay(blocks_, root_, pool, node); });
}

Copied World::copy(const Box& box) const { return copied(memory().memory(), box, same_materials()); }

VerifiedMemory World::memory() const { return VerifiedMemory::trusted(blocks_.stored().memory(depth_, root_)); }

Words World::words() const {
    BlockPool pool(blocks_.used());
    const Memory all{blocks_.stored().words->data(), memory_size(blocks_.size()), depth_, root_};
    JoiningPart<BlockPool> whole(pool, all);
    return breadth_first_words(pool, whole.join(kEmpty, root_, depth_));
}

Words World::image() const {
    const Word* words = blocks_.stored().words->data();
    return Words(words, words + memory_size(blocks_.size()));
}

std::vector<Word> World::written() const {
    std::vector<Word> found;
    for (std::size_t number = 0; number < blocks_.size(); ++number)
        if (const auto word = static_cast<Word>(block_address(number)); blocks_.is_written(word))
            found.push_back(word);
    return found;
}

Patch World::commit() {
    free_ended();
    const LiveRoots::Root newest = roots_->newest();
    if (newest.word == root_)
        return Patch{newest.address, newest.word, {}, {}};
    Patch patch{free_places_.back(), root_, {}, {}};
    try {
        std::vector<Word> open{root_};
        while (!open.empty()) {
            const Word word = open.back();
            open.pop_back();
            if (is_leaf(word) || blocks_.is_written(word))
                continue;
            patch.addresses.push_back(word);
            blocks_.mark_written(word, true);
            for (const Word child : blocks_.children(word))
                open.push_back(child);
        }
        std::sort(patch.addresses.begin(), patch.addresses.end());
        for (const Word address : patch.addresses)
            patch.blocks.push_back(blocks_.children(address));
        roots_->add({patch.root, root_});
    } catch (...) {
        for (const Word address : patch.addresses)
            blocks_.mark_written(address, false);
        throw;
    }
    free_places_.pop_back();
    blocks_.retain(root_);
    blocks_.set_word(patch.root, root_);
    return patch;
}

void World::check() {
    free_ended();
    std::vector<std::uint32_t> counts(blocks_.size(), 0);
    std::vector<Word> open = needed_roots();
    const std::vector<Word> kept = history_.roots();
    open.insert(open.end(), kept.begin(), kept.end());
    while (!open.empty()) {
        const Word word = open.back();
        open.pop_back();
        if (is_leaf(word) || counts.at(block_number(word))++ != 0)
            continue;
        const Block children = blocks_.children(word);
        if (blocks_.intern(children) != word)
            throw std::logic_error("the block at word " + std::to_string(word) + " is uniform, or stored twice");
        open.insert(open.end(), children.begin(), children.end());
    }
    for (const std::size_t table : tables_)
        ++counts[block_number(static_cast<Word>(table))];
    std::size_t used = 0;
    for (std::size_t number = 0; number < counts.size(); ++number) {
        used += counts[number] != 0;
        if (counts[number] != 0 && counts[number] != blocks_.count(number))
            throw std::logic_error("block " + std::to_string(number) + " is counted " +
                                   std::to_string(blocks_.count(number)) + " times and not " +
                                   std::to_string(counts[number]));
    }
    if (used != blocks_.used())
        throw std::logic_error(std::to_string(blocks_.used() - used) + " blocks are lost");
}

World::Figures World::figures() {
    free_ended();
    const std::vector<std::uint8_t> current = reached({root_});
    const auto blocks = static_cast<std::size_t>(std::accumulate(current.begin(), current.end(), std::size_t{0}));
    return {blocks, blocks_.used() - blocks, blocks_.size() - blocks_.used()};
}

// None where there is no room for what an edit or a step makes: then nothing is left of it.
template <typename Edit> std::optional<Word> World::attempt(Edit edit) {
    try {
        return edit();
    } catch (const NoRoom&) {
        blocks_.settle();
        return std::nullopt;
    }
}

// The edit, with the room of the steps of undo where it fits without them.
template <typename Edit> std::optional<Word> World::fitting(Edit edit) {
    const auto with_place = [&] {
        const Word root = edit();
        reserve_place(root);
        return root;
    };
    const std::optional<Word> root = attempt(with_place);
    if (root || history_.empty())
        return root;
    bool fits = false;
    {
        struct Unlimited {
            World& world;
            const std::size_t limit = std::min(blocks_in(world.limits_.words), kBlockLimit);
            ~Unlimited() {
                world.blocks_.settle();
                world.blocks_.set_limit(limit);
                world.blocks_.shrink_to_limit();
            }
        } unlimited{*this};
        blocks_.set_limit(kBlockLimit);
        if (const std::optional<Word> beyond = attempt(edit)) {
            std::vector<Word> roots = needed_roots();
            roots.push_back(*beyond);
            const std::vector<std::uint8_t> needed = reached(roots);
            const std::size_t tables = tables_.size() + (free_places_.empty() ? 1 : 0);
            fits = std::accumulate(needed.begin(), needed.end(), tables) <= unlimited.limit;
        }
    }
    if (!fits)
        return std::nullopt;
    history_.forget();
    return attempt(with_place);
}

template <typename Edit> bool World::change(Edit edit) {
    free_ended();
    const Settling settling{blocks_};
    const std::optional<Word> root = fitting(edit);
    if (!root || *root == root_)
        return root.has_value();
    blocks_.retain(*root);
    history_.add(author_, stroke_, root_, *root);
    blocks_.release(std::exchange(root_, *root));
    return true;
}

std::optional<bool> World::turn(bool undone) {
    free_ended();
    const std::optional<std::size_t> number = history_.next(author_, undone);
    if (!number)
        return false;
    const Settling settling{blocks_};
    std::vector<Word> results;
    const std::optional<Word> root = attempt([&] {
        results = history_.turned(*number);
        reserve_place(results.back());
        return results.back();
    });
    if (!root)
        return std::nullopt;
    blocks_.retain(*root);
    history_.turn(*number, results);
    blocks_.release(std::exchange(root_, *root));
    return true;
}

// Makes room for the words of eight more roots, if that of the next commit has none.
void World::reserve_place(Word root) {
    if (root == root_ || !free_places_.empty())
        return;
    tables_.reserve(tables_.size() + 1);
    free_places_.reserve(8 * (tables_.size() + 1)); // for free_ended(), too
    add_places(blocks_.add_table(), 0);
}

// Adds the words of a table but for the one that is used.
void World::add_places(std::size_t table, std::size_t used) {
    tables_.push_back(table);
    free_places_.reserve(8 * tables_.size());
    for (std::size_t place = table + 8; place-- > table;)
        if (place != used)
            free_places_.push_back(place);
}

std::vector<std::uint8_t> World::reached(const std::vector<Word>& roots) const {
    std::vector<std::uint8_t> flags(blocks_.size(), 0);
    std::vector<Word> open = roots;
    while (!open.empty()) {
        const Word word = open.back();
        open.pop_back();
        if (is_leaf(word) || flags[block_number(word)] != 0)
            continue;
        flags[block_number(word)] = 1;
        const Block children = blocks_.children(word);
        open.insert(open.end(), children.begin(), children.end());
    }
    return flags;
}

std::vector<Word> World::needed_roots() const {
    std::vector<Word> words = blocks_.kept();
    words.push_back(root_);
    for (const LiveRoots::Root& root : roots_->roots(true))
        words.push_back(root.word);
    return words;
}

void World::free_ended() {
    for (const LiveRoots::Root& root : roots_->take_ended()) {
        blocks_.release(root.word);
        if (root.address != 0)
            free_places_.push_back(root.address); // reserve_place() made room for it
    }
}

} // namespace voxrt::octree
