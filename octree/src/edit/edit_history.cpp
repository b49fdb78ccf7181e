#include "edit_history.h"

#include "octant_edits.h"

#include <algorithm>
#include <utility>

namespace voxrt::octree {

void EditHistory::add(std::uint32_t author, std::uint32_t stroke, Word before, Word after) {
    if (stroke != 0 && !steps_.empty()) {
        Step& last = steps_.back();
        // Where a step before it was undone since, more than this edit differs from what the stroke has made.
        if (last.author == author && last.stroke == stroke && !last.undone && last.after == before) {
            for (Word* kept : {&last.after, &last.result}) {
                blocks_.retain(after);
                blocks_.release(std::exchange(*kept, after));
            }
            return;
        }
    }
    steps_.push_back({author, stroke, before, after, after, false});
    for (const Word word : {before, after, after})
        blocks_.retain(word);
    if (steps_.size() == 1) {
        begin_ = before;
        blocks_.retain(begin_);
    }
    // The root after a step that is undone is that before it.
    std::erase_if(steps_, [&](const Step& step) {
        const bool ended = step.undone && step.author == author;
        if (ended)
            release(step);
        return ended;
    });
    while (steps_.size() > limit_) {
        blocks_.retain(steps_.front().result);
        blocks_.release(begin_);
        begin_ = steps_.front().result;
        release(steps_.front());
        steps_.pop_front();
    }
    if (steps_.empty())
        forget();
}

void EditHistory::forget() noexcept {
    for (const Step& step : steps_)
        release(step);
    steps_.clear();
    blocks_.release(begin_);
    begin_ = kEmpty;
}

std::size_t EditHistory::count(std::uint32_t author, bool undone) const {
    return static_cast<std::size_t>(std::count_if(steps_.begin(), steps_.end(), [&](const Step& step) {
        return step.author == author && step.undone == undone;
    }));
}

std::optional<std::size_t> EditHistory::next(std::uint32_t author, bool undone) const {
    std::optional<std::size_t> found;
    for (std::size_t number = 0; number < steps_.size() && !(found && undone); ++number)
        if (steps_[number].author == author && steps_[number].undone == undone)
            found = number;
    return found;
}

std::vector<Word> EditHistory::turned(std::size_t number) const {
    Word root = number == 0 ? begin_ : steps_[number - 1].result;
    std::vector<Word> results;
    for (std::size_t i = number; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        if (step.undone == (i == number))
            root = with_changes(blocks_, root, step.before, step.after);
        results.push_back(root);
    }
    return results;
}

void EditHistory::turn(std::size_t number, const std::vector<Word>& results) noexcept {
    steps_[number].undone = !steps_[number].undone;
    for (std::size_t i = 0; i < results.size(); ++i) {
        blocks_.retain(results[i]);
        blocks_.release(steps_[number + i].result);
        steps_[number + i].result = results[i];
    }
}

std::vector<Word> EditHistory::roots() const {
    std::vector<Word> found{begin_};
    for (const Step& step : steps_)
        found.insert(found.end(), {step.before, step.after, step.result});
    return found;
}

void EditHistory::release(const Step& step) noexcept {
    for (const Word word : {step.before, step.after, step.result})
        blocks_.release(word);
}

} // namespace voxrt::octree
