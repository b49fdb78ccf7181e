// What the extension modules share: arrays handed to NumPy, named tuples as results, calls that Ctrl-C can end.
#pragma once

#include "../work/interrupt.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace voxrt::python {

namespace nb = nanobind;

/// A NumPy array of `shape` that owns `data`.
template <typename T> nb::object to_numpy(std::unique_ptr<T[]> data, std::initializer_list<std::size_t> shape) {
    T* raw = data.get();
    nb::capsule owner(raw, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    data.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(raw, shape, owner));
}

/// The same for a vector, without a copy. `Element`: T, or const T for a read-only array.
template <typename Element, typename T, typename Allocator>
nb::object array_of(std::vector<T, Allocator>&& values, std::initializer_list<std::size_t> shape) {
    using Array = std::vector<T, Allocator>;
    auto owned = std::make_unique<Array>(std::move(values));
    Element* raw = reinterpret_cast<Element*>(owned->data());
    nb::capsule owner(owned.get(), [](void* p) noexcept { delete static_cast<Array*>(p); });
    owned.release();
    return nb::cast(nb::ndarray<nb::numpy, Element>(raw, shape, owner));
}
template <typename T, typename Allocator>
nb::object to_numpy(std::vector<T, Allocator>&& values, std::initializer_list<std::size_t> shape) {
    return array_of<T>(std::move(values), shape);
}
template <typename T, typename Allocator>
nb::object to_read_only_numpy(std::vector<T, Allocator>&& values, std::initializer_list<std::size_t> shape) {
    return array_of<const T>(std::move(values), shape);
}

/// The same for rows of N elements.
template <typename T, std::size_t N, typename Allocator>
nb::object rows_to_numpy(std::vector<std::array<T, N>, Allocator>&& rows) {
    const std::size_t count = rows.size();
    return array_of<T>(std::move(rows), {count, N});
}

/// A named tuple type of a module: what its functions return. Kept in a static variable, which lives as long as Python.
class NamedTuple {
public:
    NamedTuple() = default;

    /// Makes collections.namedtuple(name, fields) and sets it as an attribute of the module.
    NamedTuple(nb::module_& module, const char* name, std::initializer_list<const char*> fields, const char* doc) {
        nb::list names;
        for (const char* field : fields)
            names.append(field);
        nb::object type = nb::module_::import_("collections")
                              .attr("namedtuple")(name, names, nb::arg("module") = module.attr("__name__"));
        type.attr("__doc__") = doc;
        module.attr(name) = type;
        type_ = type.release();
    }

    /// A value, its fields in order.
    template <class... Values> nb::object operator()(Values&&... values) const {
        return type_(std::forward<Values>(values)...);
    }

private:
    nb::handle type_;
};

/// The names of instruction sets (instruction_sets.h).
template <class Engine> nb::tuple instruction_sets(const std::vector<Engine>& engines) {
    nb::list names;
    for (const Engine& engine : engines)
        names.append(engine.instructions);
    return nb::tuple(names);
}

/// Releases the GIL and lets Ctrl-C end the work, for its lifetime: the interrupt check raises what the signal handlers
/// of Python raise.
class LongCall {
public:
    LongCall() = default;

private:
    nb::gil_scoped_release release_;
    voxelize::InterruptScope scope_{[] {
        nb::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0)
            throw nb::python_error();
    }};
};

} // namespace voxrt::python
