// The dialect again, of a word that voxrt_word_encoder encoded. All pointers that were refused come out as 0x7FFFFFFF.
module voxrt_word_decoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  lod_words_i,  // As voxrt_word_encoder has it.
  input  logic [payload_bits(BlockBits, Lod):0] word_i,
  output logic [31:0]                           word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);

  always_comb begin
    if (Lod && lod_words_i && !word_i[PayloadBits]) word_o = {24'(word_i[BlockBits-1:0]), word_i[PayloadBits-1-:8]};
    else if (!word_i[PayloadBits]) word_o = 32'({word_i[BlockBits-1:0], 3'd1});
    else if (word_i[8]) word_o = 32'h7FFF_FFFF;
    else word_o = {24'hFF_FFFF, word_i[7:0]};
  end
endmodule
