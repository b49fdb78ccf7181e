// The self-test with what it needs of a Lattice ECP5: the clocks, and the serializer of the DVI pins.
module ecp5_selftest_board #(
  parameter int unsigned InputDivider    = 1,
  parameter int unsigned FeedbackDivider = 5,
  parameter int unsigned SystemDivider   = 10,
  parameter int unsigned ChipDelay       = 0,
  parameter bit          HasSdram        = 1'b0,
  parameter int unsigned GapBits         = 22,
  parameter int unsigned WindowBits      = 20,
  parameter bit          ButtonsLow      = 1'b0
) (
  input  logic        clk,
  input  logic        uart_rx,
  output logic        uart_tx,
  input  logic [ 2:0] buttons,
  output logic [ 7:0] leds_o,
  output logic [ 3:0] dvi,           // Blue, green, red, clock.
  // For an SDRAM: clocks and reset, and what board_sdram_test found; 0 where there is none.
  output logic        system_clk_o,
  output logic        chip_clk_o,
  output logic        rst_no,
  input  logic [ 1:0] stage_i,
  input  logic [31:0] lines_i,
  input  logic [31:0] wrong_i,
  input  logic [15:0] bits_i,
  input  logic [19:0] first_i
);
  logic bit_clk, pixel_clk, pixel_rst_n, locked;
  logic [2:0][9:0] words;

  board_pll #(
    .InputDivider   (InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider  (SystemDivider),
    .ChipDelay      (ChipDelay)
  ) u_pll (
    .clk_i      (clk),
    .bit_clk_o  (bit_clk),
    .pixel_clk_o(pixel_clk),
    .system_clk_o,
    .chip_clk_o,
    .locked_o   (locked)
  );

  board_reset u_system_reset (
    .clk_i   (system_clk_o),
    .locked_i(locked),
    .rst_no
  );

  board_reset u_pixel_reset (
    .clk_i   (pixel_clk),
    .locked_i(locked),
    .rst_no  (pixel_rst_n)
  );

  board_selftest #(
    .ClockHz   (750_000_000 / SystemDivider),
    .PixelHz   (25_000_000),
    .HasSdram  (HasSdram),
    .GapBits   (GapBits),
    .WindowBits(WindowBits),
    .ButtonsLow(ButtonsLow)
  ) u_selftest (
    .clk_i       (system_clk_o),
    .rst_ni      (rst_no),
    .bit_clk_i   (bit_clk),
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .locked_i    (locked),
    .rx_i        (uart_rx),
    .tx_o        (uart_tx),
    .buttons_i   (buttons),
    .leds_o,
    .words_o     (words),
    .stage_i,
    .lines_i,
    .wrong_i,
    .bits_i,
    .first_i
  );

  board_serializer u_dvi (
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .bit_clk_i   (bit_clk),
    .words_i     ({10'b0000011111, words}),
    .pins_o      (dvi)
  );
endmodule
