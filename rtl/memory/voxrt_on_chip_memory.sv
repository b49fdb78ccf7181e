// The octree memory in block RAM. Word 0 is in a register, all other words are in one of two forms. An access port
// writes and reads all words, and each lane has a read port.
//
// Forms: private copies (voxrt_private_memory), one per two lanes; or one memory in banks (voxrt_banked_memory), for
// scenes that would not fit twice.
//
// The access port is served at every clock and never waits; lanes keep at least half of their share of the memory. A word
// comes access_clocks(Banked ? BankedForm : PrivateForm) clocks after its address. A reset drops the requests of lanes,
// and no write.
module voxrt_on_chip_memory
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes     = 1,
  parameter int unsigned BlockBits = 12,
  parameter bit          Banked    = 1'b0,  // BankedForm, not PrivateForm.
  parameter bit          Lod       = 1'b0,
  parameter string       File      = ""     // See voxrt_octree_memory.
) (
  input logic clk_i,
  input logic rst_ni,
  // Report dialect, word addresses, any order, one access per clock; what is written beyond the memory is dropped.
  input logic access_i,
  input logic access_write_i,
  input logic [31:0] access_address_i,
  input logic [31:0] access_word_i,
  input logic lod_words_i,  // Words are of the dialect lod; only with Lod.
  output logic access_valid_o,  // access_word_o is what was read.
  output logic [31:0] access_word_o,
  output logic [payload_bits(BlockBits, Lod):0] first_word_o,  // Word 0.
  // Lanes: a word comes memory_clocks(Banked ? BankedForm : PrivateForm) clocks after its address, {block,
  // octant}, with ack_o or not.
  input logic [Lanes-1:0] read_i,
  input logic [BlockBits+2:0] address_i[Lanes],
  output logic [Lanes-1:0] ack_o,
  output logic [payload_bits(BlockBits, Lod):0] word_o[Lanes]
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned AddressBits = BlockBits + 3;
  localparam int unsigned Clocks = memory_clocks(Banked ? BankedForm : PrivateForm);

  logic [PayloadBits:0] encoded, encoded_q, read_back;
  logic [31:0] offset;
  logic [AddressBits-1:0] offset_q;
  logic access_q, write_q, first_q, in_memory_q;

  voxrt_word_encoder #(
    .BlockBits(BlockBits),
    .Lod      (Lod)
  ) u_encoder (
    .lod_words_i,
    .word_i(access_word_i),
    .word_o(encoded)
  );

  assign offset = access_address_i - 32'd1;

  always_ff @(posedge clk_i) begin
    access_q    <= access_i;
    write_q     <= access_write_i;
    encoded_q   <= encoded;
    offset_q    <= offset[AddressBits-1:0];
    first_q     <= access_address_i == '0;
    in_memory_q <= offset[31:AddressBits] == '0;
  end

  // Public, so that a simulation can set it.
  logic [PayloadBits:0] root_q  /* verilator public_flat_rw */;

  always_ff @(posedge clk_i) if (access_q && write_q && first_q) root_q <= encoded_q;

  assign first_word_o = root_q;

  if (Banked) begin : gen_banked
    voxrt_banked_memory #(
      .Lanes    (Lanes),
      .BlockBits(BlockBits),
      .Lod      (Lod)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .access_i        (access_q && in_memory_q),
      .access_write_i  (write_q),
      .access_address_i(offset_q),
      .access_word_i   (encoded_q),
      .access_word_o   (read_back),
      .read_i,
      .address_i,
      .ack_o,
      .word_o
    );
  end else begin : gen_private
    voxrt_private_memory #(
      .Lanes      (Lanes),
      .AddressBits(AddressBits),
      .PayloadBits(PayloadBits),
      .File       (File)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .access_i        (access_q && in_memory_q),
      .access_write_i  (write_q),
      .access_address_i(offset_q),
      .access_word_i   (encoded_q),
      .access_word_o   (read_back),
      .read_i,
      .address_i,
      .ack_o,
      .word_o
    );
  end

  // Reading.
  logic [Clocks-1:0] reads_q, first_reads_q;
  logic [31:0] decoded;

  always_ff @(posedge clk_i) begin
    reads_q       <= rst_ni ? {reads_q[Clocks-2:0], access_q && !write_q} : '0;
    first_reads_q <= {first_reads_q[Clocks-2:0], first_q};
  end

  voxrt_word_decoder #(
    .BlockBits(BlockBits),
    .Lod      (Lod)
  ) u_decoder (
    .lod_words_i,
    .word_i(first_reads_q[Clocks-1] ? root_q : read_back),
    .word_o(decoded)
  );

  assign access_valid_o = reads_q[Clocks-1];
  assign access_word_o  = decoded;
endmodule
