// Edits a World and an array of its voxels alike, and says where they differ. Whoever uses it makes the choices:
// numbers below a count.
#pragma once

#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/edit/world.h>
#include <voxrt/octree/query/query.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <thread>

namespace editing {

using namespace voxrt::octree;
using Cells = std::vector<std::uint8_t>; // z fastest, then y, then x
using Choose = std::function<std::uint64_t(std::uint64_t count)>;
using Fail = std::function<void(const char* what)>;

inline Cells cells_of(const Memory& memory) {
    const std::int64_t side = std::int64_t{1} << memory.depth;
    Cells cells(static_cast<std::size_t>(side * side * side));
    fill_region(memory, {{0, 0, 0}, {side, side, side}}, cells.data());
    return cells;
}

inline Words words_of(const Cells& cells, unsigned depth) {
    const std::size_t side = std::size_t{1} << depth;
    return build_dense(cells.data(), side, side, side, depth);
}

inline std::unique_ptr<World> world_of(const Cells& cells, unsigned depth, const WorldLimits& limits) {
    const Words words = words_of(cells, depth);
    return std::make_unique<World>(Memory{words.data(), words.size(), depth}, limits);
}

class Editing {
public:
    Editing(Choose choose, Fail fail, unsigned depth, const WorldLimits& limits)
        : choose_(std::move(choose)), fail_(std::move(fail)), depth_(depth), side_(std::int64_t{1} << depth),
          cells_(static_cast<std::size_t>(side_ * side_ * side_)), world_(world_of(cells_, depth, limits)),
          device_(world_->image()), limits_(limits), begin_(cells_) {
        live_[0] = cells_;
    }

    void step() {
        const Cells before = cells_;
        author_ = static_cast<std::uint32_t>(choose_(kAuthors));
        world_->set_author(author_);
        stroke_ = limits_.words < WorldLimits().words ? 0 : static_cast<std::uint32_t>(choose_(3));
        world_->set_stroke(stroke_);
        refused_ = false;
        switch (choose_(8)) {
        case 0:
        case 1:
            set();
            break;
        case 2:
            shape(false);
            break;
        case 3:
            shape(true);
            break;
        case 4:
            paste();
            break;
        case 5:
            turn(false);
            break;
        case 6:
            turn(true);
            break;
        default:
            commit();
        }
        world_->check();
        if (!turned_ && cells_ != before)
            remember(before);
        turned_ = false;
        for (std::uint32_t author = 0; author < kAuthors; ++author)
            if (world_->undo_steps(author) != count(author, false) || world_->redo_steps(author) != count(author, true))
                fail_("the steps of undo are not those of the edits");
        if (world_->words() != words_of(cells_, depth_))
            fail_("the words are not those of a build");
    }

    void finish() {
        for (std::thread& reader : readers_)
            reader.join();
        for (const auto& [root, cells] : live_)
            if (cells_of({device_.data(), device_.size(), depth_, device_[root]}) != cells)
                fail_("a patched memory has other voxels");
    }

private:
    static constexpr std::uint32_t kAuthors = 3;
    struct Made {
        std::uint32_t author, stroke;
        Cells before, after;
        bool undone;
    };

    std::size_t count(std::uint32_t author, bool undone) const {
        return static_cast<std::size_t>(std::count_if(history_.begin(), history_.end(), [&](const Made& one) {
            return one.author == author && one.undone == undone;
        }));
    }
    static void make_again(Cells& cells, const Made& one) {
        for (std::size_t i = 0; i < cells.size() && !one.undone; ++i)
            if (one.before[i] != one.after[i])
                cells[i] = one.after[i];
    }

