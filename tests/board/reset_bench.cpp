// Prints the reset at each clock; the argument says when the PLL is locked, by a 0 or 1 per clock.
#include <cstdio>

#include "Vtop.h"
#include "verilated.h"

int main(int, char** arguments) {
    VerilatedContext context;
    Vtop reset{&context};
    reset.eval();
    for (const char* locked = arguments[1]; *locked != 0; ++locked) {
        reset.locked_i = *locked == '1';
        reset.clk_i = 1;
        reset.eval();
        reset.clk_i = 0;
        reset.eval();
        std::putchar(reset.rst_no ? '1' : '0');
    }
}
