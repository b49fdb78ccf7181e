// An external memory on the core's AXI4 read ports: a memory of the caller's, mapped and not copied.
//
// A line of 32 bytes comes `latency` clocks after its address was taken, and up to `jitter` more; each at least
// `interval` clocks after the one before, over all ports. Its four beats come at successive clocks. A port answers in
// order. With a seed, addresses are not always taken at once. Words outside of the memory answer DECERR.
#pragma once

#include "stall_pattern.h"

#include <cstdint>
#include <deque>
#include <span>

namespace voxrt::rtl {

struct DramTiming {
    unsigned latency = 50, interval = 3, jitter = 0; // clocks; interval is 1 or more
    uint32_t seed = 0;                               // of jitter and back-pressure; 0: none of either
};

class Dram {
public:
    static constexpr unsigned ports = 2;
    static constexpr uint32_t base = 0x1000'0000; // the value of the register memory_base

    // What a port drives in a clock.
    struct Response {
        bool arready = false, rvalid = false;
        uint64_t rdata = 0;
        unsigned rresp = 0;
    };

    // The first word is at a multiple of 4; before it, in its line, are zeros. The words stay the caller's.
    void map(std::span<const uint32_t> words, uint32_t address = base + 28) {
        words_ = words;
        address_ = address;
    }

    void set_timing(const DramTiming& timing) {
        timing_ = timing;
        random_ = timing.seed;
        for (unsigned port = 0; port < ports; ++port)
            stalls_[port] = StallPattern(timing.seed == 0 ? 0 : timing.seed + port);
    }

    // Before a clock's edge: what a port drives.
    const Response& drive(unsigned port) {
        Response& response = responses_[port];
        std::deque<Line>& lines = lines_[port];
        response.arready = !stalls_[port].next();
        response.rvalid = !lines.empty() && lines.front().ready <= now_;
        if (response.rvalid) {
            const uint32_t byte = lines.front().address + 8 * beats_[port];
            response.rresp = byte - (address_ & ~31u) < (address_ & 31) + 4 * words_.size() ? 0 : 3;
            response.rdata = uint64_t{word(byte + 4)} << 32 | word(byte);
        }
        return response;
    }

    // At the edge, after all ports were driven: what the core does.
    void accept(unsigned port, bool arvalid, uint32_t araddr, bool rready) {
        const Response& response = responses_[port];
        if (response.rvalid && rready && ++beats_[port] == 4) {
            beats_[port] = 0;
            lines_[port].pop_front();
        }
        if (response.arready && arvalid) {
            uint64_t ready = now_ + (timing_.latency == 0 ? 1 : timing_.latency);
            if (timing_.seed != 0 && timing_.jitter != 0)
                ready += next_random() % (timing_.jitter + 1);
            if (ready < last_ready_ + timing_.interval)
                ready = last_ready_ + timing_.interval;
            last_ready_ = ready;
            lines_[port].push_back({araddr, ready});
        }
    }

    void tick() { ++now_; }

private:
    struct Line {
        uint32_t address;
        uint64_t ready;
    };

    uint32_t word(uint32_t byte) const {
        const uint32_t number = (byte - address_) / 4;
        return number < words_.size() ? words_[number] : 0;
    }

    uint32_t next_random() { return random_ = random_ * 1664525 + 1013904223, random_ >> 8; }

    std::span<const uint32_t> words_;
    uint32_t address_ = base + 28;
    DramTiming timing_;
    StallPattern stalls_[ports]{StallPattern(0), StallPattern(0)};
    Response responses_[ports];
    std::deque<Line> lines_[ports];
    unsigned beats_[ports] = {};
    uint64_t now_ = 0, last_ready_ = 0;
    uint32_t random_ = 0;
};

} // namespace voxrt::rtl
