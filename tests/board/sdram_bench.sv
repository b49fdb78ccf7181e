// The SDRAM's controller, arbiter and an AXI port, with a model of the chip: for tests.
module sdram_bench
  import voxrt_pkg::*;
#(
  parameter int unsigned TrcdPs      = 20_000,
  parameter int unsigned TrpPs       = 20_000,
  parameter int unsigned TrfcPs      = 66_000,
  parameter int unsigned RefreshPs   = 7_812_500,
  parameter int unsigned AnswerTicks = 9,
  parameter int unsigned HoldTicks   = 3
) (
  input  logic               clk_i,
  input  logic               sdram_clk_i,           // As clk_i, later.
  input  logic               tick_i,                // Ten changes per clock.
  input  logic               rst_ni,
  // Ports 0 and 1: lines. Port 0 is the screen's.
  input  logic               urgent_i,
  input  logic [  1:0]       valid_i,
  output logic [  3:0]       accepted_o,            // Requests accepted, by port.
  output logic [  3:0][19:0] accepted_line_o,
  input  logic               write_i,               // Whether port 1 writes.
  input  logic [ 31:0]       line_i           [2],
  input  logic [ 15:0]       mask_i,
  input  logic [255:0]       data_i,
  output logic [  1:0]       done_o,
  output logic [255:0]       line_o,
  // Ports 2 and 3: the core's way of reading.
  input  logic [  1:0]       request_valid_i,
  output logic [  1:0]       request_ready_o,
  input  logic [ 31:0]       request_address_i[2],
  output logic [  1:0]       answer_valid_o,
  output logic [  1:0]       answer_failed_o,
  output logic [255:0]       answer0_o,
  output logic [255:0]       answer1_o
);
  logic [3:0] ready, done, valid;
  logic [3:0][19:0] lines;
  logic request_valid, request_ready, request_write, controller_done;
  logic [19:0] request_line;
  logic [15:0] request_mask;
  logic [255:0] request_data;
  logic [1:0][255:0] answers;

  assign accepted_o      = ready & valid;
  assign accepted_line_o = lines;
  assign done_o          = done[1:0];
  assign answer0_o       = answers[0];
  assign answer1_o       = answers[1];
  assign valid[1:0]      = valid_i;
  assign lines[0]        = line_i[0][19:0];
  assign lines[1]        = line_i[1][19:0];

  for (genvar i = 0; i < 2; i++) begin : gen_axi
    axi_read_request_t request;
    axi_read_response_t response;

    voxrt_axi_read_master u_master (
      .clk_i,
      .rst_ni,
      .clear_i          (1'b0),
      .recover_i        (1'b0),
      .fail_i           (1'b0),
      .request_valid_i  (request_valid_i[i]),
      .request_ready_o  (request_ready_o[i]),
      .request_address_i(request_address_i[i]),
      .answer_valid_o   (answer_valid_o[i]),
      .answer_ready_i   (1'b1),
      .answer_failed_o  (answer_failed_o[i]),
      .answer_line_o    (answers[i]),
      .bus_error_o      (),
      .bus_timeout_o    (),
      .axi_o            (request),
      .axi_i            (response)
    );
    board_sdram_axi u_axi (
      .clk_i,
      .rst_ni,
      .axi_i  (request),
      .axi_o  (response),
      .valid_o(valid[2+i]),
      .ready_i(ready[2+i]),
      .line_o (lines[2+i]),
      .done_i (done[2+i]),
      .data_i (line_o)
    );
  end

  board_sdram_arbiter #(
    .Ports(4)
  ) u_arbiter (
    .clk_i,
    .rst_ni,
    .urgent_i,
    .valid_i        (valid),
    .ready_o        (ready),
    .write_i        ({2'b00, write_i, 1'b0}),
    .line_i         (lines),
    .mask_i         ({32'd0, mask_i, 16'd0}),
    .data_i         ({512'd0, data_i, 256'd0}),
    .done_o         (done),
    .request_valid_o(request_valid),
    .request_ready_i(request_ready),
    .request_write_o(request_write),
    .request_line_o (request_line),
    .request_mask_o (request_mask),
    .request_data_o (request_data),
    .done_i         (controller_done)
  );

  // As board_sdram_pins: out by a flip-flop, in at the falling edge.
  board_pkg::sdram_out_t inner, outer_q;
  logic driven;
  logic [15:0] from_chip, from_chip_q;

  always_ff @(posedge clk_i) outer_q <= inner;
  always_ff @(negedge clk_i) from_chip_q <= from_chip;

  // A clock of the bench has ten ticks of 750 MHz.
  board_sdram #(
    .ClockHz  (75_000_000),
    .PowerOnUs(2)
  ) u_sdram (
    .clk_i,
    .rst_ni,
    .request_valid_i(request_valid),
    .request_ready_o(request_ready),
    .request_write_i(request_write),
    .request_line_i (request_line),
    .request_mask_i (request_mask),
    .request_data_i (request_data),
    .done_o         (controller_done),
    .line_o,
    .sdram_o        (inner),
    .sdram_dq_i     (from_chip_q)
  );

  sdram_model #(
    .PowerOnPs  (2_000_000),
    .TrcdPs     (TrcdPs),
    .TrpPs      (TrpPs),
    .TrfcPs     (TrfcPs),
    .RefreshPs  (RefreshPs),
    .AnswerTicks(AnswerTicks),
    .HoldTicks  (HoldTicks)
  ) u_model (
    .tick_i,
    .clk_i      (sdram_clk_i),
    .cke_i      (outer_q.cke),
    .cs_ni      (outer_q.cs_n),
    .ras_ni     (outer_q.ras_n),
    .cas_ni     (outer_q.cas_n),
    .we_ni      (outer_q.we_n),
    .ba_i       (outer_q.ba),
    .a_i        (outer_q.a),
    .dqm_i      (outer_q.dqm),
    .dq_driven_i(outer_q.dq_oe),
    .dq_i       (outer_q.dq),
    .dq_driven_o(driven),
    .dq_o       (from_chip)
  );

  logic unused_driven;
  assign unused_driven = driven;
endmodule
