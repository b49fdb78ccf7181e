// The self-test on a board with a Lattice ECP5: docs/board-selftest.md.
module ecp5_selftest #(
  parameter int unsigned InputDivider    = 1,
  parameter int unsigned FeedbackDivider = 5,
  parameter int unsigned SystemDivider   = 10,
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
  output logic [Highs-1:0] high,     // Always 1.
  output logic [      3:0] dvi       // Blue, green, red, clock.
);
  if (Leds < 1 || Leds > 8) $error("ecp5_selftest: Leds must be 1 to 8");
  if (Highs < 1) $error("ecp5_selftest: Highs must be 1 or more");

  logic [7:0] all_leds;
  logic unused_system_clk, unused_chip_clk, unused_rst_n;

  ecp5_selftest_board #(
    .InputDivider   (InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider  (SystemDivider),
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
    .system_clk_o(unused_system_clk),
    .chip_clk_o  (unused_chip_clk),
    .rst_no      (unused_rst_n),
    .stage_i     ('0),
    .lines_i     ('0),
    .wrong_i     ('0),
    .bits_i      ('0),
    .first_i     ('0)
  );

  assign leds = all_leds[Leds-1:0];
  assign high = '1;
endmodule
