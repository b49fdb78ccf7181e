// voxrt.sim._model: the exact model for Python.
#include "../frames/frame.h"
#include "../frames/frame_tile.h"
#include "../rays/ray.h"
#include "../views/fit_views.h"
#include "../views/similarity.h"
#include "owned_memory.h"
#include "pick_bindings.h"
#include "views_bindings.h"

#include <voxrt/voxelize/bindings/python.h>
#include <voxrt/voxelize/vectors/instruction_sets.h>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace nb = nanobind;
using namespace voxrt::sim;
using voxrt::octree::VerifiedMemory;
using voxrt::python::instruction_sets;
using voxrt::python::LongCall;
using voxrt::python::NamedTuple;
using voxrt::python::to_numpy;

namespace {

using Palette = nb::ndarray<const uint8_t, nb::shape<256, 3>, nb::c_contig, nb::device::cpu>;
using Registers = nb::ndarray<const int32_t, nb::shape<4, 3>, nb::c_contig, nb::device::cpu>;
using Triples = nb::ndarray<const int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

using Position = nb::ndarray<const int32_t, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using Faces = nb::ndarray<const uint8_t, nb::shape<6>, nb::c_contig, nb::device::cpu>;
using Means = nb::ndarray<const uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const uint8_t, nb::shape<256>, nb::c_contig, nb::device::cpu>;

constexpr int kBounceLimit = 15;
constexpr int32_t kSizeLimit = 1 << 14;
constexpr int kThreadLimit = 1024;

NamedTuple rendered_pixels, traced_rays;

// Ends frames for good, from any thread.
class Stop {
public:
    void set() { requested_ = true; }
    bool requested() const { return requested_; }

private:
    std::atomic<bool> requested_{false};
};

// The end of a frame before its last pixel; `error` is the Python exception that says why.
struct FrameEnded {
    PyObject* error;
    std::string problem;
};

// Ends the work of the current thread after `seconds` of an idle processor, or when `stop` is set; made after a
// LongCall, whose check it calls too. Work is counted, not time: a busy machine ends no frame earlier.
class FrameLimit {
public:
    FrameLimit(double seconds, const Stop* stop)
        : seconds_(seconds), stop_(stop), outer_(voxrt::voxelize::WorkCounter::current().current_check()) {}

private:
    void check() {
        if (stop_ != nullptr && stop_->requested())
            throw FrameEnded{PyExc_InterruptedError, "the frame was stopped"};
        if (++checks_ * voxrt::voxelize::WorkCounter::kCheckSeconds > seconds_)
            throw FrameEnded{PyExc_TimeoutError, "the frame takes too long"};
        (*outer_)();
    }

