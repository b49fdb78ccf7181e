// Reads lines of the octree, which are its blocks of eight words, from an external memory, in order, over two AXI ports
// in turn. Words get the form that lanes read, and pointers are checked, once, here: voxrt_word_encoder. The words of a
// line that failed are errors, as bad pointers are.
//
// Line n is at address base + 32 (n + 1): word 0 of the octree is the last word of line -1, word w is at
// base + 28 + 4 w.
module voxrt_line_reader
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits   = 12,
  parameter bit          Lod         = 1'b0,
  parameter int unsigned TimeoutBits = 16     // The bus must answer within 2**TimeoutBits clocks: 1 .. 32.
) (
  input logic clk_i,
  input logic rst_ni,  // The bus's reset.
  input logic clear_i,  // See voxrt_axi_read_master.
  input logic recover_i,
  input logic [31:0] base_i,  // A multiple of 32, held during a frame.
  input logic lod_words_i,  // See voxrt_word_encoder; held during a frame.
  input logic request_valid_i,
  output logic request_ready_o,
  input logic [BlockBits:0] request_line_i,  // Signed.
  output logic answer_valid_o,
  input logic answer_ready_i,
  output logic [7:0][payload_bits(BlockBits, Lod):0] answer_words_o,
  output logic bus_error_o,  // For one clock each.
  output logic bus_timeout_o,
  output axi_read_request_t axi_o[BusPorts],
  input axi_read_response_t axi_i[BusPorts]
);
  if (TimeoutBits < 1 || TimeoutBits > 32) $error("voxrt_line_reader: TimeoutBits must be 1 to 32 bits");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned UnderWay = 16;

  logic [BusPorts-1:0] ready, valid, failed, bus_error, bus_timeout;
  logic [255:0] line[BusPorts];
  logic [31:0] address;
  // The port of the next request, and of the next answer.
  logic request_port_q, answer_port_q, fails_q;

  assign address         = base_i + 32'd32 + {{(26 - BlockBits) {request_line_i[BlockBits]}}, request_line_i, 5'd0};
  assign request_ready_o = ready[request_port_q];
  assign answer_valid_o  = valid[answer_port_q];
  assign bus_error_o     = bus_error != '0;
  assign bus_timeout_o   = bus_timeout != '0;

  always_ff @(posedge clk_i) begin
    if (request_valid_i && request_ready_o) request_port_q <= !request_port_q;
    if (answer_valid_o && answer_ready_i) answer_port_q <= !answer_port_q;
    fails_q <= bus_error_o || bus_timeout_o;
    if (!rst_ni || clear_i) begin
      request_port_q <= 1'b0;
      answer_port_q  <= 1'b0;
      fails_q        <= 1'b0;
    end
  end

  for (genvar p = 0; p < BusPorts; p++) begin : gen_port
    voxrt_axi_read_master #(
      .UnderWay   (UnderWay),
      .TimeoutBits(TimeoutBits)
    ) u_master (
      .clk_i,
      .rst_ni,
      .clear_i,
      .recover_i,
      .fail_i           (fails_q),
      .request_valid_i  (request_valid_i && request_port_q == 1'(p)),
      .request_ready_o  (ready[p]),
      .request_address_i(address),
      .answer_valid_o   (valid[p]),
      .answer_ready_i   (answer_ready_i && answer_port_q == 1'(p)),
      .answer_failed_o  (failed[p]),
      .answer_line_o    (line[p]),
      .bus_error_o      (bus_error[p]),
      .bus_timeout_o    (bus_timeout[p]),
      .axi_o            (axi_o[p]),
      .axi_i            (axi_i[p])
    );
  end

  for (genvar w = 0; w < 8; w++) begin : gen_word
    logic [PayloadBits:0] encoded;

    voxrt_word_encoder #(
      .BlockBits(BlockBits),
      .Lod      (Lod)
    ) u_encoder (
      .lod_words_i,
      .word_i(line[answer_port_q][32*w+:32]),
      .word_o(encoded)
    );

    assign answer_words_o[w] = failed[answer_port_q] ? {1'b1, PayloadBits'(ErrorLeaf)} : encoded;
  end
endmodule
