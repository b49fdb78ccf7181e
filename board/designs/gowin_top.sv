// The ray tracer on a board with a Gowin GW2A: a scene from block RAM on the DVI connector, no host needed.
//
// docs/tang-nano-20k.md is about the design; board/designs/NAME/board.json holds pins and parameters of a board. System
// clock and pixel clock come from two PLLs: nothing relies on their phases.
module gowin_top #(
  parameter int unsigned SystemDivider = 10,
  parameter int unsigned Lanes         = 1,
  parameter int unsigned MaxDepth      = 10,
  parameter int unsigned PositionBits  = 17,
  parameter int unsigned BlockBits     = 11,
  parameter int unsigned MemoryForm    = 0,
  parameter bit          Light         = 1'b0,
  parameter bit          Mirrors       = 1'b0,
  parameter int unsigned RayClocks     = 8,
  parameter int unsigned LineBits      = 4,
  parameter int unsigned ColumnBits    = 9,
  parameter int unsigned GapBits       = 22,
  parameter bit          ButtonsLow    = 1'b0,
  parameter int unsigned Buttons       = 2,     // 1 .. 3.
  parameter bit          LedsLow       = 1'b1,
  parameter int unsigned Leds          = 6,     // 1 .. 8.
  parameter string       OctreeFile    = "",
  parameter string       TableFile     = ""
) (
  input  logic               clk,
  input  logic               uart_rx,
  output logic               uart_tx,
  input  logic [Buttons-1:0] buttons,  // Pause, reverse, step.
  output logic [   Leds-1:0] leds,
  output logic [        3:0] dvi,      // Blue, green, red, clock.
  output logic [        3:0] dvi_n
);
  if (Leds < 1 || Leds > 8) $error("gowin_top: Leds must be 1 to 8");
  if (Buttons < 1 || Buttons > 3) $error("gowin_top: Buttons must be 1 to 3");

  logic bit_clk, pixel_clk, system_clk, locked;

  gowin_clocks #(
    .SystemDivider(SystemDivider)
  ) u_clocks (
    .clk_i       (clk),
    .bit_clk_o   (bit_clk),
    .pixel_clk_o (pixel_clk),
    .system_clk_o(system_clk),
    .locked_o    (locked)
  );

  logic system_rst_n, pixel_rst_n;

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

  logic [2:0][9:0] words;
  logic [7:0] all_leds;
  logic [2:0] all_buttons;
  board_pkg::sdram_out_t unused_sdram;

  // Buttons that a board does not have are not pressed.
  always_comb begin
    all_buttons              = {3{ButtonsLow}};
    all_buttons[Buttons-1:0] = buttons;
  end

  board_system #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryForm  (MemoryForm),
    .Light       (Light),
    .Mirrors     (Mirrors),
    .RayClocks   (RayClocks),
    .ClockHz     (756_000_000 / SystemDivider),
    .LineBits    (LineBits),
    .ColumnBits  (ColumnBits),
    .GapBits     (GapBits),
    .ButtonsLow  (ButtonsLow),
    .OctreeFile  (OctreeFile),
    .TableFile   (TableFile)
  ) u_system (
    .clk_i       (system_clk),
    .rst_ni      (system_rst_n),
    .rx_i        (uart_rx),
    .tx_o        (uart_tx),
    .buttons_i   (all_buttons),
    .leds_o      (all_leds),
    .sdram_o     (unused_sdram),
    .sdram_dq_i  ('0),
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .words_o     (words)
  );

  assign leds = all_leds[Leds-1:0] ^ {Leds{LedsLow}};

  // DVI: the clock channel is five ones and five zeros.
  gowin_serializer u_dvi (
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .bit_clk_i   (bit_clk),
    .words_i     ({10'b0000011111, words}),
    .pins_o      (dvi),
    .pins_no     (dvi_n)
  );
endmodule
