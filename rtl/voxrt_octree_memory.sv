// The octree memory: the root in a register, all other words in one of two forms, a port that writes and reads it, and
// a read port for each lane.
//
// Forms: private copies (voxrt_private_memory), two lanes a copy; or one memory in banks (voxrt_banked_memory), for
// scenes that would not fit twice.
module voxrt_octree_memory
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes       = 1,
  parameter  int unsigned BlockBits   = 12,
  parameter  bit          Banked      = 1'b0,
  localparam int unsigned PayloadBits = payload_bits(BlockBits)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  // Report dialect, word addresses, any order, one access a clock; what is written beyond the memory is dropped.
  input  logic                 access_i,
  input  logic                 access_write_i,
  input  logic [         31:0] access_address_i,
  input  logic [         31:0] access_word_i,
  output logic                 access_valid_o,             // access_word_o is what was read.
  output logic [         31:0] access_word_o,
  output logic [PayloadBits:0] root_o,
  // Lanes: a word comes memory_clocks(Banked) clocks after its address, with ack_o or not.
  input  logic [    Lanes-1:0] read_i,
  input  logic [BlockBits-1:0] block_i          [Lanes],
  input  logic [          2:0] octant_i         [Lanes],
  output logic [    Lanes-1:0] ack_o,
  output logic [PayloadBits:0] word_o           [Lanes]
);
  localparam int unsigned RowBits = BlockBits + 3;
  localparam int unsigned Clocks = memory_clocks(Banked);

  logic [PayloadBits:0] encoded, read_back;
  logic [         31:0] row;
  logic                 is_root, in_memory;

  voxrt_word_encoder #(
    .BlockBits(BlockBits)
  ) u_encoder (
    .word_i(access_word_i),
    .word_o(encoded)
  );

  assign row     = access_address_i - 32'd1;
  assign is_root = access_address_i == '0;
  assign in_memory = row[31:RowBits] == '0;

  // Public, so that a simulation can set it.
  logic [PayloadBits:0] root_q  /* verilator public_flat_rw */;

  always_ff @(posedge clk_i) if (access_i && access_write_i && is_root) root_q <= encoded;

  assign root_o = root_q;

  if (Banked) begin : gen_banked
    voxrt_banked_memory #(
      .Lanes    (Lanes),
      .BlockBits(BlockBits)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .access_i      (access_i && in_memory),
      .access_write_i,
      .access_row_i  (row[RowBits-1:0]),
      .access_word_i (encoded),
      .access_word_o (read_back),
      .read_i,
      .block_i,
      .octant_i,
      .ack_o,
      .word_o
    );
  end else begin : gen_private
    voxrt_private_memory #(
      .Lanes    (Lanes),
      .BlockBits(BlockBits)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .access_i      (access_i && in_memory),
      .access_write_i,
      .access_row_i  (row[RowBits-1:0]),
      .access_word_i (encoded),
      .access_word_o (read_back),
      .read_i,
      .block_i,
      .octant_i,
      .ack_o,
      .word_o
    );
  end

  // Reading.
  logic [Clocks-1:0] reads_q, root_reads_q;
  logic [      31:0] decoded;

  always_ff @(posedge clk_i) begin
    reads_q        <= rst_ni ? {reads_q[Clocks-2:0], access_i && !access_write_i} : '0;
    root_reads_q <= {root_reads_q[Clocks-2:0], is_root};
  end

  voxrt_word_decoder #(
    .BlockBits(BlockBits)
  ) u_decoder (
    .word_i(root_reads_q[Clocks-1] ? root_q : read_back),
    .word_o(decoded)
  );

  assign access_valid_o = reads_q[Clocks-1];
  assign access_word_o  = decoded;
endmodule
