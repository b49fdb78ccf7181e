#include "coarsen.h"

#include "../pool/breadth_first.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>
#include <unordered_map>

namespace voxrt::octree {
namespace {

// Solid voxels by material, ascending by id.
using Census = std::vector<std::pair<std::uint8_t, std::uint64_t>>;

class Coarsening {
public:
    Coarsening(const Memory& memory, unsigned finest, BlockPool& pool)
        : memory_(memory), finest_(finest), pool_(pool) {}

    Node node(Word word, unsigned level) {
        if (is_leaf(word))
            return word;
        const std::uint64_t key = std::uint64_t{word} << 8 | level;
        if (const auto entry = nodes_.find(key); entry != nodes_.end())
            return entry->second;
        work_.count_step();
        Node result;
        if (level <= finest_) {
            result = majority(census(word, level));
        } else {
            Block children;
            for (unsigned octant = 0; octant < 8; ++octant)
                children[octant] = node(memory_.child(word, octant, level), level - 1);
            result = pool_.intern(children);
        }
        nodes_.emplace(key, result);
        return result;
    }

private:
    static Node majority(const Census& census) {
        const auto most = std::max_element(census.begin(), census.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        return most == census.end() ? kEmpty : leaf(most->first);
    }

    const Census& census(Word block, unsigned level) {
        const std::uint64_t key = std::uint64_t{block} << 8 | level;
        if (const auto entry = censuses_.find(key); entry != censuses_.end())
            return entry->second;
        std::array<std::uint64_t, 256> counts{};
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word child = memory_.child(block, octant, level);
            if (is_leaf(child))
                counts[material(child)] += voxels_at(level - 1);
            else
                for (const auto& [id, voxels] : census(child, level - 1))
                    counts[id] += voxels;
        }
        Census found;
        for (unsigned id = 1; id < 256; ++id)
            if (counts[id] != 0)
                found.emplace_back(static_cast<std::uint8_t>(id), counts[id]);
        return censuses_.emplace(key, std::move(found)).first->second;
    }

    Memory memory_;
    unsigned finest_;
    BlockPool& pool_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::unordered_map<std::uint64_t, Census> censuses_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

Node coarsen(const Memory& memory, unsigned level, BlockPool& pool) {
    return Coarsening(memory, level, pool).node(memory.root(), memory.depth);
}

Words coarsened(const Memory& memory, unsigned level) {
    BlockPool pool;
    return breadth_first_words(pool, coarsen(memory, level, pool));
}

} // namespace voxrt::octree
