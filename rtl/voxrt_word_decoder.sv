// The report dialect again, of a word that voxrt_word_encoder encoded. All pointers that were refused come out as
// 0x7FFFFFFF.
module voxrt_word_decoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12
) (
  input  logic [payload_bits(BlockBits):0] word_i,
  output logic [31:0]                      word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits);

  always_comb begin
    if (!word_i[PayloadBits]) word_o = 32'({word_i[BlockBits-1:0], 3'd1});
    else if (word_i[8]) word_o = 32'h7FFF_FFFF;
    else word_o = {24'hFF_FFFF, word_i[7:0]};
  end
endmodule
