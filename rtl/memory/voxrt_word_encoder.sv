// Gives a memory word of the report dialect, or of the dialect lod, the form that the lanes read (voxrt_pkg::leaf_t).
// It checks a pointer once, when the word is written or fetched, so that no lane needs to check it at each read.
module voxrt_word_encoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  lod_words_i,  // The word is of the dialect lod; only with Lod.
  input  logic [                          31:0] word_i,
  output logic [payload_bits(BlockBits, Lod):0] word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);

  logic lod_words;
  logic [30:0] pointer;

  assign lod_words = Lod && lod_words_i;
  assign pointer   = pointer_of(word_i, lod_words);

  always_comb begin
    word_o = '0;
    if (is_leaf(word_i, lod_words)) begin
      word_o[PayloadBits]           = 1'b1;
      word_o[$bits(material_t)-1:0] = material_of(word_i);
    end else if (pointer[2:0] != 3'd1 || pointer[30:BlockBits+3] != '0) begin
      // The pointer leads into the middle of a block, or out of the memory: ErrorLeaf, whose highest bit is the error.
      word_o[PayloadBits]     = 1'b1;
      word_o[$bits(leaf_t)-1] = 1'b1;
    end else begin
      word_o[BlockBits-1:0] = pointer[BlockBits+2:3];
      if (lod_words) word_o[PayloadBits-1-:$bits(material_t)] = material_of(word_i);
    end
  end
endmodule
