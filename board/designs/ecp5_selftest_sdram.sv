// The self-test on a board with a Lattice ECP5 and an SDR SDRAM of 32 MB: docs/board-selftest.md.
module ecp5_selftest_sdram #(
  parameter int unsigned InputDivider    = 1,
  parameter int unsigned FeedbackDivider = 5,
  parameter int unsigned SystemDivider   = 12,
  parameter int unsigned ChipDelay       = 5,
  parameter int unsigned LineBits        = 20,
  parameter int unsigned PowerOnUs       = 200,
  parameter int unsigned GapBits         = 22,
  parameter int unsigned WindowBits      = 20,
  parameter bit          ButtonsLow      = 1'b0,
  parameter int unsigned Leds            = 8,     // 1 .. 8.
  parameter int unsigned Highs           = 1      // Pins that are always 1: 1 or more.
) (
  input  logic             clk,
  input  logic             uart_rx,
  output logic             uart_tx,
  input  logic [      2:0] buttons,
  output logic [ Leds-1:0] leds,
  output logic [Highs-1:0] high,        // Always 1.
  output logic [      3:0] dvi,         // Blue, green, red, clock.
  output logic             sdram_clk,
  output logic             sdram_cke,
  output logic             sdram_csn,
  output logic             sdram_rasn,
  output logic             sdram_casn,
  output logic             sdram_wen,
  output logic [      1:0] sdram_ba,
  output logic [     12:0] sdram_a,
  output logic [      1:0] sdram_dqm,
  inout  wire  [     15:0] sdram_d
);
  if (Leds < 1 || Leds > 8) $error("ecp5_selftest_sdram: Leds must be 1 to 8");
  if (Highs < 1) $error("ecp5_selftest_sdram: Highs must be 1 or more");

  logic [7:0] all_leds;
  logic system_clk, chip_clk, rst_n;
  logic [1:0] stage;
  logic [31:0] lines, wrong;
  logic [15:0] bits;
  logic [19:0] first;

  board_pkg::sdram_out_t sdram;
  logic [15:0] dq;

  ecp5_selftest_board #(
    .InputDivider   (InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider  (SystemDivider),
    .ChipDelay      (ChipDelay),
    .HasSdram       (1'b1),
    .GapBits        (GapBits),
    .WindowBits     (WindowBits),
    .ButtonsLow     (ButtonsLow)
  ) u_board (
    .clk,
    .uart_rx,
    .uart_tx,
    .buttons,
    .leds_o      (all_leds),
    .dvi,
    .system_clk_o(system_clk),
    .chip_clk_o  (chip_clk),
    .rst_no      (rst_n),
    .stage_i     (stage),
    .lines_i     (lines),
    .wrong_i     (wrong),
    .bits_i      (bits),
    .first_i     (first)
  );

  logic request_valid, request_ready, request_write, done;
  logic [19:0] request_line;
  logic [255:0] request_data, read_line;

  board_sdram_test #(
    .LineBits(LineBits)
  ) u_test (
    .clk_i          (system_clk),
    .rst_ni         (rst_n),
    .request_valid_o(request_valid),
    .request_ready_i(request_ready),
    .request_write_o(request_write),
    .request_line_o (request_line),
    .request_data_o (request_data),
    .done_i         (done),
    .line_i         (read_line),
    .stage_o        (stage),
    .lines_o        (lines),
    .wrong_o        (wrong),
    .bits_o         (bits),
    .first_o        (first)
  );

  board_sdram #(
    .ClockHz  (750_000_000 / SystemDivider),
    .PowerOnUs(PowerOnUs)
  ) u_controller (
    .clk_i          (system_clk),
    .rst_ni         (rst_n),
    .request_valid_i(request_valid),
    .request_ready_o(request_ready),
    .request_write_i(request_write),
    .request_line_i (request_line),
    .request_mask_i ('1),
    .request_data_i (request_data),
    .done_o         (done),
    .line_o         (read_line),
    .sdram_o        (sdram),
    .sdram_dq_i     (dq)
  );

  board_sdram_pins u_sdram_pins (
    .clk_i     (system_clk),
    .chip_clk_i(chip_clk),
    .sdram_i   (sdram),
    .dq_o      (dq),
    .sdram_clk,
    .sdram_cke,
    .sdram_csn,
    .sdram_rasn,
    .sdram_casn,
    .sdram_wen,
    .sdram_ba,
    .sdram_a,
    .sdram_dqm,
    .sdram_d
  );

  assign leds = all_leds[Leds-1:0];
  assign high = '1;
endmodule
