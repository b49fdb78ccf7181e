// True dual-port block RAM with output registers: port A reads or writes, port B reads.
module voxrt_block_ram #(
  parameter int unsigned Width = 18,
  parameter int unsigned Depth = 1024
) (
  input  logic                     clk_i,
  input  logic                     a_read_i,
  input  logic                     a_write_i,
  input  logic [$clog2(Depth)-1:0] a_row_i,
  input  logic [        Width-1:0] a_data_i,
  output logic [        Width-1:0] a_data_o,  // Two clocks after a_read_i.
  input  logic                     b_read_i,
  input  logic [$clog2(Depth)-1:0] b_row_i,
  output logic [        Width-1:0] b_data_o
);
  // Public, so that a simulation can fill a large memory at once.
  logic [Width-1:0] data_q[Depth]  /* verilator public_flat_rw */;
  logic [Width-1:0] a_read_q, a_out_q, b_read_q, b_out_q;

  always_ff @(posedge clk_i) begin
    if (a_write_i) data_q[a_row_i] <= a_data_i;
    else if (a_read_i) a_read_q <= data_q[a_row_i];
    a_out_q <= a_read_q;
  end

  always_ff @(posedge clk_i) begin
    if (b_read_i) b_read_q <= data_q[b_row_i];
    b_out_q <= b_read_q;
  end

  assign a_data_o = a_out_q;
  assign b_data_o = b_out_q;
endmodule
