// First in, first out, of any depth that is a power of two. Data in distributed memory, read combinationally.
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
  if (Width < 1) begin : gen_bad_width
    $error("voxrt_fifo: Width must be 1 bit or more");
  end
  if (Depth < 2 || 2 ** $clog2(Depth) != Depth) begin : gen_bad_depth
    $error("voxrt_fifo: Depth must be a power of two, 2 or more");
  end

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
