// The edits of a world that can be undone, in the order in which they were made, each by its author.
//
// An edit is the voxels that it changed. A voxel has what the last edit that changed it, and is not undone, made of it.
// So the edits of others stay when one is undone: those before it, and those after it, which are made again.
#pragma once

#include "counted_blocks.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace voxrt::octree {

class EditHistory {
public:
    /// The steps that are kept at most, those that are undone among them; the oldest are forgotten first.
    EditHistory(CountedBlocks& blocks, std::size_t limit) : blocks_(blocks), limit_(limit) {}

    /// An edit that made `after` of `before`, which is the current root. It joins the newest step where that is of the
    /// same author and stroke, and `stroke` is not 0. Steps of its author that are undone are forgotten.
    void add(std::uint32_t author, std::uint32_t stroke, Word before, Word after);
    void forget() noexcept;

    /// Steps of an author that can be undone, or be done again.
    std::size_t count(std::uint32_t author, bool undone) const;
    bool empty() const { return steps_.empty(); }

    /// The number of the step of an author to undo next, or to do again. None where there is none.
    std::optional<std::size_t> next(std::uint32_t author, bool undone) const;

    /// The roots after a step and those behind it, if that step is undone, or done again. Throws what
    /// CountedBlocks::intern() throws; settle() then undoes that.
    std::vector<Word> turned(std::size_t number) const;

    /// Undoes a step, or does it again; `results` is what turned() returned for it.
    void turn(std::size_t number, const std::vector<Word>& results) noexcept;

    /// All roots that are kept.
    std::vector<Word> roots() const;

private:
    struct Step {
        std::uint32_t author, stroke;
        Word before, after; // roots: the edit is the voxels in which they differ
        Word result;        // the root with all steps up to this one
        bool undone;
    };
    void release(const Step& step) noexcept;

    CountedBlocks& blocks_;
    std::size_t limit_;
    std::deque<Step> steps_;
    Word begin_ = kEmpty; // the root before the first step
};

} // namespace voxrt::octree
