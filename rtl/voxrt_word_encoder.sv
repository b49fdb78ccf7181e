// A memory word of the report dialect in the form that the lanes read (see voxrt_pkg::payload_bits): a pointer is
// checked here, once, and not in every lane.
module voxrt_word_encoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12
) (
  input  logic [31:0]                      word_i,
  output logic [payload_bits(BlockBits):0] word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits);

  always_comb begin
    word_o = '0;
    if (word_i[31]) begin
      word_o[PayloadBits] = 1'b1;
      word_o[7:0]         = word_i[7:0];
    end else if (word_i[2:0] != 3'd1 || word_i[30:BlockBits+3] != '0) begin
      // Into the middle of a block, or out of the memory.
      word_o[PayloadBits] = 1'b1;
      word_o[8]           = 1'b1;
    end else begin
      word_o[BlockBits-1:0] = word_i[BlockBits+2:3];
    end
  end
endmodule
