// Four ports on one SDRAM at once: what is read is what was written, in the order in which requests were accepted. Ends
// with 1 after a difference. Prints the reads of the ports and the longest wait; then clocks per line of some traffic.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <map>
#include <random>

#include "Vtop.h"
#include "verilated.h"

namespace {

using Line = std::array<uint32_t, 8>;

constexpr int ports = 4, ticks = 10, phase = 3;

class Bench {
public:
    Vtop top;
    uint64_t clocks = 0;
    std::array<uint64_t, ports> lines{}; // That each port has had.
    uint64_t longest = 0;                // From a request to its acceptance.
    bool writes = true;

    Bench() {
        for (int i = 0; i < 4; ++i)
            tick();
        top.rst_ni = 1;
    }

    // One clock: the ports whose bits are set ask whenever they can. Gives false after a difference.
    bool clock(uint32_t asks) {
        for (int p = 0; p < 2; ++p) {
            if ((top.valid_i >> p & 1) || !(asks >> p & 1))
                continue;
            top.line_i[p] = next_line(p);
            if (p == 1) {
                top.write_i = writes && random() % 4 == 0;
                top.mask_i = random() % 4 ? random() & 0xFFFF : 0xFFFF;
                for (int i = 0; i < 8; ++i)
                    top.data_i[i] = uint32_t(random());
            }
            top.valid_i |= 1 << p;
            since_[p] = clocks;
        }
        for (int p = 0; p < 2; ++p) {
            if ((top.request_valid_i >> p & 1) || !(asks >> (2 + p) & 1))
                continue;
            top.request_address_i[p] = next_line(2 + p) * 32;
            top.request_valid_i |= 1 << p;
        }
        top.eval();
        const uint32_t accepted = top.accepted_o, taken = top.request_valid_i & top.request_ready_o;
        for (int p = 0; p < ports; ++p) {
            if (!(accepted >> p & 1))
                continue;
            const uint32_t line = top.accepted_line_o[p * 20 / 32] >> (p * 20 % 32) |
                                  (p * 20 % 32 > 12 ? top.accepted_line_o[p * 20 / 32 + 1] << (32 - p * 20 % 32) : 0);
            Line& held = memory_[line & 0xFFFFF];
            const bool write = p == 1 && top.write_i;
            if (write) {
                for (int i = 0; i < 16; ++i) {
                    const uint32_t bits = 0xFFFFu << (i % 2 * 16);
                    if (top.mask_i >> i & 1)
                        held[i / 2] = (held[i / 2] & ~bits) | (top.data_i[i / 2] & bits);
                }
            }
            expected_[p].push_back({write, held});
            if (p < 2)
                longest = std::max(longest, clocks - since_[p]);
        }
        tick();
        top.valid_i &= ~accepted;
        top.request_valid_i &= ~taken;
        for (int p = 0; p < ports; ++p) {
            const bool answered = p < 2 ? top.done_o >> p & 1 : top.answer_valid_o >> (p - 2) & 1;
            if (!answered)
                continue;
            if (expected_[p].empty())
                return fail("port %d: an answer to nothing", p);
            const auto [write, line] = expected_[p].front();
            expected_[p].pop_front();
            ++lines[p];
            for (int i = 0; i < 8 && !write; ++i) {
                const uint32_t got = p < 2 ? top.line_o[i] : p == 2 ? top.answer0_o[i] : top.answer1_o[i];
                if (got != line[i] || top.answer_failed_o)
                    return fail("port %d: a line differs", p);
            }
        }
        return true;
    }

    bool idle() const {
        return !top.valid_i && !top.request_valid_i &&
               std::all_of(expected_.begin(), expected_.end(), [](const auto& each) { return each.empty(); });
    }

    // Lines of the whole memory, few enough to meet again; or lines that follow each other.
    bool sequential = false;

private:
    uint32_t next_line(int port) {
        if (sequential)
            return (0xF0000 + sequence_[port]++) & 0xFFFFF;
        return (random() % 256) * 0x3FDB5 & 0xFFFFF;
    }

    void tick() {
        for (int t = 0; t < ticks; ++t) {
            top.clk_i = t < ticks / 2;
            top.sdram_clk_i = (t + ticks - phase) % ticks < ticks / 2;
            top.tick_i = !top.tick_i;
            top.eval();
        }
        ++clocks;
    }

    bool fail(const char* what, int port) {
        std::printf(what, port);
        std::printf(", at clock %llu\n", (unsigned long long)clocks);
        return false;
    }

    std::mt19937 random{1};
    std::map<uint32_t, Line> memory_; // The chip's is 0 in the beginning.
    std::array<std::deque<std::pair<bool, Line>>, ports> expected_;
    std::array<uint64_t, 2> since_{};
    std::array<uint32_t, ports> sequence_{};
};

} // namespace

int main(int argc, char** argv) {
    Verilated::commandArgs(argc, argv);
    Bench bench;
    const int mixed = argc > 1 ? std::atoi(argv[1]) : 400000;
    std::mt19937 random(2);
    // All kinds of traffic: bursts of it, and holes.
    uint32_t asks = 0xF;
    uint64_t longest = 0; // while the screen is not urgent
    for (int i = 0; i < mixed; ++i) {
        if (i % 64 == 0) {
            asks = i < mixed / 2 ? 0xF : random() & 0xF;
            bench.top.urgent_i = i >= mixed / 2 && random() % 4 == 0;
        }
        if (!bench.clock(asks))
            return 1;
        if (i == 1000) // power-on
            bench.longest = 0;
        if (i == mixed / 2)
            longest = bench.longest;
    }
    for (const uint64_t lines : bench.lines)
        std::printf("%llu ", (unsigned long long)lines);
    std::printf("%llu\n", (unsigned long long)longest);

    const auto measure = [&](const char* name, uint32_t ports_asking, bool sequential, bool writes, bool urgent) {
        while (!bench.idle())
            bench.clock(0);
        bench.sequential = sequential;
        bench.writes = writes;
        bench.top.urgent_i = urgent;
        uint64_t before = 0, after = 0;
        for (const uint64_t lines : bench.lines)
            before += lines;
        const int clocks = 40000;
        for (int i = 0; i < clocks; ++i) {
            if (!bench.clock(ports_asking))
                return false;
        }
        for (const uint64_t lines : bench.lines)
            after += lines;
        std::printf("%s %.2f\n", name, double(clocks) / double(after - before));
        return true;
    };
    const bool right = measure("screen", 0b0001, true, false, true) && measure("core", 0b1100, false, false, false) &&
                       measure("reads", 0b1101, false, false, false) && measure("all", 0b1111, false, true, false);
    return right ? 0 : 1;
}
