// voxrt.sim._rtl: the verilated ray tracer for Python. Every argument is checked here.
//
//   CONFIGS: list[str]        names of the configurations that were built
//   COMPLETE: bool            whether they are all of rtl/configurations.json, and the whole cores too
//   WAVE: bool                whether there is a recorded tiny
//   FEATURES: dict[str, list[str]]  which of "light", "mirrors" and "lod" each of them has built in
//   Tracer(config, *, recorded=False)
//                             one instance of the design with its own memory; one call at a time (RuntimeError).
//                             recorded, of tiny alone: with take_wave
//     .memory_words           how many words the simulated memory holds
//     .cached                 whether its memory is external, behind caches
//     .max_depth              the deepest octree that the configuration can trace
//     .position_limit         camera positions are in -limit ... limit - 1, 1/16 voxel
//     .light_limit            light positions are in -limit ... limit - 1, 1/16 voxel
//     .load(words, *, lod_words=False, through_port=False)
//                             uint32, 1-D, report dialect or, where built in, dialect lod. Through the design's access
//                             port, one word a clock, or straight into the simulated memory: the outcome is the same. A
//                             cached memory is these words themselves, not a copy
//     .read_back(count)       uint32: the memory's first words, read through that port
//     .render(camera, width, height, depth, materials, *, flat=False, brightness=None, light=None, ambient=0,
//             bounces=0, mirrors=None, lod_scale=0, root=0, stall_seed=0, latency=50, interval=3, jitter=0,
//             dram_seed=0, progress=None) -> dict
//                             camera int32 (4, 3): position (1/16 voxel), look, right, up (signed 16 bit each);
//                             width, height 1 ... 4095; depth 1 ... max_depth, the levels below the root;
//                             materials uint8 (256, 3), sRGB, row 0 is the background; brightness None, by the
//                             angle, or uint8 (6,), 1/255, of the faces along -x, +x, -y, +y, -z, +z; light int32 (3,),
//                             1/16 voxel; ambient 0 ... 255; bounces 0 ... 15; mirrors uint8 (256,), flags; lod_scale
//                             0 ... 2**20 - 1, 0 but for words of the dialect lod; root the word address of the
//                             octree's root. With a stall_seed, the picture's consumer stalls in a
//                             pattern that depends on it. latency, interval, jitter, dram_seed: of a cached memory, in
//                             clocks; see dram.h. Its caches are empty at the start. Gives colour uint8 (H, W, 3),
//                             material and face uint8 (H, W), cycles (from the start to the last pixel accepted),
//                             words_read, and the frame's errors: "direction overflow", "bad pointer", "step limit",
//                             "bus error", "bus timeout"; of a cached memory also word_requests, line_requests and
//                             lines_read (voxrt_pkg.sv: counters_t), else 0. progress is called with the rows done, now
//                             and then. Releases the GIL; Ctrl-C ends it.
//     .take_wave()            str, a VCD file: the last frame's signals of the lane, two samples per clock, the first
//                             before a rising edge, the second after it; "" if not recorded
//
//   CORES, Core     the whole core: core_module.cpp
//
// ValueError: a name, size or register out of range, or a feature that is not built in.
#include "core_module.h"
#include "design.h"
#include "one_call.h"

#include <voxrt/voxelize/bindings/python.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::rtl {

#define VOXRT_CONFIGURATION(name, light, mirrors, lod) std::unique_ptr<Design> make_##name();
#include "configurations.inc"
#undef VOXRT_CONFIGURATION
#if VOXRT_RTL_WAVE
std::unique_ptr<Design> make_recorded_tiny();
#else
inline std::unique_ptr<Design> make_recorded_tiny() { return nullptr; }
#endif

