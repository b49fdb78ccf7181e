// A voxrt_core with a board around it: a master on its AXI4-Lite registers, a controller on its memory port or an
// external memory on its AXI4 read ports, and a sink for its AXI4-Stream video. Time passes by clocks, and only in
// these calls.
#pragma once

#include "design.h"
#include "frame_sink.h"

namespace voxrt::rtl {

class Core {
public:
    virtual ~Core() = default;
    virtual const Limits& limits() const = 0;

    // Byte addresses. std::runtime_error: the core refuses the access or does not answer.
    virtual uint32_t read(uint32_t address) = 0;
    virtual void write(uint32_t address, uint32_t value) = 0;

    // Gives a cached core the words of its external memory from byte `address` on, a multiple of 4. They stay the
    // caller's, who may change them at any time between calls. Reads elsewhere answer DECERR.
    virtual void map_external(uint32_t address, std::span<const uint32_t> words) = 0;

    // Accesses the memory of a core that is not cached, a word per clock. `address` counts words; the caller checks it.
    virtual void read_memory(std::size_t address, std::span<uint32_t> words) = 0;
    virtual void write_memory(std::size_t address, std::span<const uint32_t> words) = 0;

    // Takes the stream from now on, until a frame is complete; stalls as StallPattern says. Before, the stream waits.
    virtual void expect(unsigned width, unsigned height, uint32_t stall_seed) = 0;
    // Lets clocks pass, at most so many, until the frame is complete: whether it is. Calls poll now and then.
    virtual bool run(uint64_t clocks, const std::function<void()>& poll) = 0;
    virtual const FrameSink& sink() const = 0;
};

} // namespace voxrt::rtl
