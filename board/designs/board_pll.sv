// The clocks of an ECP5 board: 750 MHz inside; bit clock 125 MHz, pixel clock 25 MHz, system clock 750 MHz / SystemDivider.
// The clock of an SDRAM chip is the system clock, but later by ChipDelay periods of 750 MHz.
//
// The oscillator must give 125 MHz x InputDivider / FeedbackDivider.
module board_pll #(
  parameter int unsigned InputDivider    = 1,   // 1 .. 128.
  parameter int unsigned FeedbackDivider = 5,   // 1 .. 128.
  parameter int unsigned SystemDivider   = 10,  // 1 .. 128.
  parameter int unsigned ChipDelay       = 0    // Less than SystemDivider; 0: no such chip, no clock for it.
) (
  input  logic clk_i,
  output logic bit_clk_o,
  output logic pixel_clk_o,
  output logic system_clk_o,
  output logic chip_clk_o,
  output logic locked_o
);
  if (InputDivider < 1 || InputDivider > 128) $error("board_pll: InputDivider must be 1 to 128");
  if (FeedbackDivider < 1 || FeedbackDivider > 128) $error("board_pll: FeedbackDivider must be 1 to 128");
  if (SystemDivider < 1 || SystemDivider > 128) $error("board_pll: SystemDivider must be 1 to 128");

  localparam int unsigned BitDivider = 6;
  localparam int unsigned PixelDivider = 30;

  if (ChipDelay >= SystemDivider) $error("board_pll: ChipDelay must be less than SystemDivider");

  // A phase of "divider - 1" is none: these clocks rise together.
  //
  // The attributes set charge pump, loop filter and amplifier. nextpnr takes 0 for each that is missing. These are the
  // values of Trellis' ecppll, which has the same ones for all frequencies.
  (* ICP_CURRENT = "12", LPF_RESISTOR = "8", MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
    .CLKI_DIV     (InputDivider),
    .CLKFB_DIV    (FeedbackDivider),
    .CLKOP_DIV    (BitDivider),
    .CLKOP_CPHASE (BitDivider - 1),
    .CLKOS_DIV    (PixelDivider),
    .CLKOS_CPHASE (PixelDivider - 1),
    .CLKOS2_DIV   (SystemDivider),
    .CLKOS2_CPHASE(SystemDivider - 1),
    .CLKOS3_ENABLE(ChipDelay == 0 ? "DISABLED" : "ENABLED"),
    .CLKOS3_DIV   (SystemDivider),
    .CLKOS3_CPHASE(SystemDivider - 1 + ChipDelay)
  ) u_pll (
    .CLKI        (clk_i),
    .CLKFB       (bit_clk_o),
    .RST         (1'b0),
    .STDBY       (1'b0),
    .PHASESEL0   (1'b0),
    .PHASESEL1   (1'b0),
    .PHASEDIR    (1'b0),
    .PHASESTEP   (1'b0),
    .PHASELOADREG(1'b0),
    .PLLWAKESYNC (1'b0),
    .ENCLKOP     (1'b0),
    .CLKOP       (bit_clk_o),
    .CLKOS       (pixel_clk_o),
    .CLKOS2      (system_clk_o),
    .CLKOS3      (chip_clk_o),
    .LOCK        (locked_o)
  );
endmodule
