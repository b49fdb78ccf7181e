// The blocks of a memory that changes: equal ones stored once, counted, and used again.
//
// The words stand as a memory has them, block k at address 1 + 8k. A block is counted once per word that points to it
// and once per root that is kept. A block that nothing counts is free, and the next new block takes its place. A new
// block is free of references until another block or a root gets it: so an edit that fails leaves nothing behind.
//
//     const Word word = blocks.intern(children);   // as often as the edit needs
//     blocks.retain(word);                         // the new root
//     blocks.settle();                             // frees the new blocks that no root reaches
#pragma once

#include "../pool/block_hash.h"
#include "../words/memory.h"

#include <voxrt/voxelize/work/mutex.h>

#include <memory>
#include <optional>
#include <vector>

namespace voxrt::octree {

/// Thrown where a new block would be beyond the limit.
struct NoRoom {};

class CountedBlocks {
public:
    /// Takes over the blocks of `memory`, each at its address. Its root is counted once. So are blocks that the root
    /// does not reach, for good: other roots may reach them, as those of an animation. The memory is verified. False
    /// where it is not canonical, since blocks are equal or uniform: then load another.
    ///
    /// With the place of another word that is the root, blocks that it does not reach are free. The block of the place
    /// becomes a table, as add_table() makes it; place 0 is in none.
    bool load(const Memory& memory, std::optional<std::size_t> place = {});

    /// The most blocks from now on.
    void set_limit(std::size_t blocks) { limit_ = blocks; }

    /// The word of eight children: their leaf where all are the same leaf, else a pointer to their block. Throws NoRoom
    /// where a new block is needed and the limit is reached.
    Word intern(const Block& children);

    /// A block that is never found by its children: its words are written by set_word(). Counted once.
    std::size_t add_table();
    void set_word(std::size_t address, Word word) { (*words_)[address] = word; }

    /// The children of an octant.
    Block children(Word word) const {
        Block found;
        if (is_leaf(word))
            found.fill(word);
        else
            std::memcpy(found.data(), &(*words_)[word], sizeof found);
        return found;
    }

    void retain(Word word) noexcept {
        if (!is_leaf(word))
            ++counts_[block_number(word)];
    }
    void release(Word word) noexcept {
        if (!is_leaf(word) && --counts_[block_number(word)] == 0)
            free(static_cast<Word>(block_number(word)));
    }

    /// Frees the blocks that intern() made since the last call and that nothing counts.
    void settle() noexcept;

    /// Gives up the free blocks from the limit on, which are at the end.
    void shrink_to_limit();

    /// Whether a memory elsewhere has this block, as load() and mark_written() say, until the block is free.
    bool is_written(Word word) const { return written_[block_number(word)] != 0; }
    void mark_written(Word word, bool written) noexcept { written_[block_number(word)] = written; }

    /// Blocks of the memory, free ones among them; those that are counted.
    std::size_t size() const { return counts_.size(); }
    std::size_t used() const { return counts_.size() - free_.size(); }
    const std::vector<Word>& kept() const { return kept_; } // blocks that load() counted besides the root
    std::uint32_t count(std::size_t number) const { return counts_[number]; }

    /// The words, and room for more; the next new block may move them, and the pointer keeps those that stand here.
    /// Callable from any thread.
    struct Stored {
        std::shared_ptr<const Words> words;
        Memory memory(unsigned depth, Word root) const { return {words->data(), words->size(), depth, root}; }
    };
    Stored stored() const {
        const voxelize::Lock lock(moving_);
        return {words_};
    }

private:
    struct Slot {
        Word tag;
        Word number;
    };
    static constexpr Word kFree = ~Word{0}; // the number in a free slot; the count of a free block

    bool take_over(Word word);
    void reserve(std::size_t blocks);
    Word take_number();
    std::size_t find(const Block& children, Word tag) const;
    void put(Word tag, Word number);
    void grow_table();
    void free(Word number) noexcept;

    std::shared_ptr<Words> words_ = std::make_shared<Words>(1, kEmpty); // with room for more
    std::size_t limit_ = kBlockLimit;
    std::vector<std::uint32_t> counts_; // by block
    std::vector<std::uint8_t> written_; // by block
    std::vector<Word> kept_;            // by load()
    std::vector<Word> free_;            // numbers; the last is used next
    std::vector<Word> fresh_;           // numbers, in the order in which they were made
    std::vector<Slot> slots_;           // a hash table with linear probing; half of it is free
    std::size_t filled_ = 0;            // slots
    mutable voxelize::Mutex moving_;    // held where words_ is replaced
};

} // namespace voxrt::octree
