// Copies the boot scene after a reset of so many clocks, and prints the lines: eight words each.
#include <cstdio>
#include <cstdlib>

#include "Vtop.h"
#include "verilated.h"

int main(int, char** arguments) {
    VerilatedContext context;
    Vtop boot{&context};
    auto clock = [&] {
        boot.clk_i = 1;
        boot.eval();
        boot.clk_i = 0;
        boot.eval();
    };
    boot.ready_i = 1;
    boot.eval();
    for (int clocks = std::atoi(arguments[1]); clocks > 0; --clocks)
        clock();
    boot.rst_ni = 1;
    boot.eval();
    while (boot.busy_o) {
        boot.done_i = 0;
        if (boot.valid_o) {
            for (int word = 0; word < 8; ++word)
                std::printf("%08x ", boot.data_o[word]);
            std::printf("%u\n", boot.line_o);
            clock();
            boot.done_i = 1;
        }
        clock();
    }
}
