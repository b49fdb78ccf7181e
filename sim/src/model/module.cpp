// voxrt.sim._model: the exact model for Python.
#include "frame.h"
#include "frame_tile.h"
#include "ray.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace nb = nanobind;
using namespace voxrt::model;

namespace {

using Words = nb::ndarray<const uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Palette = nb::ndarray<const uint8_t, nb::shape<256, 3>, nb::c_contig, nb::device::cpu>;
using Registers = nb::ndarray<const int32_t, nb::shape<4, 3>, nb::c_contig, nb::device::cpu>;
using Triples = nb::ndarray<const int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

using Position = nb::ndarray<const int32_t, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const uint8_t, nb::shape<256>, nb::c_contig, nb::device::cpu>;

constexpr int kBounceLimit = 15;
constexpr int32_t kSizeLimit = 1 << 14;
constexpr int kThreadLimit = 1024;

// A NumPy array that this module made and Python owns.
template <class T> struct Owned {
    std::unique_ptr<T[]> data;
    explicit Owned(size_t size) : data(new T[size]()) {}
    nb::object array(std::initializer_list<size_t> shape) {
        T* raw = data.release();
        nb::capsule owner(raw, [](void* p) noexcept { delete[] static_cast<T*>(p); });
        return nb::cast(nb::ndarray<nb::numpy, T>(raw, shape, owner));
    }
};

// A memory that this module owns and has verified, so that nobody changes a word under it.
class OwnedMemory {
public:
    OwnedMemory(const Words& words, int depth) : words_(words.data(), words.data() + words.shape(0)), depth_(depth) {
        nb::gil_scoped_release release;
        view().verify();
    }
    Memory view() const { return {words_.data(), words_.size(), depth_}; }

private:
    std::vector<uint32_t> words_;
    int depth_;
};

void check_threads(int threads) {
    if (threads < 0 || threads > kThreadLimit)
        throw std::invalid_argument("threads is " + std::to_string(threads) + ", not 0 ... 1024");
}

// Whether Python has a signal waiting; the caller has released the GIL.
bool signal_waits() {
    nb::gil_scoped_acquire hold;
    return PyErr_CheckSignals() != 0;
}

nb::dict render_frame(const OwnedMemory& memory, const Palette& materials, const Registers& registers, int width,
                      int height, int threads, const std::string& instructions, bool flat,
                      const std::optional<Position>& light, int ambient, int bounces,
                      const std::optional<Flags>& mirrors) {
    if (ambient < 0 || ambient > 255)
        throw std::invalid_argument("ambient is " + std::to_string(ambient) + ", not 0 ... 255");
    if (bounces < 0 || bounces > kBounceLimit)
        throw std::invalid_argument("bounces is " + std::to_string(bounces) + ", not 0 ... 15");
    const uint8_t no_mirrors[256] = {};
    Shading shading{materials.data(), mirrors ? mirrors->data() : no_mirrors, bounces, flat, {}};
    if (light)
        shading.light = Light{{(*light)(0), (*light)(1), (*light)(2)}, static_cast<uint8_t>(ambient)};
    check_threads(threads);
    if (width < 1 || height < 1 || width > kSizeLimit || height > kSizeLimit)
        throw std::invalid_argument("a frame of " + std::to_string(width) + "x" + std::to_string(height) +
                                    " pixels is not 1x1 ... 16384x16384");
    const auto& engines = tile_engines();
    auto engine = engines.begin();
    while (!instructions.empty() && instructions != engine->instructions)
        if (++engine == engines.end())
            throw std::invalid_argument("this processor has no instruction set '" + instructions + "'");
    Camera camera;
    for (int axis = 0; axis < 3; ++axis) {
        camera.position[axis] = registers(0, axis);
        camera.look[axis] = registers(1, axis);
        camera.right[axis] = registers(2, axis);
        camera.up[axis] = registers(3, axis);
    }
    check_directions(camera, width, height);
    const size_t h = static_cast<size_t>(height), w = static_cast<size_t>(width);
    Owned<uint8_t> colour(3 * h * w), material(h * w), face(h * w);
    uint64_t words_read = 0;
    bool stopped = false;
    {
        nb::gil_scoped_release release;
        words_read = render(memory.view(), shading, camera,
                            {width, height, colour.data.get(), material.data.get(), face.data.get()}, threads,
                            engine->render_tile, [&] { return stopped = signal_waits(); });
    }
    if (stopped)
        throw nb::python_error();
    nb::dict out;
    out["colour"] = colour.array({h, w, 3});
    out["material"] = material.array({h, w});
    out["face"] = face.array({h, w});
    out["words_read"] = words_read;
    return out;
}

nb::dict trace_rays(const OwnedMemory& memory, const Triples& origins, const Triples& directions, int threads) {
    check_threads(threads);
    const size_t count = origins.shape(0);
    if (directions.shape(0) != count)
        throw std::invalid_argument(std::to_string(count) + " origins do not go with " +
                                    std::to_string(directions.shape(0)) + " directions");
    for (size_t i = 0; i < 3 * count; ++i)
        if (const int32_t d = directions.data()[i]; d <= -kDirectionLimit || d >= kDirectionLimit)
            throw std::invalid_argument("direction " + std::to_string(i / 3) + " reaches " + std::to_string(d) +
                                        " on axis " + "xyz"[i % 3] + ", which is not below 2**20");
    Owned<uint8_t> material(count), face(count);
    Owned<int32_t> cell(3 * count);
    uint64_t words_read = 0;
    bool stopped = false;
    {
        nb::gil_scoped_release release;
        words_read =
            trace_all(memory.view(),
                      {count, origins.data(), directions.data(), material.data.get(), face.data.get(), cell.data.get()},
                      threads, [&] { return stopped = signal_waits(); });
    }
    if (stopped)
        throw nb::python_error();
    nb::dict out;
    out["material"] = material.array({count});
    out["face"] = face.array({count});
    out["cell"] = cell.array({count, 3});
    out["words_read"] = words_read;
    return out;
}

// An integer of any size for Python: of 128 bits there is no cast.
nb::object whole(WideKey value) {
    return nb::cast(static_cast<int64_t>(value >> 64)) * nb::cast(uint64_t{1} << 32) * nb::cast(uint64_t{1} << 32) +
           nb::cast(static_cast<uint64_t>(value));
}

nb::dict follow_ray(const OwnedMemory& memory, const Position& origin, const Position& direction) {
    Line line{};
    for (int axis = 0; axis < 3; ++axis) {
        line.origin[axis] = origin(axis);
        line.direction[axis] = direction(axis);
        if (direction(axis) <= -kDirectionLimit || direction(axis) >= kDirectionLimit)
            throw std::invalid_argument("the direction reaches " + std::to_string(direction(axis)) + " on axis " +
                                        "xyz"[axis] + ", which is not below 2**20");
    }
    nb::list readings;
    const Hit<WideKey> hit = Ray<WideKey>(memory.view(), line).trace([&](const Reading<WideKey>& reading) {
        if (readings.size() % 4096 == 4095 && PyErr_CheckSignals() != 0)
            throw nb::python_error();
        readings.append(nb::make_tuple(reading.address, reading.word, reading.level,
                                       nb::make_tuple(reading.corner[0], reading.corner[1], reading.corner[2]),
                                       reading.face, whole(reading.time)));
    });
    nb::dict out;
    out["material"] = hit.material;
    out["face"] = hit.face;
    out["cell"] = nb::make_tuple(hit.cell[0], hit.cell[1], hit.cell[2]);
    out["readings"] = readings;
    return out;
}

} // namespace