    const double seconds_;
    const Stop* const stop_;
    const std::function<void()>* const outer_;
    double checks_ = 0;
    const voxrt::voxelize::InterruptScope scope_{[this] { check(); }};
};

void check_threads(int threads) {
    if (threads < 0 || threads > kThreadLimit)
        throw std::invalid_argument("threads is " + std::to_string(threads) + ", not 0 ... 1024");
}

Lod lod_of(const OwnedMemory& memory, const std::optional<Means>& means, int scale) {
    if (scale < 0 || scale >= static_cast<int>(kLodScaleLimit))
        throw std::invalid_argument("lod_scale is " + std::to_string(scale) + ", not 0 ... 2**20 - 1");
    if (scale == 0)
        return {};
    const size_t blocks = voxrt::octree::block_count(memory.verified().memory().size);
    if (!means || means->shape(0) != blocks)
        throw std::invalid_argument("means must have a material for each of the " + std::to_string(blocks) + " blocks");
    return {means->data(), static_cast<uint32_t>(scale)};
}

Shading shading_of(const Palette& materials, bool flat, const std::optional<Faces>& brightness,
                   const std::optional<Position>& light, int ambient, int bounces,
                   const std::optional<Flags>& mirrors) {
    if (ambient < 0 || ambient > 255)
        throw std::invalid_argument("ambient is " + std::to_string(ambient) + ", not 0 ... 255");
    if (bounces < 0 || bounces > kBounceLimit)
        throw std::invalid_argument("bounces is " + std::to_string(bounces) + ", not 0 ... 15");
    static constexpr uint8_t no_mirrors[256] = {};
    Shading shading{materials.data(), mirrors ? mirrors->data() : no_mirrors, bounces, flat, {}, {}};
    if (brightness)
        std::copy_n(brightness->data(), 6, shading.faces.emplace().begin());
    if (light)
        shading.light = Light{{(*light)(0), (*light)(1), (*light)(2)}, static_cast<uint8_t>(ambient)};
    return shading;
}

nb::object render_frame(const OwnedMemory& memory, const Palette& materials, const Registers& registers, int width,
                        int height, int threads, const std::string& instructions, bool flat,
                        const std::optional<Faces>& brightness, const std::optional<Position>& light, int ambient,
                        int bounces, const std::optional<Flags>& mirrors, const std::optional<Means>& means,
                        int lod_scale, double seconds, const Stop* stop) {
    const Shading shading = shading_of(materials, flat, brightness, light, ambient, bounces, mirrors);
    const Lod lod = lod_of(memory, means, lod_scale);
    if (lod.on() && (light || bounces != 0))
        throw std::invalid_argument("level of detail does not go with a light or reflections");
    check_threads(threads);
    if (width < 1 || height < 1 || width > kSizeLimit || height > kSizeLimit)
        throw std::invalid_argument("a frame of " + std::to_string(width) + "x" + std::to_string(height) +
                                    " pixels is not 1x1 ... 16384x16384");
    const TileEngine& engine = voxrt::voxelize::engine_of(tile_engines(), instructions);
    Camera camera;
    for (int axis = 0; axis < 3; ++axis) {
        camera.position[axis] = registers(0, axis);
        camera.look[axis] = registers(1, axis);
        camera.right[axis] = registers(2, axis);
        camera.up[axis] = registers(3, axis);
    }
    check_directions(camera, width, height);
    const size_t h = static_cast<size_t>(height), w = static_cast<size_t>(width);
    auto colour = std::make_unique<uint8_t[]>(3 * h * w), material = std::make_unique<uint8_t[]>(h * w),
         face = std::make_unique<uint8_t[]>(h * w);
    uint64_t words_read = 0;
    try {
        const LongCall call;
        const FrameLimit limit(seconds, stop);
        voxrt::voxelize::WorkCounter::current().check(); // a small frame may end before its work calls it
        words_read = render(memory.verified(), shading, lod, camera,
                            {width, height, colour.get(), material.get(), face.get()}, threads, engine.render_tile);
    } catch (const FrameEnded& ended) {
        PyErr_SetString(ended.error, ended.problem.c_str());
        throw nb::python_error();
    }
    return rendered_pixels(to_numpy(std::move(colour), {h, w, 3}), to_numpy(std::move(material), {h, w}),
                           to_numpy(std::move(face), {h, w}), words_read);
}

nb::object trace_rays(const OwnedMemory& memory, const Triples& origins, const Triples& directions, int threads) {
    check_threads(threads);
    const size_t count = origins.shape(0);
    if (directions.shape(0) != count)
        throw std::invalid_argument(std::to_string(count) + " origins do not go with " +
                                    std::to_string(directions.shape(0)) + " directions");
    for (size_t i = 0; i < 3 * count; ++i)
        if (const int32_t d = directions.data()[i]; d <= -kDirectionLimit || d >= kDirectionLimit)
            throw std::invalid_argument("direction " + std::to_string(i / 3) + " reaches " + std::to_string(d) +
                                        " on axis " + "xyz"[i % 3] + ", which is not below 2**20");
    auto material = std::make_unique<uint8_t[]>(count), face = std::make_unique<uint8_t[]>(count);
    auto cell = std::make_unique<int32_t[]>(3 * count);
    uint64_t words_read = 0;
    {
        const LongCall call;
        words_read =
            trace_all(memory.verified(),
                      {count, origins.data(), directions.data(), material.get(), face.get(), cell.get()}, threads);
    }
    return traced_rays(to_numpy(std::move(material), {count}), to_numpy(std::move(face), {count}),
                       to_numpy(std::move(cell), {count, 3}), words_read);
}

// A Python integer of 128 bits, for which nanobind has no cast.
nb::object to_python(WideKey value) {
    return nb::cast(static_cast<int64_t>(value >> 64)) * nb::cast(uint64_t{1} << 32) * nb::cast(uint64_t{1} << 32) +
           nb::cast(static_cast<uint64_t>(value));
}

void check_direction(const Position& direction) {
    for (int axis = 0; axis < 3; ++axis)
        if (direction(axis) <= -kDirectionLimit || direction(axis) >= kDirectionLimit)
            throw std::invalid_argument("the direction reaches " + std::to_string(direction(axis)) + " on axis " +
                                        "xyz"[axis] + ", which is not below 2**20");
}

nb::object follow_ray(const OwnedMemory& memory, const Position& origin, const Position& direction) {
    Line line{};
    for (int axis = 0; axis < 3; ++axis) {
        line.origin[axis] = origin(axis);
        line.direction[axis] = direction(axis);
    }
    check_direction(direction);
    nb::list readings;
    const Hit<WideKey> hit = Ray<WideKey>(memory.verified(), line).trace([&](const Reading<WideKey>& reading) {
        if (readings.size() % 4096 == 4095 && PyErr_CheckSignals() != 0)
            throw nb::python_error();
        readings.append(nb::make_tuple(reading.address, reading.word, reading.level,
                                       nb::make_tuple(reading.corner[0], reading.corner[1], reading.corner[2]),
                                       reading.face, to_python(reading.time)));
    });
    return nb::make_tuple(hit.material, hit.face, nb::make_tuple(hit.cell[0], hit.cell[1], hit.cell[2]), readings);
}

nb::object explain_ray(const OwnedMemory& memory, const Palette& materials, const Position& origin,
                       const Position& direction, bool flat, const std::optional<Faces>& brightness,
                       const std::optional<Position>& light, int ambient, int bounces,
                       const std::optional<Flags>& mirrors) {
    const Shading shading = shading_of(materials, flat, brightness, light, ambient, bounces, mirrors);
    check_direction(direction);
    PixelAccount account;
    const Pixel pixel = trace_pixel(memory.verified(), shading, {}, origin.data(), direction.data(), &account);
    const auto to_tuple = [](const Surface& met) {
        return nb::make_tuple(met.material, met.face, met.is_upper,
                              nb::make_tuple(met.cell[0], met.cell[1], met.cell[2]));
    };
    nb::list mirrors_met;
    for (const Surface& met : account.mirrors)
        mirrors_met.append(to_tuple(met));
    const nb::object surface = account.surface ? nb::object(to_tuple(*account.surface)) : nb::none();
    static constexpr const char* lights[] = {"none", "lit", "turned away", "shadowed"};
    return nb::make_tuple(nb::make_tuple(pixel.colour[0], pixel.colour[1], pixel.colour[2]), mirrors_met, surface,
                          lights[static_cast<int>(account.light)], to_python(account.brightness.part),
                          to_python(account.brightness.whole), account.is_mean);
}

using Colours = nb::ndarray<const uint8_t, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

void check_same_shape(const Colours& picture, const Colours& other) {
    if (picture.shape(0) != other.shape(0) || picture.shape(1) != other.shape(1))
        throw std::invalid_argument("the pictures differ in shape");
}

double signal_to_noise(const Colours& picture, const Colours& other) {
    check_same_shape(picture, other);
    const LongCall call;
    return peak_signal_to_noise(picture.data(), other.data(), picture.shape(0) * picture.shape(1));
}

double similarity(const Colours& picture, const Colours& other) {
    check_same_shape(picture, other);
    const LongCall call;
    return structural_similarity(picture.data(), other.data(), picture.shape(1), picture.shape(0));
}

// FitViews with a palette of its own.
class OwnedViews {
public:
    OwnedViews(const OwnedMemory& memory, const Palette& materials, bool flat, int threads)
        : materials_(materials.data(), materials.data() + 768) {
        check_threads(threads);
        const LongCall call;
        views_.emplace(memory.verified(), materials_.data(), flat, threads);
    }
    OwnedViews(const OwnedViews&) = delete;
    OwnedViews& operator=(const OwnedViews&) = delete;

