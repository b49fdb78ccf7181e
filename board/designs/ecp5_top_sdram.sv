// The ray tracer on a board with a Lattice ECP5 and an SDR SDRAM of 32 MB, which holds the octree and two frames: a scene
// on the DVI connector, no host needed.
//
// docs/ecp5_boards.md is the reference of the design; board/designs/NAME/board.json holds pins and parameters of a board.
// System and pixel clock come from one PLL, but nothing relies on their phases.
module ecp5_top_sdram #(
  parameter int unsigned InputDivider    = 1,
  parameter int unsigned FeedbackDivider = 5,
  parameter int unsigned SystemDivider   = 12,
  parameter int unsigned ChipDelay       = 5,
  parameter int unsigned Lanes           = 2,
  parameter int unsigned MaxDepth        = 12,
  parameter int unsigned PositionBits    = 19,
  parameter int unsigned BlockBits       = 20,
  parameter int unsigned MemoryForm      = 2,
  parameter int unsigned L1SetBits       = 5,
  parameter int unsigned L2SetBits       = 9,
  parameter bit          Light           = 1'b0,
  parameter bit          Mirrors         = 1'b0,
  parameter int unsigned RayClocks       = 1,
  parameter int unsigned BootBlockBits   = 12,
  parameter int unsigned PowerOnUs       = 200,
  parameter int unsigned GapBits         = 22,
  parameter bit          ButtonsLow      = 1'b0,
  parameter int unsigned Leds            = 8,     // 1 .. 8.
  parameter int unsigned Highs           = 1,     // Pins that are always 1: 1 or more.
  parameter string       OctreeFile      = "",
  parameter string       TableFile       = ""
) (
  input  logic             clk,
  input  logic             uart_rx,
  output logic             uart_tx,
  input  logic [      2:0] buttons,     // Pause, reverse, step.
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
  if (Leds < 1 || Leds > 8) $error("ecp5_top_sdram: Leds must be 1 to 8");
  if (Highs < 1) $error("ecp5_top_sdram: Highs must be 1 or more");

  logic bit_clk, pixel_clk, system_clk, chip_clk, locked;

  board_pll #(
    .InputDivider   (InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider  (SystemDivider),
    .ChipDelay      (ChipDelay)
  ) u_pll (
    .clk_i       (clk),
    .bit_clk_o   (bit_clk),
    .pixel_clk_o (pixel_clk),
    .system_clk_o(system_clk),
    .chip_clk_o  (chip_clk),
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

  board_pkg::sdram_out_t sdram;
  logic [15:0] dq;

  board_system #(
    .Lanes        (Lanes),
    .MaxDepth     (MaxDepth),
    .PositionBits (PositionBits),
    .BlockBits    (BlockBits),
    .MemoryForm   (MemoryForm),
    .L1SetBits    (L1SetBits),
    .L2SetBits    (L2SetBits),
    .Light        (Light),
    .Mirrors      (Mirrors),
    .RayClocks    (RayClocks),
    .BootBlockBits(BootBlockBits),
    .ClockHz      (750_000_000 / SystemDivider),
    .PowerOnUs    (PowerOnUs),
    .GapBits      (GapBits),
    .ButtonsLow   (ButtonsLow),
    .OctreeFile   (OctreeFile),
    .TableFile    (TableFile)
  ) u_system (
    .clk_i       (system_clk),
    .rst_ni      (system_rst_n),
    .rx_i        (uart_rx),
    .tx_o        (uart_tx),
    .buttons_i   (buttons),
    .leds_o      (all_leds),
    .sdram_o     (sdram),
    .sdram_dq_i  (dq),
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .words_o     (words)
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

  // DVI: the clock channel is five ones and five zeros.
  board_serializer u_dvi (
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(pixel_rst_n),
    .bit_clk_i   (bit_clk),
    .words_i     ({10'b0000011111, words}),
    .pins_o      (dvi)
  );
endmodule
