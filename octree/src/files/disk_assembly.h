// Assembly (assembly.h) for octrees that do not fit the memory: blocks are in a file, and so is the result.
//
//     DiskAssembly whole(16, "out/yard.tiles", std::size_t{1} << 30);
//     for (const Words& part : parts)
//         whole.add(part.data(), part.size());
//     whole.write("out/yard.tiles/words"); // the bytes of Assembly::words(), as they stand in memory
//
// Memory: 12 bytes per block, the cache, and 4 bytes per block of the part that is added; 8 bytes per block, and the
// cache, while the words are written.
#pragma once

#include "file_pool.h"

namespace voxrt::octree {

class DiskAssembly {
public:
    /// An empty world of `depth` levels, 1 … kMaxDepth. `folder` gets the blocks, in a file without a name.
    /// `cache_bytes`: memory for blocks that are in use. Throws FileError, as all functions here.
    DiskAssembly(unsigned depth, const std::string& folder, std::size_t cache_bytes)
        : pool_(folder, cache_bytes), depth_(depth) {}

    /// As Assembly::add().
    void add(const Word* words, std::size_t size);

    /// Writes the words of the world, breadth-first, to a file; returns their number. Nothing can be added afterwards.
    std::size_t write(const std::string& path);

private:
    FilePool pool_;
    unsigned depth_;
    Word root_ = kEmpty;
};

} // namespace voxrt::octree
