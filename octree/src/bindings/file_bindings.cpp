#include "../files/assembly.h"
#include "../files/disk_assembly.h"
#include "../files/mem_text.h"
#include "bindings.h"

#include <cerrno>
#include <string>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

using python::to_numpy;

nb::bytes bind_mem_text(const Vector<Word>& words, int threads) {
    const std::size_t count = words.shape(0);
    PyObject* text = PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(kMemLine * count));
    if (text == nullptr)
        throw nb::python_error();
    const nb::bytes result = nb::steal<nb::bytes>(text);
    run([&] { write_mem_text(words.data(), count, PyBytes_AS_STRING(text), threads); });
    return result;
}

std::uint32_t bind_mem_text_crc32(const Vector<Word>& words, std::uint32_t before, int threads) {
    return run([&] { return mem_text_crc32(words.data(), words.shape(0), before, threads); });
}

// None where the text is not that of mem_text().
nb::object bind_read_mem_text(const nb::bytes& text) {
    if (text.size() % kMemLine != 0)
        return nb::none();
    Words words(text.size() / kMemLine);
    if (!run([&] { return read_mem_text(text.c_str(), words.size(), words.data(), 0); }))
        return nb::none();
    const std::size_t count = words.size();
    return to_numpy(std::move(words), {count});
}

template <class Any> void bind_add(Any& assembly, const Vector<Word>& words) {
    run([&] { assembly.add(words.data(), words.shape(0)); });
}

nb::object bind_assembly_words(const Assembly& assembly) {
    return words_to_numpy(run([&] { return assembly.words(); }));
}

// Paths are bytes: a file's name need not be text.
std::string path_of(const nb::bytes& path) { return {path.c_str(), path.size()}; }

std::size_t bind_disk_assembly_write(DiskAssembly& assembly, const nb::bytes& path) {
    const std::string target = path_of(path);
    return run([&] { return assembly.write(target); });
}

} // namespace

void bind_files(nb::module_& m) {
    m.def("mem_text", &bind_mem_text, "words"_a.noconvert(), "threads"_a = 0);
    m.def("mem_text_crc32", &bind_mem_text_crc32, "words"_a.noconvert(), "before"_a = 0, "threads"_a = 0);
    m.def("read_mem_text", &bind_read_mem_text, "text"_a);
    nb::class_<Assembly>(m, "Assembly")
        .def(nb::new_([](unsigned depth, std::size_t expected_blocks) {
                 require_depth(depth);
                 return new Assembly(depth, expected_blocks);
             }),
             "depth"_a, "expected_blocks"_a)
        .def("add", &bind_add<Assembly>, "words"_a.noconvert())
        .def("words", &bind_assembly_words);
    nb::register_exception_translator([](const std::exception_ptr& failure, void*) {
        try {
            std::rethrow_exception(failure);
        } catch (const FileError& error) {
            errno = error.code().value();
            PyErr_SetFromErrnoWithFilename(PyExc_OSError, error.path.c_str());
        }
    });
    nb::class_<DiskAssembly>(m, "DiskAssembly")
        .def(nb::new_([](unsigned depth, const nb::bytes& folder, std::size_t cache_bytes) {
                 require_depth(depth);
                 return new DiskAssembly(depth, path_of(folder), cache_bytes);
             }),
             "depth"_a, "folder"_a, "cache_bytes"_a)
        .def("add", &bind_add<DiskAssembly>, "words"_a.noconvert())
        .def("write", &bind_disk_assembly_write, "path"_a);
}

} // namespace voxrt::octree