    void remember(const Cells& before) {
        if (Made* last = history_.empty() ? nullptr : &history_.back();
            last != nullptr && stroke_ != 0 && !last->undone && last->author == author_ && last->stroke == stroke_ &&
            last->after == before) {
            last->after = cells_;
            return;
        }
        std::erase_if(history_, [&](const Made& one) { return one.undone && one.author == author_; });
        history_.push_back({author_, stroke_, before, cells_, false});
        std::size_t steps = 0;
        for (std::uint32_t author = 0; author < kAuthors; ++author)
            steps += world_->undo_steps(author) + world_->redo_steps(author);
        const bool forgotten =
            steps == std::min<std::size_t>(1, limits_.undo_steps); // the edit needed the room of the others
        for (const std::size_t most = forgotten ? steps : limits_.undo_steps; history_.size() > most;) {
            make_again(begin_, history_.front());
            history_.erase(history_.begin());
        }
        if (forgotten)
            begin_ = before;
    }

    void turn(bool undone) {
        turned_ = true;
        const std::optional<bool> found = undone ? world_->redo() : world_->undo();
        refused_ = !found;
        if (refused_)
            return;
        const auto fits = [&](const Made& one) { return one.author == author_ && one.undone == undone; };
        const auto first = std::find_if(history_.begin(), history_.end(), fits);
        const auto last = std::find_if(history_.rbegin(), history_.rend(), fits);
        if (*found != (first != history_.end()))
            fail_("there are other steps of undo");
        if (!*found)
            return;
        (undone ? *first : *last).undone = !undone;
        cells_ = begin_;
        for (const Made& one : history_)
            make_again(cells_, one);
    }

    std::int64_t any(std::int64_t low, std::int64_t high) {
        return low + static_cast<std::int64_t>(choose_(static_cast<std::uint64_t>(high - low)));
    }
    std::uint8_t& cell(std::int64_t x, std::int64_t y, std::int64_t z) {
        return cells_[static_cast<std::size_t>((x * side_ + y) * side_ + z)];
    }

    void set() {
        std::vector<std::int64_t> points;
        Cells materials;
        Cells edited = cells_;
        for (std::uint64_t count = 1 + choose_(6); count > 0; --count) {
            for (int axis = 0; axis < 3; ++axis)
                points.push_back(any(0, side_));
            materials.push_back(static_cast<std::uint8_t>(choose_(3)));
            const std::int64_t* point = points.data() + points.size() - 3;
            edited[static_cast<std::size_t>((point[0] * side_ + point[1]) * side_ + point[2])] = materials.back();
        }
        refused_ = !world_->set(points.data(), materials.data(), materials.size());
        if (!refused_)
            cells_ = edited;
    }

    void shape(bool solid_only) {
        const auto material = static_cast<std::uint8_t>(solid_only ? 1 + choose_(3) : choose_(3));
        const auto place = [&] { return Place{any(-9, 16 * side_), any(-9, 16 * side_), any(-9, 16 * side_)}; };
        Shape shape = Box{{any(-2, side_), any(-2, side_), any(-2, side_)}, {any(0, side_ + 2), side_, side_}};
        if (choose_(3) == 0)
            shape = Ball{place(), any(0, 8 * side_)};
        else if (choose_(2) == 0)
            shape = Capsule{place(), place(), any(0, 4 * side_)};
        refused_ = !(solid_only ? world_->paint(shape, material) : world_->fill(shape, material));
        if (refused_)
            return;
        for (std::int64_t x = 0; x < side_; ++x)
            for (std::int64_t y = 0; y < side_; ++y)
                for (std::int64_t z = 0; z < side_; ++z)
                    if ((!solid_only || cell(x, y, z) != 0) &&
                        std::visit([&](const auto& one) { return cover(one, {x, y, z}, 0); }, shape) == Cover::all)
                        cell(x, y, z) = material;
    }

