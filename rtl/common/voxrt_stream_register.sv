// A register in a stream of valid and ready, for one transfer per clock.
//
// Use it to cut a path that is too long: valid_o and data_o come from flip-flops. Without CutsReady, ready_o still
// depends on ready_i in the same clock, so a row of such registers has one path of ready through all of them. With
// CutsReady, ready_o comes from a flip-flop too, and a second register holds what comes before the sender sees it: a
// skid buffer, which takes twice the flip-flops. For more places than these, use voxrt_fifo.
`include "voxrt_assert.svh"

module voxrt_stream_register #(
  parameter int unsigned Width     = 8,    // Bits: 1 or more.
  parameter bit          CutsReady = 1'b0
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [Width-1:0] data_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [Width-1:0] data_o
);
  if (Width < 1) $error("voxrt_stream_register: Width must be 1 bit or more");

  logic valid_q;
  logic [Width-1:0] data_q;

  assign valid_o = valid_q;
  assign data_o  = data_q;

  if (CutsReady) begin : gen_cuts_ready
    logic second_valid_q;
    logic [Width-1:0] second_q;

    assign ready_o = !second_valid_q;

    always_ff @(posedge clk_i) begin
      if (!second_valid_q) second_q <= data_i;
      if (!valid_q || ready_i) begin
        valid_q        <= second_valid_q || valid_i;
        data_q         <= second_valid_q ? second_q : data_i;
        second_valid_q <= 1'b0;
      end else if (valid_i) begin
        second_valid_q <= 1'b1;
      end
      if (!rst_ni) begin
        valid_q        <= 1'b0;
        second_valid_q <= 1'b0;
      end
    end
  end else begin : gen_register
    assign ready_o = !valid_q || ready_i;

    always_ff @(posedge clk_i) begin
      if (ready_o) begin
        valid_q <= valid_i;
        data_q  <= data_i;
      end
      if (!rst_ni) valid_q <= 1'b0;
    end
  end

  `VOXRT_ASSERT_STABLE(OfferStays, valid_o, ready_i, data_o)
endmodule
