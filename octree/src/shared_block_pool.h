// Blocks stored once, as in BlockPool, for threads that add blocks side by side.
//
// The table is cut by the hash into parts, each with a lock of its own. Blocks stand in runs; each thread fills a run
// of its own, so that what one thread made after another lies side by side. Numbers depend on how the threads took
// turns, the octree does not. A thread may tell early that it will ask for a block: its place in the table is then
// fetched from memory meanwhile.
//
// WebAssembly has no threads here, and takes no locks.
#pragma once

#include "block_hash.h"
#include "block_pool.h"

#include <atomic>
#include <memory>
#include <stdexcept>
#if !defined(__wasm__)
#include <thread>
#endif
#include <vector>

namespace voxrt::octree {

class SharedBlockPool {
public:
    /// What one thread adds blocks with.
    class Writer {
    public:
        explicit Writer(SharedBlockPool& pool) : pool_(pool) {}

        /// The hash of a block; fetches its place in the table, for an intern() soon.
        std::uint64_t prepare(const Block& children) const {
            const std::uint64_t hash = block_hash(children);
            pool_.part_of(hash).fetch(hash);
            return hash;
        }

        /// The node for eight children, as BlockPool::intern() gives it.
        Node intern(const Block& children) { return intern(children, block_hash(children)); }

        /// The same for a block whose hash is known.
        Node intern(const Block& children, std::uint64_t hash) {
            if (is_leaf(children[0]) && is_uniform(children))
                return children[0];
            Part& part = pool_.part_of(hash);
            const Lock lock(part.locked);
            const Word tag = tag_of(hash);
            std::size_t i = tag & part.mask();
            for (; part.slots[i].number != kFree; i = (i + 1) & part.mask())
                if (part.slots[i].tag == tag && is_same(pool_[part.slots[i].number], children))
                    return part.slots[i].number;
            if ((next_ & (kRun - 1)) == 0)
                next_ = pool_.new_run();
            const Node number = next_++;
            pool_.runs_[number / kRun].load(std::memory_order_relaxed)[number % kRun] = children;
            part.add(i, {tag, number});
            return number;
        }

    private:
        SharedBlockPool& pool_;
        Node next_ = 0; // a multiple of kRun where the run is full
    };

    SharedBlockPool() : parts_(kParts), runs_(std::make_unique<std::atomic<Block*>[]>(kRuns)) {}
    ~SharedBlockPool() {
        for (std::size_t run = 1; run < used_runs_; ++run)
            delete[] runs_[run].load(std::memory_order_relaxed);
    }
    SharedBlockPool(const SharedBlockPool&) = delete;
    SharedBlockPool& operator=(const SharedBlockPool&) = delete;

    const Block& operator[](Node number) const {
        return runs_[number / kRun].load(std::memory_order_relaxed)[number % kRun];
    }

    /// All numbers of blocks are lower. Not while a thread adds blocks.
    std::size_t size() const { return used_runs_ * kRun; }

private:
    struct Slot {
        Word tag;
        Node number;
    };
    static constexpr Node kFree = 0; // run 0 is none
    static constexpr std::size_t kRun = 2048;
    static constexpr std::size_t kMostThreads = 1024;
    static constexpr std::size_t kRuns = (std::size_t{1} << 28) / kRun + kMostThreads;
    static constexpr unsigned kPartBits = 6;
    static constexpr std::size_t kParts = std::size_t{1} << kPartBits;

    static bool is_uniform(const Block& children) {
        const std::uint64_t first = word_pair(children, 0);
        return ((first ^ word_pair(children, 1)) | (first ^ word_pair(children, 2)) | (first ^ word_pair(children, 3)) |
                (children[0] ^ children[1])) == 0;
    }

    static bool is_same(const Block& a, const Block& b) {
        return ((word_pair(a, 0) ^ word_pair(b, 0)) | (word_pair(a, 1) ^ word_pair(b, 1)) |
                (word_pair(a, 2) ^ word_pair(b, 2)) | (word_pair(a, 3) ^ word_pair(b, 3))) == 0;
    }

    static Word tag_of(std::uint64_t hash) { return static_cast<Word>(hash ^ hash >> 32); }

    // A part of the table: blocks whose hashes begin alike.
    struct alignas(64) Part {
        Part() : slots(64, Slot{0, kFree}), place(slots.data()), slots_less_one(slots.size() - 1) {}

        std::atomic<bool> locked{false};
        std::vector<Slot> slots;
        std::size_t count = 0;
        std::atomic<const Slot*> place; // for fetch(), which takes no lock
        std::atomic<std::size_t> slots_less_one;

        std::size_t mask() const { return slots_less_one.load(std::memory_order_relaxed); }

        void fetch(std::uint64_t hash) const {
#if defined(__GNUC__)
            __builtin_prefetch(place.load(std::memory_order_relaxed) + (tag_of(hash) & mask()));
#else
            static_cast<void>(hash);
#endif
        }

        void add(std::size_t i, Slot slot) {
            slots[i] = slot;
            if (4 * ++count > 3 * slots.size())
                grow();
        }

        void grow() {
            std::vector<Slot> old(2 * slots.size(), Slot{0, kFree});
            old.swap(slots);
            for (const Slot& slot : old) {
                if (slot.number == kFree)
                    continue;
                std::size_t i = slot.tag & (slots.size() - 1);
                while (slots[i].number != kFree)
                    i = (i + 1) & (slots.size() - 1);
                slots[i] = slot;
            }
            // A fetch between the two reads a place that is not there, which does no harm.
            place.store(slots.data(), std::memory_order_relaxed);
            slots_less_one.store(slots.size() - 1, std::memory_order_relaxed);
        }
    };

    class Lock {
    public:
#if defined(__wasm__)
        explicit Lock(std::atomic<bool>&) {}
#else
        explicit Lock(std::atomic<bool>& locked) : locked_(locked) {
            while (locked_.exchange(true, std::memory_order_acquire))
                std::this_thread::yield();
        }
        ~Lock() { locked_.store(false, std::memory_order_release); }
        Lock(const Lock&) = delete;
        Lock& operator=(const Lock&) = delete;

    private:
        std::atomic<bool>& locked_;
#endif
    };

    Part& part_of(std::uint64_t hash) { return parts_[hash >> (64 - kPartBits)]; }

    // The first number of a run that nobody has.
    Node new_run() {
        std::unique_ptr<Block[]> blocks(new Block[kRun]);
        const std::size_t run = used_runs_.fetch_add(1, std::memory_order_relaxed);
        if (run >= kRuns)
            throw_full();
        runs_[run].store(blocks.release(), std::memory_order_relaxed);
        return static_cast<Node>(run * kRun);
    }

    [[noreturn]] void throw_full() {
        used_runs_ = kRuns;
        throw std::length_error(
            "the octree has more than 2**28 - 1 blocks, which 31-bit addresses cannot reach; lower the depth");
    }

    std::vector<Part> parts_;
    std::unique_ptr<std::atomic<Block*>[]> runs_;
    std::atomic<std::size_t> used_runs_{1};
};

} // namespace voxrt::octree
