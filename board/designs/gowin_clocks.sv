// The clocks of a board with a Gowin GW2A and an oscillator of 27 MHz: bit clock 126 MHz, pixel clock a fifth of it, and
// from a second PLL the system clock, 756 MHz / SystemDivider.
//
// 27 MHz x 14 / 3 is the nearest to 125 MHz that both PLL's dividers and a whole number of pixels allow: 60 Hz exactly.
module gowin_clocks #(
  parameter int unsigned SystemDivider = 10  // 10, 12, 14, 16, 18, 20, 21 or 24.
) (
  input  logic clk_i,
  output logic bit_clk_o,
  output logic pixel_clk_o,
  output logic system_clk_o,
  output logic locked_o
);
  // The oscillator inside runs at 500 to 1,250 MHz: the output's frequency times OutputDivider.
  localparam int unsigned BitOutputDivider = 8;
  localparam int unsigned SystemOutputDivider = SystemDivider < 12 ? 8 : 16;
  // 28 / SystemDivider in lowest terms.
  localparam int unsigned Common = SystemDivider % 28 == 14 ? 14 : SystemDivider % 28 == 21 ? 7 :
      SystemDivider % 4 == 0 ? 4 : SystemDivider % 2 == 0 ? 2 : 1;
  // A PLL compares at 3 MHz or more.
  localparam int unsigned MostInput = 9;

  if (SystemDivider < 10 || SystemDivider > 24 || SystemDivider / Common > MostInput)
    $error("gowin_clocks: SystemDivider must be 10, 12, 14, 16, 18, 20, 21 or 24");

  logic bit_locked, system_locked;

  rPLL #(
    .IDIV_SEL (3 - 1),
    .FBDIV_SEL(14 - 1),
    .ODIV_SEL (BitOutputDivider)
  ) u_bit (
    .CLKIN   (clk_i),
    .CLKFB   (1'b0),
    .RESET   (1'b0),
    .RESET_P (1'b0),
    .FBDSEL  ('0),
    .IDSEL   ('0),
    .ODSEL   ('0),
    .PSDA    ('0),
    .DUTYDA  ('0),
    .FDLY    ('0),
    .CLKOUT  (bit_clk_o),
    .LOCK    (bit_locked),
    .CLKOUTP (),
    .CLKOUTD (),
    .CLKOUTD3()
  );

  CLKDIV #(
    .DIV_MODE("5")
  ) u_pixel (
    .HCLKIN(bit_clk_o),
    .RESETN(bit_locked),
    .CALIB (1'b0),
    .CLKOUT(pixel_clk_o)
  );

  rPLL #(
    .IDIV_SEL (SystemDivider / Common - 1),
    .FBDIV_SEL(28 / Common - 1),
    .ODIV_SEL (SystemOutputDivider)
  ) u_system (
    .CLKIN   (clk_i),
    .CLKFB   (1'b0),
    .RESET   (1'b0),
    .RESET_P (1'b0),
    .FBDSEL  ('0),
    .IDSEL   ('0),
    .ODSEL   ('0),
    .PSDA    ('0),
    .DUTYDA  ('0),
    .FDLY    ('0),
    .CLKOUT  (system_clk_o),
    .LOCK    (system_locked),
    .CLKOUTP (),
    .CLKOUTD (),
    .CLKOUTD3()
  );

  assign locked_o = bit_locked && system_locked;
endmodule