NB_MODULE(_model, m) {
    nb::list instruction_sets;
    for (const TileEngine& engine : tile_engines())
        instruction_sets.append(engine.instructions);
    m.attr("INSTRUCTION_SETS") = nb::tuple(instruction_sets);
    nb::class_<OwnedMemory>(m, "Memory", "A verified octree memory, which any number of threads may trace through.")
        .def(nb::init<const Words&, int>(), nb::arg("words"), nb::arg("depth"),
             "Copy words (uint32, report dialect) of a depth of 1 ... 16. ValueError, naming the word: malformed.")
        .def("render", &render_frame, nb::arg("materials"), nb::arg("camera"), nb::arg("width"), nb::arg("height"),
             nb::arg("threads") = 0, nb::arg("instructions") = "", nb::kw_only(), nb::arg("flat") = false,
             nb::arg("light") = nb::none(), nb::arg("ambient") = 0, nb::arg("bounces") = 0,
             nb::arg("mirrors") = nb::none(),
             "Render a frame: materials (256, 3) uint8 sRGB, entry 0 the background; camera (4, 3) int32 position,\n"
             "look, right, up; threads 0 takes every core; instructions one of INSTRUCTION_SETS, empty for the first,\n"
             "which is the fastest. docs/shading.md defines the rest: flat; light, None or (3,) int32 in 1/16 voxel, "
             "with\n"
             "ambient 0 ... 255; bounces 0 ... 15 off mirrors, (256,) uint8 flags of materials. Gives colour (H, W, "
             "3), material (H, W), face (H, W), uint8, and words_read.\n"
             "ValueError: a frame above 16384 x 16384, pixel directions not below 2**20.")
        .def("trace", &trace_rays, nb::arg("origins"), nb::arg("directions"), nb::arg("threads") = 0,
             "Trace rays: origins (N, 3) int32 in 1/16 voxel, directions (N, 3) int32, components below 2**20.\n"
             "Gives material (N,), face (N,), uint8, cell (N, 3) int32 (-1 at a miss), and words_read.\n"
             "ValueError: a direction out of range.")
        .def(
            "follow", &follow_ray, nb::arg("origin"), nb::arg("direction"),
            "Trace one ray, as trace does, and tell what it reads: origin (3,) int32 in 1/16 voxel, direction (3,)\n"
            "int32, components below 2**20. Gives material, face, cell and readings: for each word in order (address,\n"
            "word, level, (x, y, z) of its octant's lowest voxel, axis of the plane crossed last or 3, the T of it).\n"
            "Word 0 is kept between rays and not among them. ValueError: a direction out of range.");
}
