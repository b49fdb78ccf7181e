#include "counted_blocks.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>

namespace voxrt::octree {

bool CountedBlocks::load(const Memory& memory, std::optional<std::size_t> place) {
    const std::size_t blocks = block_count(memory.size);
    counts_.clear();
    free_.clear();
    slots_.clear();
    filled_ = 0;
    reserve(blocks + blocks / 8 + 64); // the first edits need not move all
    std::copy_n(memory.words, memory.size, words_->data());
    counts_.assign(blocks, 0);
    written_.assign(blocks, 1);
    grow_table();
    kept_.clear();
    retain(memory.root());
    if (!take_over(memory.root()))
        return false;
    if (place.value_or(0) != 0) // no block that is reached has the word that leads to all of them
        counts_[block_number(static_cast<Word>(*place - 1))] = 1;
    for (std::size_t number = 0; number < blocks; ++number)
        if (counts_[number] == 0 && place) {
            counts_[number] = kFree;
            written_[number] = 0;
            free_.push_back(static_cast<Word>(number));
        } else if (counts_[number] == 0) {
            kept_.push_back(static_cast<Word>(block_address(number)));
            retain(kept_.back());
            if (!take_over(kept_.back()))
                return false;
        }
    return true;
}

// Enters the blocks below a word whose block was counted for the first time. False where one is not canonical, or is no
// block: those that the root reaches are verified, others are not.
bool CountedBlocks::take_over(Word word) {
    std::vector<Word> open;
    if (!is_leaf(word))
        open.push_back(word);
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    while (!open.empty()) {
        work.count_step();
        const Word block = open.back();
        open.pop_back();
        const Block below = children(block);
        const Word tag = block_tag(block_hash(below));
        const std::size_t slot = find(below, tag);
        if (slots_[slot].number != kFree || (is_leaf(below[0]) && is_uniform(below)))
            return false;
        slots_[slot] = {tag, static_cast<Word>(block_number(block))};
        if (2 * ++filled_ > slots_.size())
            grow_table();
        for (const Word child : below) {
            if (is_leaf(child))
                continue;
            if (!is_block_address(child) || block_number(child) >= counts_.size())
                return false;
            if (counts_[block_number(child)]++ == 0)
                open.push_back(child);
        }
    }
    return true;
}

Word CountedBlocks::intern(const Block& children) {
    if (is_leaf(children[0]) && is_uniform(children))
        return children[0];
    const Word tag = block_tag(block_hash(children));
    const std::size_t slot = find(children, tag);
    if (slots_[slot].number != kFree)
        return static_cast<Word>(block_address(slots_[slot].number));
    const Word number = take_number();
    const std::size_t address = block_address(number);
    std::memcpy(&(*words_)[address], children.data(), sizeof children);
    counts_[number] = 0;
    fresh_.push_back(number);
    for (const Word child : children)
        retain(child);
    slots_[slot] = {tag, number};
    if (2 * ++filled_ > slots_.size())
        grow_table();
    return static_cast<Word>(address);
}

std::size_t CountedBlocks::add_table() {
    const Word number = take_number();
    counts_[number] = 1;
    const std::size_t address = block_address(number);
    std::fill_n(&(*words_)[address], 8, kEmpty);
    return address;
}

void CountedBlocks::settle() noexcept {
    while (!fresh_.empty()) {
        const Word number = fresh_.back();
        fresh_.pop_back();
        if (counts_[number] == 0)
            free(number);
    }
}

void CountedBlocks::shrink_to_limit() {
    if (counts_.size() <= limit_)
        return;
    std::erase_if(free_, [this](Word number) { return number >= limit_; });
    counts_.resize(limit_);
    written_.resize(limit_);
}

// A free block, the last that was freed, or a new one at the end. Changes nothing where it throws.
Word CountedBlocks::take_number() {
    if (!free_.empty()) {
        const Word number = free_.back();
        free_.pop_back();
        written_[number] = 0;
        return number;
    }
    if (counts_.size() >= limit_)
        throw NoRoom();
    if (memory_size(counts_.size()) == words_->size())
        reserve(2 * counts_.size());
    counts_.push_back(0); // none of these throws: reserve() made room
    written_.push_back(0);
    return static_cast<Word>(counts_.size() - 1);
}

void CountedBlocks::reserve(std::size_t blocks) {
    blocks = std::min(blocks, kBlockLimit);
    counts_.reserve(blocks);
    written_.reserve(blocks);
    free_.reserve(blocks); // so that free() does not throw
    fresh_.reserve(blocks);
    auto larger = std::make_shared<Words>(memory_size(blocks));
    std::copy_n(words_->data(), memory_size(counts_.size()), larger->data());
    const voxelize::Lock lock(moving_);
    words_.swap(larger);
}

// The slot of a block, or the free one that it would get.
std::size_t CountedBlocks::find(const Block& children, Word tag) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = tag & mask;
    for (; slots_[i].number != kFree; i = (i + 1) & mask)
        if (slots_[i].tag == tag &&
            std::memcmp(&(*words_)[block_address(slots_[i].number)], children.data(), sizeof children) == 0)
            break;
    return i;
}

void CountedBlocks::grow_table() {
    std::vector<Slot> old(std::max<std::size_t>(1024, 2 * slots_.size()), Slot{0, kFree});
    old.swap(slots_);
    const std::size_t mask = slots_.size() - 1;
    for (const Slot& slot : old) {
        if (slot.number == kFree)
            continue;
        std::size_t i = slot.tag & mask;
        while (slots_[i].number != kFree)
            i = (i + 1) & mask;
        slots_[i] = slot;
    }
}

// The slots behind the one that becomes free move up, as far as their blocks' own places allow: Knuth, "The Art of
// Computer Programming", volume 3, 6.4, algorithm R.
void CountedBlocks::free(Word number) noexcept {
    const Block below = children(static_cast<Word>(block_address(number)));
    const std::size_t mask = slots_.size() - 1;
    std::size_t hole = block_tag(block_hash(below)) & mask;
    while (slots_[hole].number != number)
        hole = (hole + 1) & mask;
    for (std::size_t i = (hole + 1) & mask; slots_[i].number != kFree; i = (i + 1) & mask)
        if (((i - slots_[i].tag) & mask) >= ((i - hole) & mask)) {
            slots_[hole] = slots_[i];
            hole = i;
        }
    slots_[hole].number = kFree;
    --filled_;
    counts_[number] = kFree;
    free_.push_back(number);
    for (const Word child : below)
        release(child);
}

} // namespace voxrt::octree
