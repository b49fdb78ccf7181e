// Four ports on one SDRAM at once: what is read is what was written. Ends with 1 after a difference.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <random>

#include "Vsdram.h"
#include "verilated.h"

using Line = std::array<uint32_t, 8>;

int main() {
  Vsdram top;
  std::mt19937 random(1);
  std::map<uint32_t, Line> written;  // What each line holds.
  std::array<uint32_t, 2> asked{};   // By the ports of lines.
  std::array<bool, 2> under_way{}, writes{};
  std::array<uint32_t, 2> wanted{};  // By the core's ports: one line each at a time.
  std::array<bool, 2> waits{};
  uint64_t reads = 0, clocks = 0, core_reads = 0, longest = 0;
  std::array<uint64_t, 2> since{};

  auto tick = [&] {
    top.clk_i = 1;
    top.eval();
    top.sdram_clk_i = 1;  // A quarter later.
    top.eval();
    top.clk_i = 0;
    top.eval();
    top.sdram_clk_i = 0;
    top.eval();
    clocks++;
  };
  auto line_of = [&] { return uint32_t((random() % 64) * 0x3FDB5 & 0xFFFFF); };
  auto same = [](const auto& got, const Line& want) {
    for (int i = 0; i < 8; i++) {
      if (got[i] != want[i]) return false;
    }
    return true;
  };

  for (int i = 0; i < 4; i++) tick();
  top.rst_ni = 1;
  // All lines are written whole first, by port 1.
  bool filling = true;
  uint32_t filled = 0;
  while (clocks < 400000) {
    const uint32_t accepted = [&] {
      // Inputs change after a clock edge; ready is combinational.
      for (int p = 0; p < 2; p++) {
        if (under_way[p] || top.valid_i >> p & 1) continue;
        if (filling && p == 0) continue;
        const bool write = p == 1 && (filling || random() % 4 == 0);
        if (!filling && random() % 3 == 0) continue;
        asked[p] = filling ? filled * 0x3FDB5 & 0xFFFFF : line_of();
        writes[p] = write;
        top.line_i[p] = asked[p];
        top.write_i = (top.write_i & ~(1 << p)) | write << p;
        if (write) {
          top.mask_i[1] = filling ? 0xFFFF : random() & 0xFFFF;
          for (int i = 0; i < 8; i++) top.data_i[i] = uint32_t(random());
        }
        top.valid_i |= 1 << p;
        since[p] = clocks;
      }
      for (int p = 0; p < 2 && !filling; p++) {
        if (waits[p] || top.request_valid_i >> p & 1) continue;
        wanted[p] = line_of();
        top.request_address_i[p] = wanted[p] * 32;
        top.request_valid_i |= 1 << p;
      }
      top.eval();
      return uint32_t(top.valid_i & top.ready_o) | uint32_t(top.request_valid_i & top.request_ready_o) << 2;
    }();
    // A write under way may come before or after a read that waits: such a read is not compared.
    tick();
    for (int p = 0; p < 2; p++) {
      if (accepted >> p & 1) {
        top.valid_i &= ~(1 << p);
        under_way[p] = true;
        if (writes[p]) {
          Line& line = written[asked[p]];
          for (int i = 0; i < 16; i++) {
            if (!(top.mask_i[1] >> i & 1)) continue;
            const uint32_t bits = 0xFFFFu << (i % 2 * 16);
            line[i / 2] = (line[i / 2] & ~bits) | (top.data_i[i / 2] & bits);
          }
          for (int q = 0; q < 2; q++) {
            if ((waits[q] || top.request_valid_i >> q & 1) && wanted[q] == asked[p]) wanted[q] = ~0u;
          }
        }
      }
      if (accepted >> (2 + p) & 1) {
        top.request_valid_i &= ~(1 << p);
        waits[p] = true;
      }
    }
    for (int p = 0; p < 2; p++) {
      if (top.done_o >> p & 1) {
        under_way[p] = false;
        longest = std::max(longest, clocks - since[p]);
        if (filling && ++filled == 64) filling = false;
        if (!writes[p]) {
          reads++;
          if (!same(top.line_o, written.at(asked[p]))) {
            std::printf("line %x differs\n", asked[p]);
            return 1;
          }
        }
      }
      if (top.answer_valid_o >> p & 1) {
        waits[p] = false;
        core_reads++;
        const bool right = p ? wanted[p] == ~0u || same(top.answer1_o, written.at(wanted[p]))
                             : wanted[p] == ~0u || same(top.answer0_o, written.at(wanted[p]));
        if (!right || top.answer_failed_o) {
          std::printf("the core's line %x differs\n", wanted[p]);
          return 1;
        }
      }
    }
  }
  std::printf("%llu %llu %llu\n", (unsigned long long)reads, (unsigned long long)core_reads,
              (unsigned long long)longest);
  return 0;
}
