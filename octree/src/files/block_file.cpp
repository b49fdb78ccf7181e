#include "block_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

namespace voxrt::octree {
namespace {

int open_unnamed(const std::string& folder) {
    std::string path = folder + "/.blocks.XXXXXX";
    const int descriptor = ::mkstemp(path.data());
    if (descriptor < 0)
        throw FileError(errno, folder);
    ::unlink(path.c_str());
    ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    return descriptor;
}

} // namespace

BlockFile::BlockFile(const std::string& folder, std::size_t cache_bytes)
    : folder_(folder), descriptor_(open_unnamed(folder)),
      places_(std::max<std::size_t>(cache_bytes / sizeof(Page), 64)),
      cache_(std::make_unique_for_overwrite<Page[]>(places_)), cached_(places_, kNoPage) {}

BlockFile::~BlockFile() { ::close(descriptor_); }

void BlockFile::append(const Block& block) {
    (*last_)[size_ % kPageBlocks] = block;
    if (++size_ % kPageBlocks != 0)
        return;
    const std::size_t number = size_ / kPageBlocks - 1, place = number % places_;
    transfer(true, *last_, number);
    cache_[place] = *last_;
    cached_[place] = number;
}

const Block& BlockFile::operator[](std::size_t block) {
    const std::size_t number = block / kPageBlocks, place = number % places_;
    if (number == size_ / kPageBlocks)
        return (*last_)[block % kPageBlocks];
    if (cached_[place] != number) {
        cached_[place] = kNoPage;
        transfer(false, cache_[place], number);
        cached_[place] = number;
    }
    return cache_[place][block % kPageBlocks];
}

void BlockFile::transfer(bool write, Page& page, std::size_t number) const {
    auto* bytes = reinterpret_cast<std::byte*>(&page);
    auto at = static_cast<off_t>(number * sizeof(Page));
    for (std::size_t left = sizeof(Page); left > 0;) {
        const ssize_t done = write ? ::pwrite(descriptor_, bytes, left, at) : ::pread(descriptor_, bytes, left, at);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            throw FileError(done < 0 ? errno : EIO, folder_);
        bytes += done;
        at += done;
        left -= static_cast<std::size_t>(done);
    }
}

} // namespace voxrt::octree
