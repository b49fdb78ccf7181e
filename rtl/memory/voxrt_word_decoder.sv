// Gives a word that voxrt_word_encoder has encoded in its dialect again, so that the processor reads what it wrote. All
// pointers that were refused come out as voxrt_pkg::RefusedWord.
module voxrt_word_decoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  lod_words_i,  // See voxrt_word_encoder.
  input  logic [payload_bits(BlockBits, Lod):0] word_i,
  output logic [                          31:0] word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);

  leaf_t leaf;
  material_t mean;

  assign leaf = word_i[$bits(leaf_t)-1:0];
  assign mean = word_i[PayloadBits-1-:$bits(material_t)];

  always_comb begin
    if (!word_i[PayloadBits]) word_o = pointer_word(24'(word_i[BlockBits-1:0]), mean, Lod && lod_words_i);
    else if (leaf.error) word_o = RefusedWord;
    else word_o = leaf_word(leaf.material);
  end
endmodule
