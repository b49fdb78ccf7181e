// Reads the root word of a frame, before the frame's rays: from word 0, where that is in a register, or from anywhere
// else in the memory, by the read port of lane 0, which is idle then. With it a scene may stand anywhere, and a frame
// may show another one by a register.
//
// start_i takes the address; valid_o is high for one clock, with root_o from then on. An address beyond the memory
// gives a leaf with an error, as a bad pointer does.
module voxrt_root
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits    = 12,
  parameter int unsigned MemoryClocks = 2,     // Clocks from an address to its word (memory_clocks): 2 .. 5.
  parameter bit          Lod          = 1'b0,
  parameter bit          ReadsFirst   = 1'b0   // Word 0 is read like all others, from block -1.
) (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  start_i,
  input  logic [                          31:0] address_i,       // Address of a word.
  input  logic [payload_bits(BlockBits, Lod):0] first_word_i,    // Word 0.
  output logic                                  valid_o,
  output logic [payload_bits(BlockBits, Lod):0] root_o,
  // Lane 0's port, as voxrt_octree_memory has it. Words that come before valid_o are not lane 0's.
  output logic                                  read_o,
  output logic [                 BlockBits+3:0] read_address_o,
  input  logic                                  ack_i,
  input  logic [payload_bits(BlockBits, Lod):0] word_i
);
  if (MemoryClocks < 2 || MemoryClocks > 5) $error("voxrt_root: MemoryClocks must be 2 to 5 clocks");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned AddressBits = BlockBits + 3;

  logic read_q, valid_q, beyond;
  logic [MemoryClocks-1:0] pending_q;
  logic [31:0] offset;
  logic [AddressBits:0] address_q;
  logic [PayloadBits:0] root_q;

  assign offset = address_i - 32'd1;
  // Word 0 counts as beyond too, if it is not read.
  assign beyond = offset[31:AddressBits] != '0 && !(ReadsFirst && address_i == '0);

  always_ff @(posedge clk_i) begin
    valid_q   <= 1'b0;
    read_q    <= 1'b0;
    pending_q <= {pending_q[MemoryClocks-2:0], read_q};
    if (pending_q[MemoryClocks-1]) begin
      read_q  <= !ack_i;
      valid_q <= ack_i;
      root_q  <= word_i;
    end
    if (start_i) begin
      address_q <= offset[AddressBits:0];
      read_q    <= !beyond;
      valid_q   <= beyond;
      root_q    <= address_i == '0 ? first_word_i : {1'b1, PayloadBits'(ErrorLeaf)};
    end
    if (!rst_ni) begin
      read_q    <= 1'b0;
      valid_q   <= 1'b0;
      pending_q <= '0;
    end
  end

  assign valid_o        = valid_q;
  assign root_o         = root_q;
  assign read_o         = read_q;
  assign read_address_o = address_q;
endmodule
