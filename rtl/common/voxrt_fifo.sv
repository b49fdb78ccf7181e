// A queue between two modules that work at different times: first in, first out.
//
// Use it where a writer must go on while the reader waits. valid_o and ready_o depend on registers alone, so it also
// cuts the paths of both in two, forwards for valid and backwards for ready. Its data are in distributed memory and are
// read in the same clock, so it suits some dozens of words; more belong into voxrt_block_ram. A queue of one word is
// voxrt_stream_register.
`include "voxrt_assert.svh"

module voxrt_fifo #(
  parameter int unsigned Width = 8,  // Bits: 1 or more.
  parameter int unsigned Depth = 16  // Words: a power of two, 2 or more.
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [Width-1:0] data_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [Width-1:0] data_o
);
  if (Width < 1) $error("voxrt_fifo: Width must be 1 bit or more");
  if (Depth < 2 || 2 ** $clog2(Depth) != Depth) $error("voxrt_fifo: Depth must be a power of two, 2 or more");

  localparam int unsigned IndexBits = $clog2(Depth);

  logic [Width-1:0] data_q[Depth];
  logic [IndexBits:0] write_q, read_q;

  assign ready_o = write_q != (read_q ^ {1'b1, IndexBits'(0)});
  assign valid_o = write_q != read_q;
  assign data_o  = data_q[read_q[IndexBits-1:0]];

  always_ff @(posedge clk_i) begin
    if (valid_i && ready_o) begin
      data_q[write_q[IndexBits-1:0]] <= data_i;
      write_q                        <= write_q + 1'b1;
    end
    if (valid_o && ready_i) read_q <= read_q + 1'b1;
    if (!rst_ni) begin
      write_q <= '0;
      read_q  <= '0;
    end
  end

  `VOXRT_ASSERT(CountWithinDepth, (IndexBits + 1)'(write_q - read_q) <= (IndexBits + 1)'(Depth))
endmodule
