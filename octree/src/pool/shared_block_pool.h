// Blocks stored once, as in BlockPool, for threads that add blocks side by side. No thread waits for another.
//
// A slot of a table is one number of 64 bits, the tag and the number of a block. It is written once. A block stands in
// the first free of the kWindow slots that begin at its place. Where none is free, it stands in the next table, which
// has twice as many; so no table is ever copied. Of two threads that add the same block, both look at the same slots in
// the same order: the second finds what the first wrote.
//
// Blocks stand in runs; each thread fills a run of its own, so that what one thread made after another lies side by
// side. Numbers depend on how the threads took turns, the octree does not. A thread may tell early that it will ask for
// a block: its place in the table is then fetched from memory meanwhile.
#pragma once

#include "block_hash.h"
#include "block_pool.h"

#include <voxrt/voxelize/work/large_vector.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>

namespace voxrt::octree {

class SharedBlockPool {
    struct Table;

public:
    /// What one thread adds blocks with.
    class Writer {
    public:
        explicit Writer(SharedBlockPool& pool) : pool_(pool) {}

        /// The hash of a block; fetches its place in the table, for an intern() soon.
        std::uint64_t prepare(const Block& children) const {
            const std::uint64_t hash = block_hash(children);
#if defined(__GNUC__)
            __builtin_prefetch(pool_.first_.place(hash));
#endif
            return hash;
        }

        /// The node for eight children, as BlockPool::intern() gives it.
        Node intern(const Block& children) { return intern(children, block_hash(children)); }

        /// The same for a block whose hash is known.
        Node intern(const Block& children, std::uint64_t hash) {
            if (is_leaf(children[0]) && is_uniform(children))
                return children[0];
            const std::uint64_t tag = hash << 32;
            for (Table* table = &pool_.first_;; table = &table->next_table()) {
                Slot* slot = table->place(hash);
                for (const Slot* end = slot + kWindow; slot != end; ++slot) {
                    std::uint64_t found = slot->load(std::memory_order_acquire);
                    if (found == kFree) {
                        write(children);
                        if (slot->compare_exchange_strong(found, tag | next_, std::memory_order_acq_rel,
                                                          std::memory_order_acquire))
                            return next_++;
                    }
                    const Node number = static_cast<Node>(found);
                    if ((found ^ number) == tag && is_same(pool_[number], children))
                        return number;
                }
            }
        }

    private:
        // Writes a block at the next number, which it keeps only if a slot gets it.
        void write(const Block& children) {
            if (next_ == end_) {
                next_ = pool_.new_run();
                end_ = next_ + kRun;
            }
            pool_.runs_[next_ / kRun].load(std::memory_order_relaxed)[next_ % kRun] = children;
        }

        SharedBlockPool& pool_;
        Node next_ = 0;
        Node end_ = 0; // of the run
    };

    /// `expected_blocks`, a guess, sizes the first table.
    explicit SharedBlockPool(std::size_t expected_blocks)
        : first_(std::bit_ceil(std::max(expected_blocks, kFewestSlots))),
          runs_(std::make_unique<std::atomic<Block*>[]>(kRuns)) {}
    ~SharedBlockPool() {
        for (std::size_t run = 1; run < std::min<std::size_t>(used_runs_, kRuns); ++run)
            if (Block* blocks = runs_[run].load(std::memory_order_relaxed))
                RunAllocator().deallocate(blocks, kRun);
    }
    SharedBlockPool(const SharedBlockPool&) = delete;
    SharedBlockPool& operator=(const SharedBlockPool&) = delete;

    const Block& operator[](Node number) const {
        return runs_[number / kRun].load(std::memory_order_acquire)[number % kRun];
    }

    /// All numbers of blocks are lower. Not while a thread adds blocks.
    std::size_t size() const { return used_runs_ * kRun; }

private:
    using Slot = std::atomic<std::uint64_t>;
    using RunAllocator = voxelize::LargeVector<Block>::allocator_type;
    static constexpr std::uint64_t kFree = 0; // run 0 is none
    static constexpr std::size_t kWindow = 32;
    static constexpr std::size_t kFewestSlots = 1024;
    static constexpr std::size_t kRun = std::size_t{1} << 16; // 2 MB
    static constexpr std::size_t kMostThreads = 1024;
    static constexpr std::size_t kRuns = (std::size_t{1} << 28) / kRun + kMostThreads;

    struct Table {
        explicit Table(std::size_t size) : slots(size + kWindow), shift(64 - std::bit_width(size - 1)) {}
        ~Table() { delete next.load(std::memory_order_relaxed); }

        // The first of `kWindow` slots. The upper bits of the hash choose it, the lower bits are the tag.
        Slot* place(std::uint64_t hash) { return slots.data() + (hash >> shift); }

        Table& next_table() {
            Table* found = next.load(std::memory_order_acquire);
            if (found == nullptr) {
                auto made = std::make_unique<Table>(2 * (slots.size() - kWindow));
                if (next.compare_exchange_strong(found, made.get(), std::memory_order_acq_rel))
                    found = made.release();
            }
            return *found;
        }

        voxelize::LargeVector<Slot> slots;
        int shift;
        std::atomic<Table*> next{nullptr};
    };

    // The first number of a run that nobody has.
    Node new_run() {
        const std::size_t run = used_runs_.fetch_add(1, std::memory_order_relaxed);
        if (run >= kRuns) {
            used_runs_ = kRuns;
            throw_too_many_blocks();
        }
        runs_[run].store(RunAllocator().allocate(kRun), std::memory_order_release);
        return static_cast<Node>(run * kRun);
    }

    Table first_;
    std::unique_ptr<std::atomic<Block*>[]> runs_;
    std::atomic<std::size_t> used_runs_{1};
};

} // namespace voxrt::octree
