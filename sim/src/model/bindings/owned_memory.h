// Octree memories for Python, whose words are copied.
#pragma once

#include <voxrt/octree/words/verify.h>
#include <voxrt/voxelize/bindings/python.h>

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

namespace voxrt::sim {

using Words = nanobind::ndarray<const uint32_t, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;

// Copied words. A page of zeros is left as the system gives it: the empty part of a device's memory costs nothing.
class CopiedWords {
public:
    explicit CopiedWords(const Words& words)
        : size_(words.shape(0)), data_(static_cast<uint32_t*>(std::calloc(std::max<size_t>(size_, 1), 4)), &std::free) {
        if (!data_)
            throw std::bad_alloc();
        static constexpr uint32_t zeros[kPage] = {};
        for (size_t start = 0; start < size_; start += kPage) {
            const size_t bytes = 4 * std::min(kPage, size_ - start);
            if (std::memcmp(words.data() + start, zeros, bytes) != 0)
                std::memcpy(data_.get() + start, words.data() + start, bytes);
        }
    }

    const uint32_t* data() const { return data_.get(); }
    size_t size() const { return size_; }

private:
    static constexpr size_t kPage = 1024; // words

    size_t size_;
    std::unique_ptr<uint32_t, decltype(&std::free)> data_;
};

// A memory with words of its own, so that nobody changes them after they are verified. Memories of other roots share
// them.
class OwnedMemory {
public:
    OwnedMemory(const Words& words, int depth, std::size_t root)
        : words_(std::make_shared<const CopiedWords>(words)), verified_(verify(*words_, depth, root)) {}
    OwnedMemory(const OwnedMemory& other, int depth, std::size_t root)
        : words_(other.words_), verified_(verify(*words_, depth, root)) {}
    OwnedMemory(const OwnedMemory&) = delete;
    OwnedMemory& operator=(const OwnedMemory&) = delete;

    const octree::VerifiedMemory& verified() const { return verified_; }

private:
    static octree::VerifiedMemory verify(const CopiedWords& words, int depth, std::size_t root) {
        if (root >= words.size() && words.size() != 0)
            throw std::invalid_argument("there is no word " + std::to_string(root) + " in a memory of " +
                                        std::to_string(words.size()));
        const python::LongCall call;
        const std::uint64_t word = root == 0 ? octree::kWord0 : words.data()[root];
        return octree::VerifiedMemory({words.data(), words.size(), depth < 0 ? 0 : static_cast<unsigned>(depth), word});
    }

    std::shared_ptr<const CopiedWords> words_;
    octree::VerifiedMemory verified_;
};

} // namespace voxrt::sim
