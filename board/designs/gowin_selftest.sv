// The self-test on a board with a Gowin GW2A: docs/board-selftest.md. Its clocks are those of gowin_top.
module gowin_selftest #(
  parameter int unsigned SystemDivider = 10,
  parameter int unsigned GapBits       = 22,
  parameter int unsigned WindowBits    = 20,
  parameter bit          ButtonsLow    = 1'b0,
  parameter int unsigned Buttons       = 2,     // 1 .. 3.
  parameter bit          LedsLow       = 1'b1,
  parameter int unsigned Leds          = 6      // 1 .. 8.
) (
  input  logic               clk,
  input  logic               uart_rx,
  output logic               uart_tx,
  input  logic [Buttons-1:0] buttons,  // Pause, reverse, step.
  output logic [   Leds-1:0] leds,
  output logic [        3:0] dvi,      // Blue, green, red, clock.
  output logic [        3:0] dvi_n
);
  if (Leds < 1 || Leds > 8) $error("gowin_selftest: Leds must be 1 to 8");
  if (Buttons < 1 || Buttons > 3) $error("gowin_selftest: Buttons must be 1 to 3");

  logic bit_clk, pixel_clk, system_clk, locked, system_rst_n, pixel_rst_n;
  logic [2:0][9:0] words;
  logic [7:0] all_leds;

  gowin_clocks #(
    .SystemDivider(SystemDivider)
  ) u_clocks (
    .clk_i       (clk),
    .bit_clk_o   (bit_clk),
    .pixel_clk_o (pixel_clk),
    .system_clk_o(system_clk),
    .locked_o    (locked)
  );

  board_reset u_system_reset (
    .clk_i   (system_clk),
    .locked_i(locked),
    .rst_no  (system_rst_n)
  );

  board_reset u_pixel_reset (
    .clk_i   (pixel_clk),
    .locked_i(locked),
    .rst_no  (pixel_rst_n)
  );

  board_selftest #(
    .ClockHz   (756_000_000 / SystemDivider),
    .PixelHz   (25_200_000),
    .GapBits   (GapBits),
    .WindowBits(WindowBits),
    .Buttons   (Buttons),
    .ButtonsLow(ButtonsLow)
  ) u_selftest (
    .clk_i       (system_clk),
    .rst_ni      (system_rst_n),
    .bit_clk_i   (bit_clk),
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .locked_i    (locked),
    .rx_i        (uart_rx),
    .tx_o        (uart_tx),
    .buttons_i   (buttons),
    .leds_o      (all_leds),
    .words_o     (words),
    .stage_i     ('0),
    .lines_i     ('0),
    .wrong_i     ('0),
    .bits_i      ('0),
    .first_i     ('0)
  );

  assign leds = all_leds[Leds-1:0] ^ {Leds{LedsLow}};

  gowin_serializer u_dvi (
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .bit_clk_i   (bit_clk),
    .words_i     ({10'b0000011111, words}),
    .pins_o      (dvi),
    .pins_no     (dvi_n)
  );
endmodule
