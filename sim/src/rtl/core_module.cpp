// The whole core, voxrt_core, for Python, with a board's surroundings. Every argument is checked here.
//
//   CORES: list[str]          names of the configurations that were built so
//   Core(config)              one instance, out of reset; one call at a time (RuntimeError). Its clock ticks in these
//                             calls alone
//     .memory_words           how many words its octree memory holds
//     .cached                 whether that is an external memory, behind caches
//     .read(address)          a register, by AXI4-Lite; byte address, a multiple of 4 below 2048
//     .write(address, value)  the same
//     .read_memory(address, count)
//                             uint32 (count,): words from word `address` on, by the memory port, one a clock; not of
//                             a cached core
//     .write_memory(address, words)
//                             the same
//     .map_external(address, words)
//                             of a cached core: its external memory has these words, uint32 (N,), from byte `address`
//                             on, a multiple of 4, and answers DECERR elsewhere. They are not copied: what is written
//                             to the array later is read by the core
//     .expect(width, height, *, stall_seed=0)
//                             take the video stream until a frame is complete. Without this the stream waits. With a
//                             seed, the consumer stalls in a pattern that depends on it
//     .run(clocks)            tick, at most so often, until the frame is complete: whether it is. Releases the GIL;
//                             Ctrl-C ends it
//     .frame()                uint8 (H, W, 3): the complete frame, each pixel's bytes as the stream has them: green,
//                             blue, red. RuntimeError: not complete, or the stream had wrong tuser, tlast or tkeep
//
// ValueError: a name, address or size out of range. RuntimeError: the core refuses a register or does not answer.
#include "core_module.h"

#include "core.h"
#include "one_call.h"

#include <voxrt/voxelize/bindings/python.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::rtl {

#define VOXRT_CORE(name) std::unique_ptr<Core> make_core_##name();
#include "cores.inc"
#undef VOXRT_CORE

namespace {

struct CoreConfiguration {
    const char* name;
    std::unique_ptr<Core> (*make)();
};

// A build of chosen configurations has none.
const std::vector<CoreConfiguration> cores = {
#define VOXRT_CORE(name) {#name, make_core_##name},
#include "cores.inc"
#undef VOXRT_CORE
};

constexpr long register_bytes = 2048;

using Words = nb::ndarray<const uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

class CheckedCore {
public:
    explicit CheckedCore(const std::string& name) {
        for (const CoreConfiguration& configuration : cores)
            if (name == configuration.name)
                core_ = configuration.make();
        if (!core_)
            throw std::invalid_argument("no core " + name + ": see CORES");
    }

    std::size_t memory_words() const { return core_->limits().memory_words(); }

    bool cached() const { return core_->limits().form == MemoryForm::cached; }

    uint32_t read(long address) {
        check_register(address);
        OneCall call(busy_);
        return core_->read(static_cast<uint32_t>(address));
    }

    void write(long address, uint32_t value) {
        check_register(address);
        OneCall call(busy_);
        core_->write(static_cast<uint32_t>(address), value);
    }

    nb::object read_memory(std::size_t address, std::size_t count) {
        check_words(address, count);
        std::vector<uint32_t> words(count);
        {
            OneCall call(busy_);
            nb::gil_scoped_release released;
            core_->read_memory(address, words);
        }
        return python::to_numpy(std::move(words), {count});
    }

    void write_memory(std::size_t address, const Words& words) {
        check_words(address, words.size());
        OneCall call(busy_);
        nb::gil_scoped_release released;
        core_->write_memory(address, {words.data(), words.size()});
    }

    void map_external(uint32_t address, const Words& words) {
        if (!cached())
            throw std::invalid_argument("the memory of this core is not external");
        if (address % 4 != 0 || words.size() > (0x1'0000'0000 - address) / 4)
            throw std::invalid_argument(std::to_string(words.size()) + " words from byte " + std::to_string(address) +
                                        " on are not whole words of 32-bit addresses");
        OneCall call(busy_);
        external_ = words;
        core_->map_external(address, {words.data(), words.size()});
    }

    void expect(long width, long height, uint32_t stall_seed) {
        constexpr long limit = (1 << size_bits) - 1;
        if (width < 1 || width > limit || height < 1 || height > limit)
            throw std::invalid_argument(std::to_string(width) + "x" + std::to_string(height) +
                                        " pixels are not 1x1 ... " + std::to_string(limit) + "x" +
                                        std::to_string(limit));
        OneCall call(busy_);
        core_->expect(static_cast<unsigned>(width), static_cast<unsigned>(height), stall_seed);
        width_ = static_cast<std::size_t>(width);
        height_ = static_cast<std::size_t>(height);
    }

    bool run(uint64_t clocks) {
        OneCall call(busy_);
        nb::gil_scoped_release released;
        return core_->run(clocks, check_signals);
    }

    nb::object frame() {
        OneCall call(busy_);
        const FrameSink& sink = core_->sink();
        if (!sink.fault().empty())
            throw std::runtime_error("the video stream has " + sink.fault());
        if (!sink.complete() || width_ == 0)
            throw std::runtime_error("no complete frame");
        return python::to_numpy(std::vector<uint8_t>(sink.bytes()), {height_, width_, 3});
    }

private:
    static void check_register(long address) {
        if (address < 0 || address >= register_bytes || address % 4 != 0)
            throw std::invalid_argument("byte " + std::to_string(address) + " is no register");
    }

    void check_words(std::size_t address, std::size_t count) const {
        if (cached())
            throw std::invalid_argument("a core with an external memory has no memory port");
        if (address > memory_words() || count > memory_words() - address)
            throw std::invalid_argument(std::to_string(count) + " words from word " + std::to_string(address) +
                                        " on are not in a memory of " + std::to_string(memory_words()));
    }

    Words external_; // Kept as long as it is mapped.
    std::unique_ptr<Core> core_;
    std::size_t width_ = 0, height_ = 0;
    bool busy_ = false;
};

} // namespace

void bind_core(nb::module_& m) {
    std::vector<std::string> names;
    for (const CoreConfiguration& configuration : cores)
        names.emplace_back(configuration.name);
    m.attr("CORES") = names;
    nb::class_<CheckedCore>(m, "Core")
        .def(nb::init<const std::string&>(), "config"_a)
        .def_prop_ro("memory_words", &CheckedCore::memory_words)
        .def_prop_ro("cached", &CheckedCore::cached)
        .def("read", &CheckedCore::read, "address"_a)
        .def("write", &CheckedCore::write, "address"_a, "value"_a)
        .def("read_memory", &CheckedCore::read_memory, "address"_a, "count"_a)
        .def("write_memory", &CheckedCore::write_memory, "address"_a, "words"_a)
        .def("map_external", &CheckedCore::map_external, "address"_a, "words"_a)
        .def("expect", &CheckedCore::expect, "width"_a, "height"_a, nb::kw_only(), "stall_seed"_a = 0)
        .def("run", &CheckedCore::run, "clocks"_a)
        .def("frame", &CheckedCore::frame);
}

} // namespace voxrt::rtl
