// Lines on their way into the caches of a few lanes (voxrt_l1_cache). The L2 gives a whole line at once, but a cache
// writes two words per clock: so whole lines come in at any clock, and two words per clock go out, in order. A line may
// go to several of the lanes at once.
`include "voxrt_assert.svh"

module voxrt_line_queue #(
  parameter int unsigned Lanes    = 2,   // Lanes that share the queue: 1 or more.
  parameter int unsigned SetBits  = 5,   // Their caches have 2**SetBits sets: 1 or more.
  parameter int unsigned WordBits = 14,  // Bits of a word as lanes read it: 1 or more.
  parameter int unsigned Depth    = 16   // Lines that the lanes ask for at a time, together: a power of two, 2 or more.
) (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic [  Lanes-1:0]               valid_i,    // Which lanes a line comes for.
  input  logic [SetBits-1:0]               set_i,
  input  logic [        7:0][WordBits-1:0] words_i,
  output logic [  Lanes-1:0]               valid_o,    // For four clocks per line.
  output logic [SetBits-1:0]               set_o,
  output logic [        1:0]               quarter_o,
  output logic [        1:0][WordBits-1:0] pair_o      // Words 2 * quarter_o and the next.
);
  if (Lanes < 1) $error("voxrt_line_queue: Lanes must be 1 or more");
  if (SetBits < 1) $error("voxrt_line_queue: SetBits must be 1 bit or more");
  if (WordBits < 1) $error("voxrt_line_queue: WordBits must be 1 bit or more");
  if (Depth < 2 || 2 ** $clog2(Depth) != Depth) $error("voxrt_line_queue: Depth must be a power of two, 2 or more");

  logic valid, ready;
  logic [Lanes-1:0] lanes;
  logic [7:0][WordBits-1:0] words;
  logic [1:0] quarter_q;

  voxrt_fifo #(
    .Width(Lanes + SetBits + 8 * WordBits),
    .Depth(Depth)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .valid_i(valid_i != '0),
    .ready_o(ready),
    .data_i ({valid_i, set_i, words_i}),
    .valid_o(valid),
    .ready_i(quarter_q == 2'd3),
    .data_o ({lanes, set_o, words})
  );

  always_ff @(posedge clk_i) begin
    if (valid) quarter_q <= quarter_q + 1'b1;
    if (!rst_ni) quarter_q <= '0;
  end

  assign valid_o   = valid ? lanes : '0;
  assign quarter_o = quarter_q;
  assign pair_o    = {words[{quarter_q, 1'b1}], words[{quarter_q, 1'b0}]};

  `VOXRT_ASSERT(QueueHoldsLine, valid_i == '0 || ready)
endmodule
