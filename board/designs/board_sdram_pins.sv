// The pins of the SDRAM: what goes out has a flip-flop at the pin, so that all pins change together; the chip's clock is
// later by what the PLL gives it.
//
// The chip answers more than two and a half clocks after it saw a command, so data are taken at the falling edge: 3.5
// clocks after the command has left its flip-flop. docs/ecp5_boards.md has the sums.
module board_sdram_pins
  import board_pkg::*;
(
  input  logic              clk_i,
  input  logic              chip_clk_i,  // clk_i, later by ChipDelay of board_pll.
  input  sdram_out_t        sdram_i,
  output logic       [15:0] dq_o,
  // Pins.
  output logic              sdram_clk,
  output logic              sdram_cke,
  output logic              sdram_csn,
  output logic              sdram_rasn,
  output logic              sdram_casn,
  output logic              sdram_wen,
  output logic       [ 1:0] sdram_ba,
  output logic       [12:0] sdram_a,
  output logic       [ 1:0] sdram_dqm,
  inout  wire        [15:0] sdram_d
);
  localparam int unsigned Outputs = 22;

  logic [Outputs-1:0] inner, outer;

  assign inner = {sdram_i.cke, sdram_i.cs_n, sdram_i.ras_n, sdram_i.cas_n, sdram_i.we_n, sdram_i.ba, sdram_i.a, sdram_i.dqm};
  assign {sdram_cke, sdram_csn, sdram_rasn, sdram_casn, sdram_wen, sdram_ba, sdram_a, sdram_dqm} = outer;

  ODDRX1F u_clock (
    .D0  (1'b1),
    .D1  (1'b0),
    .SCLK(chip_clk_i),
    .RST (1'b0),
    .Q   (sdram_clk)
  );

  for (genvar i = 0; i < Outputs; i++) begin : gen_output
    OFS1P3BX u_pin (
      .D   (inner[i]),
      .PD  (1'b0),
      .SP  (1'b1),
      .SCLK(clk_i),
      .Q   (outer[i])
    );
  end

  for (genvar i = 0; i < 16; i++) begin : gen_data
    logic out, released, in, in_q;

    OFS1P3BX u_out (
      .D   (sdram_i.dq[i]),
      .PD  (1'b0),
      .SP  (1'b1),
      .SCLK(clk_i),
      .Q   (out)
    );

    OFS1P3BX u_release (
      .D   (!sdram_i.dq_oe),
      .PD  (1'b0),
      .SP  (1'b1),
      .SCLK(clk_i),
      .Q   (released)
    );

    BB u_pin (
      .I(out),
      .T(released),
      .O(in),
      .B(sdram_d[i])
    );

    always_ff @(negedge clk_i) in_q <= in;
    assign dq_o[i] = in_q;
  end
endmodule
