// Cells of the Gowin GW2A that the designs instantiate: black boxes for synthesis, models for a simulation.
//
// A base tick is half a period of CLKIN in a simulation, a period of 28 x 27 = 756 MHz: the simulation drives CLKIN at
// that rate, whatever the board's oscillator has. So a PLL's output has 28 x (IDIV_SEL + 1) / (FBDIV_SEL + 1) ticks.
(* blackbox *)
module rPLL #(
  parameter string       FCLKIN           = "27",
  parameter string       DYN_IDIV_SEL     = "false",
  parameter int unsigned IDIV_SEL         = 0,
  parameter string       DYN_FBDIV_SEL    = "false",
  parameter int unsigned FBDIV_SEL        = 0,
  parameter string       DYN_ODIV_SEL     = "false",
  parameter int unsigned ODIV_SEL         = 8,
  parameter string       PSDA_SEL         = "0000",
  parameter string       DYN_DA_EN        = "false",
  parameter string       DUTYDA_SEL       = "1000",
  parameter bit          CLKOUT_FT_DIR    = 1'b1,
  parameter bit          CLKOUTP_FT_DIR   = 1'b1,
  parameter int unsigned CLKOUT_DLY_STEP  = 0,
  parameter int unsigned CLKOUTP_DLY_STEP = 0,
  parameter string       CLKFB_SEL        = "internal",
  parameter string       CLKOUT_BYPASS    = "false",
  parameter string       CLKOUTP_BYPASS   = "false",
  parameter string       CLKOUTD_BYPASS   = "false",
  parameter int unsigned DYN_SDIV_SEL     = 2,
  parameter string       CLKOUTD_SRC      = "CLKOUT",
  parameter string       CLKOUTD3_SRC     = "CLKOUT",
  parameter string       DEVICE           = "GW2A-18C"
) (
  input  logic       CLKIN,
  input  logic       CLKFB,
  input  logic       RESET,
  input  logic       RESET_P,
  input  logic [5:0] FBDSEL,
  input  logic [5:0] IDSEL,
  input  logic [5:0] ODSEL,
  input  logic [3:0] PSDA,
  input  logic [3:0] DUTYDA,
  input  logic [3:0] FDLY,
  output logic       CLKOUT,
  output logic       LOCK,
  output logic       CLKOUTP,
  output logic       CLKOUTD,
  output logic       CLKOUTD3
);
`ifndef SYNTHESIS
  localparam int unsigned Ticks = 28 * (IDIV_SEL + 1) / (FBDIV_SEL + 1);
  int unsigned tick = 0, ticks = 0;

  // High in the first half of a period. Blocking: all clocks of a tick rise at once.
  always @(CLKIN) begin
    ticks  = ticks + 1;
    tick   = tick + 1 == Ticks ? 0 : tick + 1;
    CLKOUT = tick < Ticks / 2;
    LOCK   = ticks > 300;
  end
`endif
endmodule

(* blackbox *)
module CLKDIV #(
  parameter string DIV_MODE = "5",
  parameter string GSREN    = "false"
) (
  input  logic HCLKIN,
  input  logic RESETN,
  input  logic CALIB,
  output logic CLKOUT
);
`ifndef SYNTHESIS
  logic [2:0] count = '0;

  always @(posedge HCLKIN) begin
    count  = count == 3'd4 ? 3'd0 : count + 3'd1;
    CLKOUT = count < 3'd2;
  end
`endif
endmodule

// D0 goes first, at a rising edge of FCLK; D1 at the falling edge.
(* blackbox *)
module OSER10 #(
  parameter string GSREN = "false",
  parameter string LSREN = "true"
) (
  input  logic D0,
  input  logic D1,
  input  logic D2,
  input  logic D3,
  input  logic D4,
  input  logic D5,
  input  logic D6,
  input  logic D7,
  input  logic D8,
  input  logic D9,
  input  logic FCLK,
  input  logic PCLK,
  input  logic RESET,
  output logic Q
);
`ifndef SYNTHESIS
  logic [9:0] word_q, bits_q;
  logic toggle_q = 1'b0;
  logic [2:0] toggles_q;

  always_ff @(posedge PCLK) begin
    word_q   <= {D9, D8, D7, D6, D5, D4, D3, D2, D1, D0};
    toggle_q <= !toggle_q;
  end

  always_ff @(posedge FCLK) begin
    toggles_q <= {toggles_q[1:0], toggle_q};
    bits_q    <= toggles_q[2] != toggles_q[1] ? word_q : {2'b00, bits_q[9:2]};
  end

  assign Q = FCLK ? bits_q[0] : bits_q[1];
`endif
endmodule

// A pair of pins, of which one is the other's complement.
(* blackbox *)
module TLVDS_OBUF (
  input  logic I,
  output logic O,
  output logic OB
);
`ifndef SYNTHESIS
  assign O  = I;
  assign OB = !I;
`endif
endmodule
