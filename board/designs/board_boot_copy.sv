// Copies the scene of the bitstream from block RAM into the SDRAM, once, after a reset.
//
// Row a of the block RAM has word 1 + a of the octree, as voxrt_word_encoder encodes it: block b goes to line 1 + b.
module board_boot_copy
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,  // 2**BlockBits blocks: 5 .. 19.
  parameter string       File      = ""   // For $readmemh; "": nothing.
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  output logic         busy_o,
  // A port of the SDRAM's arbiter.
  output logic         valid_o,
  input  logic         ready_i,
  output logic [ 19:0] line_o,
  output logic [255:0] data_o,
  input  logic         done_i
);
  if (BlockBits < 5 || BlockBits > 19) $error("board_boot_copy: BlockBits must be 5 to 19 bits");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, 1'b0);

  typedef enum logic [1:0] {
    Fetch,
    Line,
    Wait,
    Idle
  } state_e;

  (* no_rw_check *)
  logic [PayloadBits:0] rows_q[8*2**BlockBits]  /* verilator public_flat_rw */;
  logic [PayloadBits:0] read_q, row_q;

  if (File != "") begin : gen_content
    initial $readmemh(File, rows_q);
  end

  state_e state_q;
  logic [BlockBits-1:0] block_q;
  logic [3:0] step_q;
  logic [BlockBits+2:0] place, place_q;
  logic [31:0] word;
  logic [255:0] data_q;

  // Each row is written back as it was read: without a write port it would be a ROM to yosys, which lays ROMs out in a
  // way that voxrt.board.designs.base_design does not know. Step 0 writes nothing, and the reset holds step 0: read_q
  // is not the row yet, and a row that is read and written at once would be undefined.
  always_ff @(posedge clk_i) begin
    place_q <= place;
    read_q  <= rows_q[place];
    row_q   <= read_q;
    if (state_q == Fetch && step_q != '0) rows_q[place_q] <= read_q;
  end

  voxrt_word_decoder #(
    .BlockBits(BlockBits)
  ) u_decoder (
    .lod_words_i(1'b0),
    .word_i     (row_q),
    .word_o     (word)
  );

  assign place   = {block_q, step_q[2:0]};
  assign busy_o  = state_q != Idle;
  assign valid_o = state_q == Line;
  assign line_o  = 20'(block_q) + 20'd1;
  assign data_o  = state_q == Line ? data_q : '0;

  always_ff @(posedge clk_i) begin
    step_q <= step_q + 1'b1;
    unique case (state_q)
      Fetch: begin
        data_q <= {word, data_q[255:32]};
        if (step_q == 4'd9) state_q <= Line;
      end
      Line: if (ready_i) state_q <= Wait;
      Wait: begin
        step_q <= '0;
        if (done_i) begin
          block_q <= block_q + 1'b1;
          state_q <= block_q == '1 ? Idle : Fetch;
        end
      end
      default: ;
    endcase
    if (!rst_ni) begin
      state_q <= Fetch;
      block_q <= '0;
      step_q  <= '0;
    end
  end
endmodule
