// Edits a World without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random edits of every small depth are held against an array of the voxels, with a memory that gets the patches and
// with threads that read live roots meanwhile. Prints a line and exits with 1 where something is wrong.
#include <voxrt/octree/build/dense.h>
#include <voxrt/octree/edit/world.h>
#include <voxrt/octree/query/query.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <thread>

using namespace voxrt::octree;

namespace {

using Random = std::mt19937_64;
using Cells = std::vector<std::uint8_t>; // z fastest, then y, then x

bool good = true;

void expect(bool condition, const char* what, unsigned depth) {
    if (!condition)
        std::printf("depth %u: %s\n", depth, what);
    good = good && condition;
}

Cells cells_of(const Memory& memory) {
    const std::int64_t side = std::int64_t{1} << memory.depth;
    Cells cells(static_cast<std::size_t>(side * side * side));
    fill_region(memory, {{0, 0, 0}, {side, side, side}}, cells.data());
    return cells;
}

Words words_of(const Cells& cells, unsigned depth) {
    const std::size_t side = std::size_t{1} << depth;
    return build_dense(cells.data(), side, side, side, depth);
}

std::unique_ptr<World> world_of(const Cells& cells, unsigned depth, const WorldLimits& limits) {
    const Words words = words_of(cells, depth);
    return std::make_unique<World>(Memory{words.data(), words.size(), depth}, limits);
}

class Editing {
public:
    Editing(Random& random, unsigned depth, const WorldLimits& limits)
        : random_(random), depth_(depth), side_(std::int64_t{1} << depth),
          cells_(static_cast<std::size_t>(side_ * side_ * side_)), world_(world_of(cells_, depth, limits)),
          device_(world_->image()) {
        live_[0] = cells_;
    }

    void step() {
        switch (random_() % 8) {
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
            if (world_->undo())
                cells_ = cells_of(world_->memory().memory());
            break;
        case 6:
            if (world_->redo())
                cells_ = cells_of(world_->memory().memory());
            break;
        default:
            commit();
        }
        world_->check();
        expect(world_->words() == words_of(cells_, depth_), "the words are not those of a build", depth_);
    }

    void finish() {
        for (std::thread& reader : readers_)
            reader.join();
        for (const auto& [root, cells] : live_)
            expect(cells_of({device_.data(), device_.size(), depth_, device_[root]}) == cells,
                   "a patched memory has other voxels", depth_);
    }

private:
    std::int64_t any(std::int64_t low, std::int64_t high) {
        return low + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(high - low));
    }
    std::uint8_t& cell(std::int64_t x, std::int64_t y, std::int64_t z) {
        return cells_[static_cast<std::size_t>((x * side_ + y) * side_ + z)];
    }

    void set() {
        std::vector<std::int64_t> points;
        Cells materials;
        Cells edited = cells_;
        for (std::uint64_t count = 1 + random_() % 6; count > 0; --count) {
            for (int axis = 0; axis < 3; ++axis)
                points.push_back(any(0, side_));
            materials.push_back(static_cast<std::uint8_t>(random_() % 3));
            const std::int64_t* point = points.data() + points.size() - 3;
            edited[static_cast<std::size_t>((point[0] * side_ + point[1]) * side_ + point[2])] = materials.back();
        }
        if (world_->set(points.data(), materials.data(), materials.size()))
            cells_ = edited;
    }

    void shape(bool solid_only) {
        const auto material = static_cast<std::uint8_t>(solid_only ? 1 + random_() % 3 : random_() % 3);
        const auto place = [&] { return Place{any(-9, 16 * side_), any(-9, 16 * side_), any(-9, 16 * side_)}; };
        Shape shape = Box{{any(-2, side_), any(-2, side_), any(-2, side_)}, {any(0, side_ + 2), side_, side_}};
        if (random_() % 3 == 0)
            shape = Ball{place(), any(0, 8 * side_)};
        else if (random_() % 2 == 0)
            shape = Capsule{place(), place(), any(0, 4 * side_)};
        if (!(solid_only ? world_->paint(shape, material) : world_->fill(shape, material)))
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
        const World::Copied copied = world_->copy({low, {low[0] + size[0], low[1] + size[1], low[2] + size[2]}});
        std::array<std::uint8_t, 256> materials;
        for (unsigned id = 0; id < 256; ++id)
            materials[id] = static_cast<std::uint8_t>(id == 2 ? 3 : id);
        const auto quarters = static_cast<unsigned>(random_() % 4);
        if (!world_->paste({copied.words.data(), copied.words.size(), copied.depth}, size, at, quarters, materials))
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
        const std::optional<Patch> patch = world_->commit();
        if (!patch)
            return;
        device_.resize(std::max(device_.size(), world_->image().size()), kEmpty);
        for (std::size_t i = 0; i < patch->blocks.size(); ++i)
            std::copy_n(patch->blocks[i].data(), 8, &device_[patch->addresses[i]]);
        if (patch->root != 0)
            device_[patch->root] = patch->root_word;
        live_[patch->root] = cells_;
        const std::shared_ptr<const View> view(new View(world_->view(patch->root)));
        readers_.emplace_back([this, view, cells = cells_] {
            if (cells_of(view->memory().memory()) != cells)
                wrong_ = true;
        });
        for (const LiveRoots::Root& root : world_->live_roots())
            if (root.address != patch->root && random_() % 2 == 0) {
                world_->release(root.address);
                live_.erase(root.address);
            }
        if (readers_.size() > 4) {
            for (std::thread& reader : readers_)
                reader.join();
            readers_.clear();
            expect(!wrong_, "a thread reads other voxels", depth_);
        }
    }

    Random& random_;
    unsigned depth_;
    std::int64_t side_;
    Cells cells_;
    std::unique_ptr<World> world_;
    Words device_;
    std::map<std::size_t, Cells> live_;
    std::vector<std::thread> readers_;
    std::atomic<bool> wrong_{false};
};

} // namespace

int main() {
    Random random(1);
    for (unsigned depth = 1; depth <= 4; ++depth)
        for (const std::size_t blocks : {std::size_t{60}, kBlockLimit}) {
            Editing editing(random, depth, {memory_size(blocks), 9});
            for (int step = 0; step < 400; ++step)
                editing.step();
            editing.finish();
        }
    return good ? 0 : 1;
}
