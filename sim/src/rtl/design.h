// A configuration of the ray tracer, whatever class Verilator made of it.
#pragma once

#include "dram.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace voxrt::rtl {

// voxrt_pkg: the parameter MemoryForm.
enum class MemoryForm { copies, banked, cached };

// The parameters of the design that callers must respect: Design checks none of them.
struct Limits {
    unsigned lanes;
    MemoryForm form;
    unsigned max_depth;     // depth is 1 .. max_depth
    unsigned position_bits; // signed
    unsigned block_bits;    // blocks of eight words that the memory holds: 2 ** block_bits
    bool light, mirrors;    // features that are built in; others are off, whatever is asked for
    bool lod;

    std::size_t memory_words() const { return (std::size_t{8} << block_bits) + 1; }
    // Signed, 1/16 voxel: voxrt_pkg::light_bits.
    unsigned light_bits() const { return max_depth + 4 >= 20 ? max_depth + 6 : 21; }
};

// Sizes are 1 .. 2 ** size_bits - 1.
inline constexpr unsigned size_bits = 12;
inline constexpr unsigned bounce_limit = 15;

struct FrameRequest {
    int32_t position[3]; // 1/16 voxel
    int16_t look[3], right[3], up[3];
    unsigned width, height;
    unsigned depth;
    uint32_t root;            // word address
    const uint8_t* materials; // 256 x 3, row 0 is the background
    const uint8_t* mirrors;   // 256 flags
    bool flat, light;
    bool faces;                // each face has its brightness, unless flat
    uint8_t brightness[6];     // 1/255, of the faces that look along -x, +x, -y, +y, -z, +z
    int32_t light_position[3]; // 1/16 voxel
    uint8_t ambient;           // 1/256
    uint8_t bounces;           // 0 .. bounce_limit
    uint32_t lod_scale;        // below 2 ** 20; 0 but for memories of the dialect lod
    DramTiming dram;           // of a cached memory
    uint32_t stall_seed;       // 0: the output is always ready; else it stalls in a pattern of this seed's
};

// Row by row from the top; colour 3 bytes a pixel.
struct FrameImage {
    uint8_t* colour;
    uint8_t* material;
    uint8_t* face;
    std::size_t* done = nullptr; // pixels so far, whenever poll is called
};

struct FrameCost {
    uint64_t cycles; // from the start to the last pixel accepted
    uint64_t words_read;
    uint64_t word_requests, line_requests, lines_read; // of a cached memory, else 0
    bool direction_overflow, bad_pointer, step_limit, bus_error, bus_timeout;
};

class Design {
public:
    virtual ~Design() = default;
    virtual const Limits& limits() const = 0;
    // At most memory_words(), report dialect or, if built in, dialect lod. Through the access port, a word a clock, or
    // straight into the memory. A cached memory is the caller's words, which must stay until others are loaded; it has
    // no access port.
    virtual void load(std::span<const uint32_t> words, bool lod_words, bool through_port) = 0;
    // What the access port reads from address 0 on.
    virtual std::vector<uint32_t> read_back(std::size_t count) = 0;
    // Calls poll now and then; what it throws ends the frame, and the design stays usable.
    virtual FrameCost render(const FrameRequest& request, const FrameImage& image,
                             const std::function<void()>& poll) = 0;
    // The text of a VCD file with the last frame's signals, two samples per clock; empty if they are not recorded.
    virtual std::string take_wave() = 0;
};

} // namespace voxrt::rtl
