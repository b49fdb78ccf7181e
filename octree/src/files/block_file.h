// Blocks in a file that only grows, read through a cache of pages.
//
// For octrees that do not fit the memory. A page is 128 blocks. A page that is full is written at once; the cache maps
// each page to one place, so that a file that fits it is read from memory alone.
#pragma once

#include "../words/words.h"

#include <cstddef>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace voxrt::octree {

/// A file cannot be made, read or written; code() says why.
struct FileError : std::system_error {
    FileError(int error, std::string path)
        : std::system_error(error, std::generic_category(), path), path(std::move(path)) {}
    std::string path;
};

class BlockFile {
public:
    /// Makes a file in `folder` that has no name, so that it goes with the process. `cache_bytes`: what the cache may
    /// take. Throws FileError.
    BlockFile(const std::string& folder, std::size_t cache_bytes);
    ~BlockFile();
    BlockFile(const BlockFile&) = delete;
    BlockFile& operator=(const BlockFile&) = delete;

    std::size_t size() const { return size_; }

    /// Adds a block with the number size(). Throws FileError, as on a full disk.
    void append(const Block& block);

    /// The block of a number below size(). The reference is valid until the next call.
    const Block& operator[](std::size_t number);

private:
    static constexpr std::size_t kPageBlocks = 128;
    static constexpr std::size_t kNoPage = ~std::size_t{0};
    using Page = std::array<Block, kPageBlocks>;

    void transfer(bool write, Page& page, std::size_t number) const;

    std::string folder_;
    int descriptor_;
    std::size_t size_ = 0;
    std::unique_ptr<Page> last_ = std::make_unique<Page>(); // the page that is not full yet
    std::size_t places_;
    std::unique_ptr<Page[]> cache_;
    std::vector<std::size_t> cached_; // by place: the number of its page
};

} // namespace voxrt::octree
