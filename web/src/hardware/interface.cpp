// The C interface of voxrt_hardware.wasm: the verilated ray tracer of one configuration, with its own memory.
//
// A call that returns a number below 0 has failed: vx_error() is the reason, one line. Buffers come from vx_alloc. The
// pixels stay valid until the next frame.
#include "../export.h"
#include "../interface_error.h"

#include <design.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::rtl {
std::unique_ptr<Design> VOXRT_MAKE_DESIGN(); // sim/src/rtl/configuration.cpp.in
}

/// What the C++ library lacks here: destructors of a thread's variables, of a thread that does not end.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) { return 0; }

/// The page: how many pixels of the frame are ready. Called every 65,536 clocks.
extern "C" __attribute__((import_module("page"), import_name("progress"))) void page_progress(size_t pixels);

namespace {

using namespace voxrt;
using web::guarded;

constexpr uint8_t kNotYet = 0xFF; // no face

struct Frame {
    std::vector<uint8_t> colour, material, face;
    rtl::FrameCost cost{};
};

Frame frame;

rtl::Design& design() {
    static const std::unique_ptr<rtl::Design> made = rtl::VOXRT_MAKE_DESIGN();
    return *made;
}

template <class Integer> Integer checked(int32_t value, unsigned bits, const char* what) {
    if (value < -(1 << (bits - 1)) || value >= 1 << (bits - 1))
        throw std::invalid_argument(std::string(what) + " " + std::to_string(value) + " does not fit its register of " +
                                    std::to_string(bits) + " bits");
    return static_cast<Integer>(value);
}

unsigned side_of(int pixels) {
    if (pixels < 1 || pixels >= 1 << rtl::size_bits)
        throw std::invalid_argument("a frame of the hardware has 1 … 4095 columns and rows, not " +
                                    std::to_string(pixels));
    return static_cast<unsigned>(pixels);
}

void refuse(bool error, const char* name) {
    if (error)
        throw std::runtime_error(std::string("the hardware reports the error: ") + name);
}

} // namespace

EXPORT(vx_alloc) void* vx_alloc(size_t bytes) { return std::malloc(bytes > 0 ? bytes : 1); }
EXPORT(vx_free) void vx_free(void* buffer) { std::free(buffer); }
EXPORT(vx_error) const char* vx_error() { return web::last_error().c_str(); }

/// How many words its memory holds.
EXPORT(vx_word_limit) size_t vx_word_limit() { return design().limits().memory_words(); }

/// Copies the words of an octree memory, report dialect; returns 0.
EXPORT(vx_load) int vx_load(const uint32_t* words, size_t count) {
    return guarded([&] {
        if (count < 1 || count > vx_word_limit())
            throw std::invalid_argument("the hardware holds 1 … " + std::to_string(vx_word_limit()) + " words, not " +
                                        std::to_string(count));
        design().load({words, count}, false, false);
        return 0;
    });
}

/// Renders a frame; returns its clocks. `registers`: position (1/16 voxel), look, right, up. `materials`: 256 sRGB
/// triples. `faces`: 6, or null.
EXPORT(vx_run)
double vx_run(const int32_t* registers, int width, int height, int depth, const uint8_t* materials, int flat,
              const uint8_t* faces) {
    return guarded([&] {
        static constexpr uint8_t kNoMirrors[256] = {};
        const rtl::Limits& limits = design().limits();
        if (depth < 1 || depth > static_cast<int>(limits.max_depth))
            throw std::invalid_argument("the hardware traces octrees of depth 1 … " + std::to_string(limits.max_depth) +
                                        ", not " + std::to_string(depth));
        rtl::FrameRequest request{};
        for (int axis = 0; axis < 3; ++axis) {
            request.position[axis] = checked<int32_t>(registers[axis], limits.position_bits, "the camera position");
            request.look[axis] = checked<int16_t>(registers[3 + axis], 16, "the camera direction");
            request.right[axis] = checked<int16_t>(registers[6 + axis], 16, "the camera direction");
            request.up[axis] = checked<int16_t>(registers[9 + axis], 16, "the camera direction");
        }
        request.width = side_of(width);
        request.height = side_of(height);
        request.depth = static_cast<unsigned>(depth);
        request.materials = materials;
        request.mirrors = kNoMirrors;
        request.flat = flat != 0;
        request.faces = faces != nullptr;
        if (faces != nullptr)
            std::copy_n(faces, 6, request.brightness);
        const size_t pixels = size_t{request.width} * request.height;
        frame = {std::vector<uint8_t>(3 * pixels), std::vector<uint8_t>(pixels), std::vector<uint8_t>(pixels, kNotYet)};
        size_t ready = 0;
        frame.cost =
            design().render(request, {frame.colour.data(), frame.material.data(), frame.face.data()}, [&ready] {
                while (ready < frame.face.size() && frame.face[ready] != kNotYet)
                    ++ready;
                page_progress(ready);
            });
        refuse(frame.cost.direction_overflow, "direction overflow");
        refuse(frame.cost.bad_pointer, "bad pointer");
        refuse(frame.cost.step_limit, "step limit");
        return static_cast<double>(frame.cost.cycles);
    });
}
EXPORT(vx_colour) const uint8_t* vx_colour() { return frame.colour.data(); }
EXPORT(vx_frame_material) const uint8_t* vx_frame_material() { return frame.material.data(); }
EXPORT(vx_frame_face) const uint8_t* vx_frame_face() { return frame.face.data(); }
EXPORT(vx_words_read) double vx_words_read() { return static_cast<double>(frame.cost.words_read); }
