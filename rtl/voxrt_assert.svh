// Assertions. A module that has some includes this file; its folder belongs to the include folders of each tool.
//
// `VOXRT_ASSERT(Name, Property) stands among the items of a module. The property is an expression that holds at each
// rising edge of the clock, but not in a reset, and not before the first one. Simulators and proofs check it. In
// synthesis, where SYNTHESIS is defined, nothing is left of it. It is a block with a register of its own and no
// concurrent assertion, because yosys reads only the former.
`ifndef VOXRT_ASSERT_SVH
`define VOXRT_ASSERT_SVH

`ifdef SYNTHESIS
`define VOXRT_ASSERT(Name, Property, Clk = clk_i, ResetN = rst_ni)
`define VOXRT_ASSERT_STABLE(Name, Valid, Ready, Data, Clk = clk_i, ResetN = rst_ni)
`else
`define VOXRT_ASSERT(Name, Property, Clk = clk_i, ResetN = rst_ni)                            \
  if (1) begin : gen_assert_``Name                                                            \
    logic reset_seen_q = 1'b0;                                                                \
    always_ff @(posedge Clk) begin                                                            \
      reset_seen_q <= reset_seen_q || !ResetN;                                                \
      Name : assert (!ResetN || !reset_seen_q || (Property)) else $error("%m does not hold"); \
    end                                                                                       \
  end

// What a stream offers stays the same until it is taken.
`define VOXRT_ASSERT_STABLE(Name, Valid, Ready, Data, Clk = clk_i, ResetN = rst_ni)           \
  if (1) begin : gen_stable_``Name                                                            \
    logic stalled_q = 1'b0;                                                                   \
    logic [$bits(Data)-1:0] offer_q;                                                          \
    always_ff @(posedge Clk) begin                                                            \
      stalled_q <= ResetN && Valid && !Ready;                                                 \
      offer_q   <= Data;                                                                      \
      Name : assert (!ResetN || !stalled_q || (Valid && offer_q == Data))                     \
        else $error("%m: an offer changed before it was taken");                              \
    end                                                                                       \
  end
`endif

`endif
