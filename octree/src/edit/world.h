// An octree that is edited: a persistent data structure (Driscoll, Sarnak, Sleator and Tarjan, "Making Data Structures
// Persistent", 1989) over shared blocks, as in Careil, Billeter and Eisemann, "Interactively Modifying Compressed
// Sparse Voxel Representations", 2020.
//
//     World world({words.data(), words.size(), depth});
//     world.fill(Ball{{160, 160, 160}, 64}, 0);     // digs
//     const Patch patch = world.commit();           // what a device writes, before it takes the new root
//     world.release(older_root);                    // once no frame reads it any more
//
// An edit makes new blocks for what it changes, at most one per level for a voxel, and never changes a block that a
// root in use reaches. The octree is canonical after each edit: equal blocks are one, no block is uniform. A block that
// neither the current root, nor a step of undo or redo, nor a live root reaches is free, and the next edit uses it.
//
// One thread edits at a time. Others may meanwhile call view() and release(), and read views.
#pragma once

#include "../words/verify.h"
#include "counted_blocks.h"
#include "edit_history.h"
#include "live_roots.h"
#include "pieces.h"
#include "shapes.h"

#include <memory>
#include <optional>
#include <vector>

namespace voxrt::octree {

/// What a memory elsewhere needs to show the octree: blocks, which no live root reads, and then the root.
struct Patch {
    std::size_t root;            // address of the word that is the root
    Word root_word;              // what stands there; write it after the blocks
    std::vector<Word> addresses; // of the blocks, ascending
    std::vector<Block> blocks;
};

/// A live root to read, from any thread, while the world is edited.
class View {
public:
    View(std::shared_ptr<LiveRoots> roots, std::size_t address, const CountedBlocks& blocks, unsigned depth)
        : roots_(std::move(roots)), address_(address), root_(roots_->begin_view(address)), stored_(blocks.stored()),
          depth_(depth) {}
    ~View() { roots_->end_view(address_); }
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    /// Its words, as long as the view lives.
    VerifiedMemory memory() const { return VerifiedMemory::trusted(stored_.memory(depth_, root_)); }

private:
    std::shared_ptr<LiveRoots> roots_;
    std::size_t address_;
    Word root_;
    CountedBlocks::Stored stored_; // taken after the root: its blocks are there
    unsigned depth_;
};

struct WorldLimits {
    std::size_t words = memory_size(kBlockLimit); // of the memory, roots and free blocks among them
    std::size_t undo_steps = 100;
};

class World {
public:
    /// Takes over `memory`. Its blocks keep their addresses where it is canonical, and word 0 is its live root; else
    /// equal blocks are shared first, and image() is the memory to begin with. Blocks of other roots stay as they are,
    /// where the memory is canonical. Throws std::invalid_argument as VerifiedMemory does, std::length_error where it
    /// is larger than the limit.
    ///
    /// With the place of a root, which has the same word as word 0, that word is the live root where the memory is
    /// canonical, and the blocks that it does not reach are free.
    explicit World(const Memory& memory, const WorldLimits& limits = {}, std::optional<std::size_t> place = {});

    unsigned depth() const { return depth_; }

    /// Edits: false where the memory has no room for the result, or for the word of its root, which commit() writes.
    /// Then nothing changes. Steps of undo take room too, and all of them are forgotten where an edit needs it. What is
    /// outside of the world is left out.
    ///
    /// `points`: 3 * count coordinates, 0 ... 2**depth - 1. Where a voxel repeats, the last counts.
    [[nodiscard]] bool set(const std::int64_t* points, const std::uint8_t* materials, std::size_t count);
    [[nodiscard]] bool fill(const Shape& shape, std::uint8_t material);
    /// Solid voxels alone.
    [[nodiscard]] bool paint(const Shape& shape, std::uint8_t material);
    /// Puts the solid voxels of `piece` with coordinates 0 ... size - 1 here: turned by quarters of a turn around the y
    /// axis (pieces.h), their box has its lowest corner at `at`. `materials` replaces those of the piece.
    [[nodiscard]] bool paste(const Memory& piece, const std::array<std::int64_t, 3>& size,
                             const std::array<std::int64_t, 3>& at, unsigned quarters,
                             const std::array<std::uint8_t, 256>& materials);

    /// What a box has: see pieces.h.
    Copied copy(const Box& box) const;

    /// Edits, undo() and redo() are by this author from now on.
    void set_author(std::uint32_t author) { author_ = author; }

    /// Edits in a row by one author and of one stroke are one step of undo; those of stroke 0 are one each.
    void set_stroke(std::uint32_t stroke) { stroke_ = stroke; }

    /// Takes the last edit of the author back, and makes it again. False where there is no step. An edit ends what
    /// redo() has of its author. Edits of others stay: see edit_history.h. None where the memory has no room for the
    /// result, or for the word of its root; then nothing changes.
    std::optional<bool> undo() { return turn(false); }
    std::optional<bool> redo() { return turn(true); }
    std::size_t undo_steps(std::uint32_t author) const { return history_.count(author, false); }
    std::size_t redo_steps(std::uint32_t author) const { return history_.count(author, true); }

    /// The octree as it is now; words() has its own memory, as build() makes it of the same voxels.
    VerifiedMemory memory() const;
    Words words() const;

    /// Makes the current octree a live root. What the patch writes has room in a memory of the size of image().
    Patch commit();
    std::vector<LiveRoots::Root> live_roots() const { return roots_->roots(false); }

    /// From any thread: ends a live root other than the newest; makes a view of one. They throw std::invalid_argument
    /// where the root is not live.
    void release(std::size_t root) { roots_->release(root); }
    View view(std::size_t root) const { return {roots_, root, blocks_, depth_}; }

    /// All words, those of free blocks among them: what a memory has that got every patch.
    Words image() const;

    /// Addresses of the blocks that commit() has written and that are in use, ascending: a memory that got every patch
    /// has them as image() does.
    std::vector<Word> written() const;

    /// Frees what is no longer live, and counts the blocks from their parents and roots. Throws std::logic_error where
    /// a block is missing, counted wrongly, or not canonical: for tests.
    void check();

    struct Figures {
        std::size_t blocks; // of the current octree
        std::size_t kept;   // besides, for undo, redo and live roots
        std::size_t free;
    };
    Figures figures();

private:
    template <typename Edit> bool change(Edit edit);
    template <typename Edit> std::optional<Word> attempt(Edit edit);
    template <typename Edit> std::optional<Word> fitting(Edit edit);
    std::vector<std::uint8_t> reached(const std::vector<Word>& roots) const;
    std::vector<Word> needed_roots() const;
    std::optional<bool> turn(bool undone);
    void reserve_place(Word root);
    void add_places(std::size_t table, std::size_t used);
    void free_ended();

    unsigned depth_;
    WorldLimits limits_;
    CountedBlocks blocks_;
    Word root_ = kEmpty;
    EditHistory history_;
    std::uint32_t author_ = 0, stroke_ = 0;
    std::shared_ptr<LiveRoots> roots_ = std::make_shared<LiveRoots>();
    std::vector<std::size_t> tables_;      // addresses of blocks of root words
    std::vector<std::size_t> free_places_; // for root words; there is one while the current root is not committed
};

} // namespace voxrt::octree
