// The octree memory: blocks of eight words, a load port, and a read port for each lane. Two lanes share a copy of the
// memory, one at each port of its block RAMs.
//
// Words are kept as the lanes want them, so that checking a pointer costs nothing in a lane: bit PayloadBits set is a
// leaf of material [7:0], or an error where [8] is set; clear is a pointer to block [BlockBits-1:0]. A memory address
// 1 + 8 * block + octant stands in row {block, octant}. Word 0, the root, is kept in a register.
//
// A word comes two clocks after its address, with ack_o; without where the load port wrote at that time, so that
// loading while rays are traced harms nothing but the picture.
module voxrt_octree_memory
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes       = 1,
  parameter  int unsigned BlockBits   = 12,
  localparam int unsigned PayloadBits = payload_bits(BlockBits)
) (
  input  logic                 clk_i,
  // Load port: report dialect, any order; addresses beyond the memory are dropped.
  input  logic                 load_valid_i,
  input  logic [         31:0] load_address_i,
  input  logic [         31:0] load_word_i,
  output logic [PayloadBits:0] root_o,
  // Read ports.
  input  logic [    Lanes-1:0] read_i,
  input  logic [BlockBits-1:0] block_i       [Lanes],
  input  logic [          2:0] octant_i      [Lanes],
  output logic [    Lanes-1:0] ack_o,
  output logic [PayloadBits:0] word_o        [Lanes]
);
  localparam int unsigned RowBits = BlockBits + 3;
  localparam int unsigned Copies = (Lanes + 1) / 2;

  logic [PayloadBits:0] load_word;
  logic [         31:0] load_row;
  logic                 write;

  // Report dialect to the form kept here.
  always_comb begin
    load_word = '0;
    if (load_word_i[31]) begin
      load_word[PayloadBits] = 1'b1;
      load_word[7:0]         = load_word_i[7:0];
    end else if (load_word_i[2:0] != 3'd1 || load_word_i[30:RowBits] != '0) begin
      load_word[PayloadBits] = 1'b1;
      load_word[8]           = 1'b1;
    end else begin
      load_word[BlockBits-1:0] = load_word_i[RowBits-1:3];
    end
  end

  assign load_row = load_address_i - 32'd1;
  assign write    = load_valid_i && load_row[31:RowBits] == '0;

  // Public, so that a simulation can fill a large memory at once.
  logic [PayloadBits:0] root_q  /* verilator public_flat_rw */;

  always_ff @(posedge clk_i) if (load_valid_i && load_address_i == '0) root_q <= load_word;

  assign root_o = root_q;

  logic [Lanes-1:0] read1_q, ack_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned i = 0; i < Lanes; i++) read1_q[i] <= read_i[i] && !(write && i % 2 == 0);
    ack_q <= read1_q;
  end

  assign ack_o = ack_q;

  for (genvar c = 0; c < Copies; c++) begin : gen_copy
    logic                 b_read;
    logic [  RowBits-1:0] b_row;
    logic [PayloadBits:0] b_word;

    if (2 * c + 1 < Lanes) begin : gen_b
      assign b_read          = read_i[2*c+1];
      assign b_row           = {block_i[2*c+1], octant_i[2*c+1]};
      assign word_o[2*c+1]   = b_word;
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
      .a_read_i (read_i[2*c]),
      .a_write_i(write),
      .a_row_i  (write ? load_row[RowBits-1:0] : {block_i[2*c], octant_i[2*c]}),
      .a_data_i (load_word),
      .a_data_o (word_o[2*c]),
      .b_read_i (b_read),
      .b_row_i  (b_row),
      .b_data_o (b_word)
    );
  end
endmodule
