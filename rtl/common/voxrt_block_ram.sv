// True dual-port block RAM with output registers: port A reads or writes, port B reads.
//
// Use it for a memory that two readers share, or that is too deep for distributed memory, where a word may come two
// clocks after its address. Synthesis knows such a memory by the way it is written: here that way stands once.
//
// Where port B reads a row while port A writes it, the word read is undefined: the lanes work with any word, and what
// is read later is right. (A simulation reads the old word.)
module voxrt_block_ram #(
  parameter int unsigned Width = 18,    // Bits: 1 or more.
  parameter int unsigned Depth = 1024,  // Rows: 2 or more.
  parameter string       File  = ""     // What it holds from the beginning, for $readmemh.
) (
  input  logic                     clk_i,
  input  logic                     a_read_i,
  input  logic                     a_write_i,
  input  logic [$clog2(Depth)-1:0] a_row_i,
  input  logic [        Width-1:0] a_data_i,
  output logic [        Width-1:0] a_data_o,   // Two clocks after a_read_i.
  input  logic                     b_read_i,
  input  logic [$clog2(Depth)-1:0] b_row_i,
  output logic [        Width-1:0] b_data_o
);
  if (Width < 1) $error("voxrt_block_ram: Width must be 1 bit or more");
  if (Depth < 2) $error("voxrt_block_ram: Depth must be 2 rows or more");

  // Without no_rw_check, yosys would build the memory twice. Public, so that a simulation can fill it at once.
  (* no_rw_check *)
  logic [Width-1:0] data_q[Depth]  /* verilator public_flat_rw */;
  logic [Width-1:0] a_read_q, a_out_q, b_read_q, b_out_q;

  if (File != "") begin : gen_content
    initial $readmemh(File, data_q);
  end

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
