// A board's design with the model of an SDRAM at its pins: the sources, or with PLACED a netlist, whose top is called top
// and of which SystemDivider must be given.
module sdram_board #(
  parameter int unsigned InputDivider    = 1,
  parameter int unsigned FeedbackDivider = 5,
  parameter int unsigned SystemDivider   = 10,
  parameter int unsigned Lanes           = 4,
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
  parameter int unsigned LineBits        = 20,
  parameter int unsigned WindowBits      = 20,
  parameter int unsigned StuckData       = 0,   // Bits of the chip's data that are always 1.
  parameter int unsigned GapBits         = 22,
  parameter bit          ButtonsLow      = 1'b0,
  parameter int unsigned Leds            = 8,
  parameter int unsigned Highs           = 1,
  parameter string       OctreeFile      = "",
  parameter string       TableFile       = ""
) (
  input  logic             clk,
  input  logic             uart_rx,
  output logic             uart_tx,
  input  logic [      2:0] buttons,  // Pause, reverse, step.
  output logic [ Leds-1:0] leds,
  output logic [Highs-1:0] high,     // Always 1.
  output logic [      3:0] dvi       // Blue, green, red, clock.
);
  wire         sdram_clk, sdram_cke, sdram_csn, sdram_rasn, sdram_casn, sdram_wen, answers;
  wire  [ 1:0] sdram_ba, sdram_dqm;
  wire  [12:0] sdram_a;
  wire  [15:0] sdram_d, answer;

`ifdef PLACED
  top u_board (
`elsif SELFTEST
  ecp5_selftest_sdram #(
    .InputDivider(InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider(SystemDivider),
    .LineBits(LineBits),
    .PowerOnUs(PowerOnUs),
    .GapBits(GapBits),
    .WindowBits(WindowBits),
    .ButtonsLow(ButtonsLow),
    .Leds(Leds),
    .Highs(Highs)
  ) u_board (
`else
  ecp5_top_sdram #(
    .InputDivider(InputDivider),
    .FeedbackDivider(FeedbackDivider),
    .SystemDivider(SystemDivider),
    .Lanes(Lanes),
    .MaxDepth(MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits(BlockBits),
    .MemoryForm(MemoryForm),
    .L1SetBits(L1SetBits),
    .L2SetBits(L2SetBits),
    .Light(Light),
    .Mirrors(Mirrors),
    .RayClocks(RayClocks),
    .BootBlockBits(BootBlockBits),
    .PowerOnUs(PowerOnUs),
    .GapBits(GapBits),
    .ButtonsLow(ButtonsLow),
    .Leds(Leds),
    .Highs(Highs),
    .OctreeFile(OctreeFile),
    .TableFile(TableFile)
  ) u_board (
`endif
    .clk,
    .uart_rx,
    .uart_tx,
    .buttons,
    .leds,
    .high,
    .dvi,
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

  assign sdram_d = answers ? answer | 16'(StuckData) : 16'bz;

  // Who drives when cannot be seen here: tests/board/sdram_bench.sv looks at it.
  sdram_model #(
    .PeriodPs     (SystemDivider * 4000 / 3),
    .PowerOnPs    (1_000_000 * PowerOnUs),
    .ChecksDrivers(1'b0)
  ) u_chip (
    .tick_i     (clk),
    .clk_i      (sdram_clk),
    .cke_i      (sdram_cke),
    .cs_ni      (sdram_csn),
    .ras_ni     (sdram_rasn),
    .cas_ni     (sdram_casn),
    .we_ni      (sdram_wen),
    .ba_i       (sdram_ba),
    .a_i        (sdram_a),
    .dqm_i      (sdram_dqm),
    .dq_driven_i(1'b1),
    .dq_i       (sdram_d),
    .dq_driven_o(answers),
    .dq_o       (answer)
  );
endmodule