    void paste() {
        const Place low{any(-2, side_), any(-2, side_), any(-2, side_)};
        const Place size{any(1, side_ + 2), any(1, side_ + 2), any(1, side_ + 2)};
        const Place at{any(-side_, side_), any(-side_, side_), any(-side_, side_)};
        const Copied copied = world_->copy({low, {low[0] + size[0], low[1] + size[1], low[2] + size[2]}});
        std::array<std::uint8_t, 256> materials;
        for (unsigned id = 0; id < 256; ++id)
            materials[id] = static_cast<std::uint8_t>(id == 2 ? 3 : id);
        const auto quarters = static_cast<unsigned>(choose_(4));
        refused_ =
            !world_->paste({copied.words.data(), copied.words.size(), copied.depth}, size, at, quarters, materials);
        if (refused_)
            return;
        const Cells before = cells_;
        for (std::int64_t x = 0; x < size[0]; ++x)
            for (std::int64_t y = 0; y < size[1]; ++y)
                for (std::int64_t z = 0; z < size[2]; ++z) {
                    const Place from{low[0] + x, low[1] + y, low[2] + z};
                    Place to{x, y, z};
                    if (quarters % 2 == 1)
                        to = {z, y, size[0] - 1 - x};
                    const std::int64_t width = quarters % 2 == 1 ? size[2] : size[0];
                    const std::int64_t length = quarters % 2 == 1 ? size[0] : size[2];
                    if (quarters >= 2)
                        to = {width - 1 - to[0], y, length - 1 - to[2]};
                    bool inside = true;
                    for (unsigned axis = 0; axis < 3; ++axis) {
                        to[axis] += at[axis];
                        inside =
                            inside && std::min(from[axis], to[axis]) >= 0 && std::max(from[axis], to[axis]) < side_;
                    }
                    if (!inside)
                        continue;
                    const auto number = static_cast<std::size_t>((from[0] * side_ + from[1]) * side_ + from[2]);
                    if (before[number] != 0)
                        cell(to[0], to[1], to[2]) = materials[before[number]];
                }
    }

    void commit() {
        const Patch patch = world_->commit();
        device_.resize(std::max(device_.size(), world_->image().size()), kEmpty);
        for (std::size_t i = 0; i < patch.blocks.size(); ++i)
            std::copy_n(patch.blocks[i].data(), 8, &device_[patch.addresses[i]]);
        if (patch.root != 0)
            device_[patch.root] = patch.root_word;
        const Words image = world_->image();
        for (const Word address : world_->written())
            if (!std::equal(&image[address], &image[address] + 8, &device_[address]))
                fail_("a patched memory has other blocks");
        live_[patch.root] = cells_;
        const std::shared_ptr<const View> view(new View(world_->view(patch.root)));
        readers_.emplace_back([this, view, cells = cells_] {
            if (cells_of(view->memory().memory()) != cells)
                wrong_ = true;
        });
        for (const LiveRoots::Root& root : world_->live_roots())
            if (root.address != patch.root && choose_(2) == 0) {
                world_->release(root.address);
                live_.erase(root.address);
            }
        if (readers_.size() > 4) {
            for (std::thread& reader : readers_)
                reader.join();
            readers_.clear();
            if (wrong_)
                fail_("a thread reads other voxels");
        }
        if (choose_(8) == 0)
            take_over(patch.root);
    }

    // Another world goes on with the memory as it is, and reads none of what is free.
    void take_over(std::size_t root) {
        Words words = device_;
        words[0] = words[root];
        world_ = std::make_unique<World>(Memory{words.data(), words.size(), depth_}, limits_, root);
        if (world_->live_roots().back().address != root || world_->image() != words)
            fail_("another world has other words");
        live_ = {{root, cells_}};
        begin_ = cells_;
        history_.clear();
    }

    Choose choose_;
    Fail fail_;
    unsigned depth_;
    std::int64_t side_;
    Cells cells_;
    std::unique_ptr<World> world_;
    Words device_;
    std::map<std::size_t, Cells> live_;
    std::vector<std::thread> readers_;
    std::atomic<bool> wrong_{false};
    bool refused_ = false, turned_ = false;
    std::uint32_t author_ = 0, stroke_ = 0;
    WorldLimits limits_;
    Cells begin_; // before the first edit of history_
    std::vector<Made> history_;
};

} // namespace editing
