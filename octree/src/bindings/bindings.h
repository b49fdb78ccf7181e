// What the bindings of the octree have in common: arrays that they take, and what they return.
#pragma once

#include "../words/memory.h"

#include <voxrt/voxelize/bindings/python.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace voxrt::octree {

template <typename T>
using Vector = nanobind::ndarray<const T, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
template <typename T, int Columns>
using Rows = nanobind::ndarray<const T, nanobind::shape<-1, Columns>, nanobind::c_contig, nanobind::device::cpu>;

// A read-only array.
inline nanobind::object words_to_numpy(Words&& words) {
    words.shrink_to_fit();
    const std::size_t size = words.size();
    return python::to_read_only_numpy(std::move(words), {size});
}

// Calls `work` without the GIL; Ctrl-C ends it.
template <class Work> auto run(Work work) {
    const python::LongCall call;
    return work();
}

inline void require(bool condition, const char* message) {
    if (!condition)
        throw std::invalid_argument(message);
}

inline void require_depth(unsigned depth) { require(depth >= 1 && depth <= kMaxDepth, "depth must be 1 ... 16"); }

inline Memory memory_of(const Vector<Word>& words, unsigned depth) {
    require_depth(depth);
    return {words.data(), words.shape(0), depth};
}

/// Calls `work` with a memory, or with two of one depth, as run() does.
template <class Work> auto run_on(const Vector<Word>& words, unsigned depth, Work work) {
    const Memory memory = memory_of(words, depth);
    return run([&] { return work(memory); });
}
template <class Work> auto run_on(const Vector<Word>& first, const Vector<Word>& second, unsigned depth, Work work) {
    const Memory a = memory_of(first, depth), b = memory_of(second, depth);
    return run([&] { return work(a, b); });
}

/// Binds what is made of a memory: sharing, graphs, budgets, surfaces, hidden voxels, means.
void bind_derived(nanobind::module_& m);

/// Binds the text of .mem files and what joins octrees, in memory and on disk.
void bind_files(nanobind::module_& m);

/// Binds the octree that is edited.
void bind_world(nanobind::module_& m);

} // namespace voxrt::octree
