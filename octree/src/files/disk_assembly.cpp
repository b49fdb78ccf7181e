#include "disk_assembly.h"

#include "join.h"

#include <cerrno>
#include <cstdio>

namespace voxrt::octree {
namespace {

/// Words on their way to a file.
class WordsFile {
public:
    explicit WordsFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
        if (file_ == nullptr)
            throw FileError(errno, path_);
        buffer_.reserve(kBuffer);
    }
    ~WordsFile() {
        if (file_ != nullptr)
            std::fclose(file_);
    }
    WordsFile(const WordsFile&) = delete;
    WordsFile& operator=(const WordsFile&) = delete;

    void add(Word word) {
        buffer_.push_back(word);
        if (buffer_.size() == kBuffer)
            flush();
    }

    void close() {
        flush();
        std::FILE* file = file_;
        file_ = nullptr;
        if (std::fclose(file) != 0)
            throw FileError(errno, path_);
    }

private:
    static constexpr std::size_t kBuffer = std::size_t{1} << 18;

    void flush() {
        if (std::fwrite(buffer_.data(), sizeof(Word), buffer_.size(), file_) != buffer_.size())
            throw FileError(errno, path_);
        buffer_.clear();
    }

    std::string path_;
    std::FILE* file_;
    std::vector<Word> buffer_;
};

} // namespace

void DiskAssembly::add(const Word* words, std::size_t size) {
    const Memory memory{words, size, depth_};
    JoiningPart<FilePool> part(pool_, memory);
    root_ = part.join(root_, memory.root(), depth_);
}

std::size_t DiskAssembly::write(const std::string& path) {
    pool_.close();
    constexpr Word unvisited = 0;
    std::vector<Word> address(pool_.size(), unvisited);
    std::vector<Word> order;
    order.reserve(pool_.size());
    WordsFile file(path);
    voxelize::WorkCounter& work = voxelize::WorkCounter::current();
    const auto add = [&](Word node) {
        if (!is_leaf(node)) {
            if (address[node] == unvisited) {
                address[node] = static_cast<Word>(block_address(order.size()));
                order.push_back(node);
            }
            node = address[node];
        }
        file.add(node);
    };
    add(root_);
    for (std::size_t next = 0; next < order.size(); ++next) {
        work.count_step();
        const Block children = pool_[order[next]];
        for (const Word child : children)
            add(child);
    }
    file.close();
    return memory_size(order.size());
}

} // namespace voxrt::octree