namespace {

struct Configuration {
    const char* name;
    std::unique_ptr<Design> (*make)();
    bool light, mirrors, lod;
};

constexpr Configuration configurations[] = {
#define VOXRT_CONFIGURATION(name, light, mirrors, lod) {#name, make_##name, light, mirrors, lod},
#include "configurations.inc"
#undef VOXRT_CONFIGURATION
};

using Words = nb::ndarray<const uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using CameraRegisters = nb::ndarray<const int32_t, nb::shape<4, 3>, nb::c_contig, nb::device::cpu>;
using Materials = nb::ndarray<const uint8_t, nb::shape<256, 3>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const uint8_t, nb::shape<256>, nb::c_contig, nb::device::cpu>;
using Faces = nb::ndarray<const uint8_t, nb::shape<6>, nb::c_contig, nb::device::cpu>;
using Place = nb::ndarray<const int32_t, nb::shape<3>, nb::c_contig, nb::device::cpu>;

std::string range(long low, long high) { return std::to_string(low) + " ... " + std::to_string(high); }

void check(const char* what, long value, long low, long high) {
    if (value < low || value > high)
        throw std::invalid_argument(std::string(what) + " " + std::to_string(value) + " is not in " + range(low, high));
}

int16_t direction_register(int32_t value) {
    check("camera direction component", value, INT16_MIN, INT16_MAX);
    return static_cast<int16_t>(value);
}

// The names of the flags that are set.
std::vector<std::string> names_of(std::initializer_list<std::pair<const char*, bool>> flags) {
    std::vector<std::string> names;
    for (const auto& [name, is_set] : flags)
        if (is_set)
            names.emplace_back(name);
    return names;
}

class Tracer {
public:
    Tracer(const std::string& name, bool recorded) {
        if (recorded && name == "tiny")
            design_ = make_recorded_tiny();
        else if (recorded)
            throw std::invalid_argument("no wave of the configuration " + name + ": only of tiny");
        for (const Configuration& configuration : configurations)
            if (!recorded && name == configuration.name)
                design_ = configuration.make();
        if (!design_)
            throw std::invalid_argument("no configuration " + name + ": see CONFIGS");
    }

    std::size_t memory_words() const { return design_->limits().memory_words(); }
    bool cached() const { return design_->limits().form == MemoryForm::cached; }
    unsigned max_depth() const { return design_->limits().max_depth; }
    int position_limit() const { return 1 << (design_->limits().position_bits - 1); }
    int light_limit() const { return 1 << (design_->limits().light_bits() - 1); }

    void load(const Words& words, bool lod_words, bool through_port) {
        if (words.size() < 1 || words.size() > memory_words())
            throw std::invalid_argument(std::to_string(words.size()) + " words do not fit this memory of " +
                                        range(1, static_cast<long>(memory_words())));
        if (through_port)
            check_port();
        if (lod_words && !design_->limits().lod)
            throw std::invalid_argument("this configuration has not been built with that feature: see FEATURES");
        OneCall call(busy_);
        lod_words_ = lod_words;
        loaded_ = cached() ? words : Words();
        nb::gil_scoped_release released;
        design_->load({words.data(), words.size()}, lod_words, through_port);
    }

    nb::object read_back(std::size_t count) {
        check_port();
        if (count > memory_words())
            throw std::invalid_argument("the memory has " + std::to_string(memory_words()) + " words, not " +
                                        std::to_string(count));
        std::vector<uint32_t> words;
        {
            OneCall call(busy_);
            nb::gil_scoped_release released;
            words = design_->read_back(count);
        }
        return python::to_numpy(std::move(words), {count});
    }

