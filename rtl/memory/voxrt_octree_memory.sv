// The octree memory, with a read port per lane, in one of three forms: private copies (voxrt_private_memory), one per two
// lanes; one memory in banks (voxrt_banked_memory), for scenes that would not fit twice; or an external memory behind
// caches (voxrt_cached_memory), for scenes that do not fit at all.
//
// Private and banked: word 0 is in a register. The access port writes and reads all words. It is served at every clock
// and never waits; lanes keep at least half of their share of the memory. A reset drops the requests of lanes, and no
// access.
//
// Cached: a frame's root may be read from ready_o on. The access port drops what is written and reads 0: any master of
// the external memory writes it.
module voxrt_octree_memory
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes      = 1,
  parameter int unsigned BlockBits  = 12,
  parameter int unsigned MemoryForm = PrivateForm,
  parameter int unsigned L1SetBits  = 5,
  parameter int unsigned L2SetBits  = 9,
  parameter bit          Lod        = 1'b0,
  // What private copies hold from the beginning, for $readmemh: row a has word 1 + a, as voxrt_word_encoder encodes it.
  parameter string       File       = ""
) (
  input logic clk_i,
  input logic rst_ni,
  // Words are of the report dialect or, with lod_words_i, of the dialect lod. Addresses are of words, in any order, one
  // per clock. What is written beyond the memory is dropped.
  input logic access_i,
  input logic access_write_i,
  input logic [31:0] access_address_i,
  input logic [31:0] access_word_i,
  output logic access_valid_o,  // access_word_o is what was read.
  output logic [31:0] access_word_o,
  output logic [payload_bits(BlockBits, Lod):0] first_word_o,  // Word 0, if not cached.
  // Lanes: a word comes memory_clocks(MemoryForm) clocks after its address, {block, octant}, with ack_o or not. In the
  // cached form, word 0 is in block -1.
  input logic [Lanes-1:0] read_i,
  input logic [BlockBits+3:0] address_i[Lanes],
  output logic [Lanes-1:0] ack_o,
  output logic [payload_bits(BlockBits, Lod):0] word_o[Lanes],
  // Lod: whether the words that are written, or, cached, read in a frame, are of the dialect lod.
  input logic lod_words_i,
  // Cached: see voxrt_cached_memory.
  input logic bus_rst_ni,
  input logic start_i,
  output logic ready_o,
  input logic flush_i,
  input logic [31:0] base_i,
  output axi_read_request_t axi_o[BusPorts],
  input axi_read_response_t axi_i[BusPorts],
  output memory_events_t events_o
);
  localparam int unsigned AddressBits = BlockBits + 3;

  if (MemoryForm != PrivateForm && File != "")
    $error("voxrt_octree_memory: only private copies can hold words from the beginning");

  if (MemoryForm == CachedForm) begin : gen_cached
    logic unused_access;

    assign unused_access = &{access_address_i, access_word_i, access_write_i};
    assign access_word_o = '0;
    assign first_word_o  = '0;
    always_ff @(posedge clk_i) access_valid_o <= rst_ni && access_i && !access_write_i;

    voxrt_cached_memory #(
      .Lanes    (Lanes),
      .BlockBits(BlockBits),
      .L1SetBits(L1SetBits),
      .L2SetBits(L2SetBits),
      .Lod      (Lod)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .bus_rst_ni,
      .start_i,
      .ready_o,
      .flush_i,
      .base_i,
      .lod_words_i,
      .read_i,
      .address_i,
      .ack_o,
      .word_o,
      .axi_o,
      .axi_i,
      .events_o
    );
  end else begin : gen_on_chip
    logic [AddressBits-1:0] address[Lanes];
    logic unused_external;

    always_comb begin
      unused_external = &{bus_rst_ni, flush_i, base_i};
      for (int unsigned p = 0; p < BusPorts; p++) unused_external &= ^axi_i[p];
      for (int unsigned i = 0; i < Lanes; i++) begin
        address[i] = address_i[i][AddressBits-1:0];
        unused_external &= address_i[i][AddressBits];
      end
    end

    assign ready_o  = start_i;
    assign axi_o    = '{default: '0};
    assign events_o = '0;

    voxrt_on_chip_memory #(
      .Lanes    (Lanes),
      .BlockBits(BlockBits),
      .Banked   (MemoryForm == BankedForm),
      .Lod      (Lod),
      .File     (File)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .access_i,
      .access_write_i,
      .access_address_i,
      .access_word_i,
      .lod_words_i,
      .access_valid_o,
      .access_word_o,
      .first_word_o,
      .read_i,
      .address_i(address),
      .ack_o,
      .word_o
    );
  end
endmodule
