// The octree memory as private copies, for the shortest way from address to word: two lanes share a copy, one at each
// port of its block RAMs. A word comes two clocks after its address.
//
// Address 1 + 8 * block + octant stands in row {block, octant}; word 0, the root, is elsewhere (voxrt_octree_memory).
//
// The access port writes to all copies and reads the first one, by port A; a lane that reads there at that time gets
// no ack_o and asks again. So loading while rays are traced harms nothing but the picture.
module voxrt_private_memory
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes       = 1,
  parameter  int unsigned BlockBits   = 12,
  parameter  int unsigned PayloadBits = payload_bits(BlockBits),
  localparam int unsigned RowBits     = BlockBits + 3
) (
  input  logic                 clk_i,
  input  logic                 access_i,
  input  logic                 access_write_i,
  input  logic [  RowBits-1:0] access_row_i,
  input  logic [PayloadBits:0] access_word_i,
  output logic [PayloadBits:0] access_word_o,              // Two clocks later.
  input  logic [    Lanes-1:0] read_i,
  input  logic [BlockBits-1:0] block_i            [Lanes],
  input  logic [          2:0] octant_i           [Lanes],
  output logic [    Lanes-1:0] ack_o,
  output logic [PayloadBits:0] word_o             [Lanes]
);
  localparam int unsigned Copies = (Lanes + 1) / 2;

  logic [Lanes-1:0] read1_q, ack_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned i = 0; i < Lanes; i++) read1_q[i] <= read_i[i] && !(access_i && i % 2 == 0);
    ack_q <= read1_q;
  end

  assign ack_o         = ack_q;
  assign access_word_o = word_o[0];

  for (genvar c = 0; c < Copies; c++) begin : gen_copy
    logic                 b_read;
    logic [  RowBits-1:0] b_row;
    logic [PayloadBits:0] b_word;

    if (2 * c + 1 < Lanes) begin : gen_b
      assign b_read        = read_i[2*c+1];
      assign b_row         = {block_i[2*c+1], octant_i[2*c+1]};
      assign word_o[2*c+1] = b_word;
    end else begin : gen_no_b
      logic unused_b_word;
      assign b_read        = 1'b0;
      assign b_row         = '0;
      assign unused_b_word = ^b_word;
    end

    voxrt_block_ram #(
      .Width(PayloadBits + 1),
      .Depth(2 ** RowBits)
    ) u_ram (
      .clk_i,
      .a_read_i (read_i[2*c] || access_i),
      .a_write_i(access_i && access_write_i),
      .a_row_i  (access_i ? access_row_i : {block_i[2*c], octant_i[2*c]}),
      .a_data_i (access_word_i),
      .a_data_o (word_o[2*c]),
      .b_read_i (b_read),
      .b_row_i  (b_row),
      .b_data_o (b_word)
    );
  end
endmodule