    nb::dict render(const CameraRegisters& camera, long width, long height, long depth, const Materials& materials,
                    bool flat, const std::optional<Faces>& brightness, const std::optional<Place>& light, long ambient,
                    long bounces, const std::optional<Flags>& mirrors, long lod_scale, uint32_t root,
                    uint32_t stall_seed, long latency, long interval, long jitter, uint32_t dram_seed,
                    const std::optional<nb::callable>& progress) {
        const Limits& limits = design_->limits();
        check("width", width, 1, (1 << size_bits) - 1);
        check("height", height, 1, (1 << size_bits) - 1);
        check("depth", depth, 1, limits.max_depth);
        FrameRequest request{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            check("camera position", camera(0, axis), -position_limit(), position_limit() - 1);
            request.position[axis] = camera(0, axis);
            request.look[axis] = direction_register(camera(1, axis));
            request.right[axis] = direction_register(camera(2, axis));
            request.up[axis] = direction_register(camera(3, axis));
        }
        request.width = static_cast<unsigned>(width);
        request.height = static_cast<unsigned>(height);
        request.depth = static_cast<unsigned>(depth);
        request.materials = materials.data();
        static constexpr uint8_t no_mirrors[256] = {};
        request.mirrors = mirrors ? mirrors->data() : no_mirrors;
        if ((light && !limits.light) || (bounces != 0 && !limits.mirrors))
            throw std::invalid_argument("this configuration has not been built with that feature: see FEATURES");
        check("ambient", ambient, 0, 255);
        check("bounces", bounces, 0, bounce_limit);
        request.flat = flat;
        request.faces = brightness.has_value();
        for (std::size_t face = 0; brightness && face < 6; ++face)
            request.brightness[face] = (*brightness)(face);
        request.light = light.has_value();
        request.ambient = static_cast<uint8_t>(ambient);
        request.bounces = static_cast<uint8_t>(bounces);
        for (std::size_t axis = 0; light && axis < 3; ++axis) {
            check("light position", (*light)(axis), -light_limit(), light_limit() - 1);
            request.light_position[axis] = (*light)(axis);
        }
        check("lod_scale", lod_scale, 0, lod_words_ ? (1 << 20) - 1 : 0);
        request.lod_scale = static_cast<uint32_t>(lod_scale);
        request.root = root;
        request.stall_seed = stall_seed;
        check("latency", latency, 0, clock_limit);
        check("interval", interval, 1, clock_limit);
        check("jitter", jitter, 0, clock_limit);
        request.dram = {.latency = static_cast<unsigned>(latency),
                        .interval = static_cast<unsigned>(interval),
                        .jitter = static_cast<unsigned>(jitter),
                        .seed = dram_seed};
        if (cached() && !loaded_.is_valid())
            throw std::invalid_argument("this configuration's memory is external: load words first");

        const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
        std::vector<uint8_t> colour(3 * rows * columns), material(rows * columns), face(rows * columns);
        FrameCost cost;
        {
            OneCall call(busy_);
            nb::gil_scoped_release released;
            std::size_t done = 0;
            cost = design_->render(request, {colour.data(), material.data(), face.data(), &done}, [&] {
                check_signals();
                if (progress) {
                    nb::gil_scoped_acquire acquired;
                    (*progress)(done / columns);
                }
            });
        }
        nb::dict result;
        result["colour"] = python::to_numpy(std::move(colour), {rows, columns, 3});
        result["material"] = python::to_numpy(std::move(material), {rows, columns});
        result["face"] = python::to_numpy(std::move(face), {rows, columns});
        result["cycles"] = cost.cycles;
        result["words_read"] = cost.words_read;
        result["word_requests"] = cost.word_requests;
        result["line_requests"] = cost.line_requests;
        result["lines_read"] = cost.lines_read;
        result["errors"] = names_of({{"direction overflow", cost.direction_overflow},
                                     {"bad pointer", cost.bad_pointer},
                                     {"step limit", cost.step_limit},
                                     {"bus error", cost.bus_error},
                                     {"bus timeout", cost.bus_timeout}});
        return result;
    }

    std::string take_wave() {
        OneCall call(busy_);
        return design_->take_wave();
    }

private:
    void check_port() const {
        if (cached())
            throw std::invalid_argument("the memory of this configuration is external: it has no access port");
    }

    static constexpr long clock_limit = 1'000'000;

    std::unique_ptr<Design> design_;
    Words loaded_; // a cached memory is the caller's
    bool lod_words_ = false;
    bool busy_ = false;
};

} // namespace
} // namespace voxrt::rtl

NB_MODULE(_rtl, m) {
    using voxrt::rtl::Tracer;
    std::vector<std::string> names;
    for (const auto& configuration : voxrt::rtl::configurations)
        names.emplace_back(configuration.name);
    m.attr("CONFIGS") = names;
    m.attr("COMPLETE") = VOXRT_RTL_COMPLETE;
    m.attr("WAVE") = static_cast<bool>(VOXRT_RTL_WAVE);
    nb::dict features;
    for (const auto& [name, make, light, mirrors, lod] : voxrt::rtl::configurations)
        features[name] = voxrt::rtl::names_of({{"light", light}, {"mirrors", mirrors}, {"lod", lod}});
    m.attr("FEATURES") = features;
    nb::class_<Tracer>(m, "Tracer")
        .def(nb::init<const std::string&, bool>(), "config"_a, nb::kw_only(), "recorded"_a = false)
        .def_prop_ro("memory_words", &Tracer::memory_words)
        .def_prop_ro("cached", &Tracer::cached)
        .def_prop_ro("max_depth", &Tracer::max_depth)
        .def_prop_ro("position_limit", &Tracer::position_limit)
        .def_prop_ro("light_limit", &Tracer::light_limit)
        .def("take_wave", &Tracer::take_wave)
        .def("load", &Tracer::load, "words"_a, nb::kw_only(), "lod_words"_a = false, "through_port"_a = false)
        .def("read_back", &Tracer::read_back, "count"_a)
        .def("render", &Tracer::render, "camera"_a, "width"_a, "height"_a, "depth"_a, "materials"_a, nb::kw_only(),
             "flat"_a = false, "brightness"_a.none() = nb::none(), "light"_a.none() = nb::none(), "ambient"_a = 0,
             "bounces"_a = 0, "mirrors"_a.none() = nb::none(), "lod_scale"_a = 0, "root"_a = 0, "stall_seed"_a = 0,
             "latency"_a = 50, "interval"_a = 3, "jitter"_a = 0, "dram_seed"_a = 0, "progress"_a.none() = nb::none());
    voxrt::rtl::bind_core(m);
}