    std::pair<double, double> likeness(const OwnedMemory& fitted) const {
        const LongCall call;
        const Likeness found = views_->likeness(fitted.verified());
        return {found.psnr, found.ssim};
    }

    nb::object cameras() const {
        std::vector<int32_t> all;
        for (const Camera& camera : views_->cameras())
            for (const auto& triple : {camera.position, camera.look, camera.right, camera.up})
                all.insert(all.end(), triple, triple + 3);
        return to_numpy(std::move(all), {views_->cameras().size(), 4, 3});
    }

private:
    std::vector<uint8_t> materials_;
    std::optional<FitViews> views_;
};

std::size_t chosen_fit(const std::vector<std::tuple<double, double, double>>& fits) {
    if (fits.empty())
        throw std::invalid_argument("there are no fits to choose from");
    std::vector<FitFigures> figures;
    for (const auto& [changed, psnr, ssim] : fits)
        figures.push_back({changed, {psnr, ssim}});
    return choose_fit(figures);
}

} // namespace

NB_MODULE(_model, m) {
    m.attr("INSTRUCTION_SETS") = instruction_sets(tile_engines());
    rendered_pixels =
        NamedTuple(m, "RenderedPixels", {"colour", "material", "face", "words_read"}, "What Memory.render() returns.");
    traced_rays =
        NamedTuple(m, "TracedRays", {"material", "face", "cell", "words_read"}, "What Memory.trace() returns.");
    nb::class_<Stop>(m, "Stop", "Ends frames for good, from any thread.")
        .def(nb::init<>())
        .def("set", &Stop::set, "End the frames that were given this object, and all further ones.");
    nb::class_<OwnedMemory>(m, "Memory", "A verified octree memory, which any number of threads may trace through.")
        .def(nb::init<const Words&, int, std::size_t>(), nb::arg("words"), nb::arg("depth"), nb::arg("root") = 0,
             "Copy words (uint32, report dialect) of a depth of 1 ... 16, whose root is word `root`. ValueError, "
             "naming\n"
             "the word: malformed.")
        .def(nb::init<const OwnedMemory&, int, std::size_t>(), nb::arg("memory"), nb::arg("depth"), nb::arg("root"),
             "Take the octree at another root of a memory's words, which are not copied.")
        .def(
            "render", &render_frame, nb::arg("materials"), nb::arg("camera"), nb::arg("width"), nb::arg("height"),
            nb::arg("threads") = 0, nb::arg("instructions") = "", nb::kw_only(), nb::arg("flat") = false,
            nb::arg("brightness") = nb::none(), nb::arg("light") = nb::none(), nb::arg("ambient") = 0,
            nb::arg("bounces") = 0, nb::arg("mirrors") = nb::none(), nb::arg("means") = nb::none(),
            nb::arg("lod_scale") = 0, nb::arg("seconds") = std::numeric_limits<double>::infinity(),
            nb::arg("stop").none() = nb::none(),
            "Render a frame: materials (256, 3) uint8 sRGB, entry 0 the background; camera (4, 3) int32 position,\n"
            "look, right, up; threads 0 takes every core; instructions one of INSTRUCTION_SETS, empty for the first,\n"
            "which is the fastest. docs/shading.md defines the rest: flat; brightness, None or (6,) uint8 in\n"
            "1/255, of the faces that look along -x, +x, -y, +y, -z, +z; light, None or (3,) int32 in 1/16 voxel, "
            "with\n"
            "ambient 0 ... 255; bounces 0 ... 15 off mirrors, (256,) uint8 flags of materials. Returns colour (H, W, "
            "3), material (H, W), face (H, W), uint8, and words_read. lod_scale, 0 ... 2**20 - 1, of docs/lod.md;\n"
            "0 is off; else means, uint8, has a material per block, and there is no light and no bounce.\n"
            "ValueError: a frame above 16384 x 16384, pixel directions not below 2**20. TimeoutError: the frame takes\n"
            "more work than an idle core does in `seconds`. InterruptedError: `stop` is set.")
        .def("trace", &trace_rays, nb::arg("origins"), nb::arg("directions"), nb::arg("threads") = 0,
             "Trace rays: origins (N, 3) int32 in 1/16 voxel, directions (N, 3) int32, components below 2**20.\n"
             "Returns material (N,), face (N,), uint8, cell (N, 3) int32 (-1 at a miss), and words_read.\n"
             "ValueError: a direction out of range.")
        .def("follow", &follow_ray, nb::arg("origin"), nb::arg("direction"),
             "Trace one ray, as trace does, and list what it reads: origin (3,) int32 in 1/16 voxel, direction (3,)\n"
             "int32, components below 2**20. Returns material, face, cell and readings: for each word in order its\n"
             "address, word, level, corner (lowest voxel of its octant), axis of the plane crossed last or 3, and "
             "time,\n"
             "the T of that plane. Word 0 is kept between rays and not among them. ValueError: a direction out of "
             "range.")
        .def(
            "explain", &explain_ray, nb::arg("materials"), nb::arg("origin"), nb::arg("direction"), nb::kw_only(),
            nb::arg("flat") = false, nb::arg("brightness") = nb::none(), nb::arg("light") = nb::none(),
            nb::arg("ambient") = 0, nb::arg("bounces") = 0, nb::arg("mirrors") = nb::none(),
            "Explain the colour of the pixel of one ray, with the arguments of render and follow. Returns its colour;\n"
            "the surfaces met, the mirrors first: material, face, whether that looks along the positive axis, cell;\n"
            "the light on the last: none, lit, turned away or shadowed; its brightness, part / whole; and is_mean: "
            "the\n"
            "bounces were used up, so that the colour is the mean of the surfaces. ValueError: a direction out of "
            "range.");
    nb::class_<OwnedViews>(m, "FitViews", "Pictures of a scene from all around: fit_views.h.")
        .def(nb::init<const OwnedMemory&, const Palette&, bool, int>(), nb::arg("memory"), nb::arg("materials"),
             nb::arg("flat"), nb::arg("threads") = 0, "materials: (256, 3) uint8 sRGB, entry 0 the background.")
        .def("likeness", &OwnedViews::likeness, nb::arg("fitted"), "The means of PSNR, decibel, and SSIM.")
        .def("cameras", &OwnedViews::cameras, "The registers: int32, shape (6, 4, 3).");
    m.def("choose_fit", &chosen_fit, nb::arg("fits"),
          "The index of the fit whose worst figure is the best: (surface voxels changed, psnr, ssim) each.");
    bind_views(m);
    bind_pick(m);
    m.def("peak_signal_to_noise", &signal_to_noise, nb::arg("picture"), nb::arg("other"), "similarity.h");
    m.def("structural_similarity", &similarity, nb::arg("picture"), nb::arg("other"), "similarity.h");
}
