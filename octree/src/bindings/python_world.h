// A World for Python, whose threads take turns.
#pragma once

#include "../edit/world.h"

#include <voxrt/voxelize/work/mutex.h>

namespace voxrt::octree {

class PythonWorld {
public:
    PythonWorld(const Memory& memory, const WorldLimits& limits, std::optional<std::size_t> place)
        : world_(memory, limits, place) {}

    /// Calls `work` with the world. The caller has released the GIL.
    template <typename Work> auto with(Work work) {
        const voxelize::Lock lock(turn_);
        return work(world_);
    }

    /// World::view() and World::release(), which need no turn.
    View view(std::size_t root) const { return world_.view(root); }
    void release(std::size_t root) { world_.release(root); }

private:
    World world_;
    voxelize::Mutex turn_;
};

} // namespace voxrt::octree
