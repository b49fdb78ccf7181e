#include "assembly.h"

#include "../pool/breadth_first.h"
#include "join.h"

namespace voxrt::octree {

void Assembly::add(const Word* words, std::size_t size) {
    const Memory memory{words, size, depth_};
    JoiningPart<BlockPool> part(pool_, memory);
    root_ = part.join(root_, memory.root(), depth_);
}

Words Assembly::words() const { return breadth_first_words(pool_, root_); }

} // namespace voxrt::octree
