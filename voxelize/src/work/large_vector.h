// Vectors for arrays of megabytes: their elements have no initial value, and their memory is in large pages.
//
// Threads that write an array of small pages for the first time wait for the system at each page. Large pages are 512
// times fewer.
//
// WebAssembly has neither threads nor such pages here: its vectors are ordinary ones.
#pragma once

#include <cstddef>
#if !defined(__wasm__)
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#endif
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace voxrt::voxelize {

#if defined(__wasm__)

template <typename T> using LargeVector = std::vector<T>;

#else

/// An allocator whose arrays of 2 MB and more begin at a multiple of 2 MB and ask for large pages, where the system has
/// them. Elements that are made without a value have none.
template <typename T> struct LargePageAllocator {
    using value_type = T;

    LargePageAllocator() = default;
    template <typename U> LargePageAllocator(const LargePageAllocator<U>&) {}

    T* allocate(std::size_t count) {
        if (count > std::numeric_limits<std::size_t>::max() / sizeof(T))
            throw std::bad_array_new_length();
        const std::size_t bytes = count * sizeof(T);
        if (bytes < kPage)
            return static_cast<T*>(::operator new(bytes));
        void* memory = ::operator new(bytes, std::align_val_t{kPage});
#if defined(__linux__)
        madvise(memory, bytes, MADV_HUGEPAGE); // a refusal changes nothing but the time
#endif
        return static_cast<T*>(memory);
    }

    void deallocate(T* memory, std::size_t count) {
        if (count * sizeof(T) < kPage)
            ::operator delete(memory);
        else
            ::operator delete(memory, std::align_val_t{kPage});
    }

    template <typename U> void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>) {
        ::new (static_cast<void*>(place)) U;
    }
    template <typename U, typename... Arguments> void construct(U* place, Arguments&&... arguments) {
        std::construct_at(place, std::forward<Arguments>(arguments)...);
    }

    friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) { return true; }

private:
    static constexpr std::size_t kPage = std::size_t{1} << 21;
};

/// A vector of them. resize() gives new elements no value: write them before they are read.
template <typename T> using LargeVector = std::vector<T, LargePageAllocator<T>>;

#endif

} // namespace voxrt::voxelize
