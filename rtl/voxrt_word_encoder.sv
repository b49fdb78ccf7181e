// A memory word of the report dialect, or of the dialect lod, in the form that the lanes read (see
// voxrt_pkg::payload_bits): a pointer is checked here, once, and not in every lane.
module voxrt_word_encoder
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  lod_words_i,  // The word is of the dialect lod; only with Lod.
  input  logic [31:0]                           word_i,
  output logic [payload_bits(BlockBits, Lod):0] word_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);

  logic        leaf;
  logic [30:0] pointer;  // Of the report dialect.
  logic [ 7:0] mean;

  if (Lod) begin : gen_lod
    // {block, mean material} or FFFFFFmm.
    assign leaf    = lod_words_i ? word_i[31:8] == '1 : word_i[31];
    assign pointer = lod_words_i ? {4'd0, word_i[31:8], 3'd1} : word_i[30:0];
    assign mean    = lod_words_i ? word_i[7:0] : '0;
  end else begin : gen_report
    logic unused_lod;
    assign unused_lod = lod_words_i;
    assign leaf       = word_i[31];
    assign pointer    = word_i[30:0];
    assign mean       = '0;
  end

  always_comb begin
    word_o = '0;
    if (leaf) begin
      word_o[PayloadBits] = 1'b1;
      word_o[7:0]         = word_i[7:0];
    end else if (pointer[2:0] != 3'd1 || pointer[30:BlockBits+3] != '0) begin
      // Into the middle of a block, or out of the memory.
      word_o[PayloadBits] = 1'b1;
      word_o[8]           = 1'b1;
    end else begin
      word_o[BlockBits-1:0] = pointer[BlockBits+2:3];
      if (Lod) word_o[PayloadBits-1-:8] = mean;
    end
  end
endmodule
