// Cells of the ECP5 that the designs instantiate: black boxes for synthesis, models for a simulation.
//
// A base tick is half a period of CLKI in a simulation, one period of the PLL's 750 MHz: the simulation drives CLKI at
// that rate, whatever the board's oscillator has.
(* blackbox *)
module EHXPLLL #(
  parameter string       PLLRST_ENA      = "DISABLED",
  parameter string       INTFB_WAKE      = "DISABLED",
  parameter string       STDBY_ENABLE    = "DISABLED",
  parameter string       DPHASE_SOURCE   = "DISABLED",
  parameter string       OUTDIVIDER_MUXA = "DIVA",
  parameter string       OUTDIVIDER_MUXB = "DIVB",
  parameter string       OUTDIVIDER_MUXC = "DIVC",
  parameter string       OUTDIVIDER_MUXD = "DIVD",
  parameter string       CLKOP_ENABLE    = "ENABLED",
  parameter string       CLKOS_ENABLE    = "ENABLED",
  parameter string       CLKOS2_ENABLE   = "ENABLED",
  parameter string       CLKOS3_ENABLE   = "DISABLED",
  parameter string       FEEDBK_PATH     = "CLKOP",
  parameter int unsigned CLKI_DIV        = 1,
  parameter int unsigned CLKFB_DIV       = 1,
  parameter int unsigned CLKOP_DIV       = 8,
  parameter int unsigned CLKOP_CPHASE    = 0,
  parameter int unsigned CLKOP_FPHASE    = 0,
  parameter int unsigned CLKOS_DIV       = 8,
  parameter int unsigned CLKOS_CPHASE    = 0,
  parameter int unsigned CLKOS_FPHASE    = 0,
  parameter int unsigned CLKOS2_DIV      = 8,
  parameter int unsigned CLKOS2_CPHASE   = 0,
  parameter int unsigned CLKOS2_FPHASE   = 0,
  parameter int unsigned CLKOS3_DIV      = 8,
  parameter int unsigned CLKOS3_CPHASE   = 0,
  parameter int unsigned CLKOS3_FPHASE   = 0
) (
  input  logic CLKI,
  input  logic CLKFB,
  input  logic RST,
  input  logic STDBY,
  input  logic PHASESEL0,
  input  logic PHASESEL1,
  input  logic PHASEDIR,
  input  logic PHASESTEP,
  input  logic PHASELOADREG,
  input  logic PLLWAKESYNC,
  input  logic ENCLKOP,
  output logic CLKOP,
  output logic CLKOS,
  output logic CLKOS2,
  output logic CLKOS3,
  output logic LOCK
);
`ifndef SYNTHESIS
  int unsigned op = 0, os = 0, os2 = 0, os3 = 0, ticks = 0;

  // Clocks are high in the first half of their period. Blocking: all clocks of a tick rise at once. The last one is later
  // by its phase beyond CLKOS3_DIV - 1.
  always @(CLKI) begin
    ticks  = ticks + 1;
    op     = op + 1 == CLKOP_DIV ? 0 : op + 1;
    os     = os + 1 == CLKOS_DIV ? 0 : os + 1;
    os2    = os2 + 1 == CLKOS2_DIV ? 0 : os2 + 1;
    CLKOP  = op < CLKOP_DIV / 2;
    CLKOS  = os < CLKOS_DIV / 2;
    os3    = (ticks + 2 * CLKOS3_DIV - 1 - CLKOS3_CPHASE) % CLKOS3_DIV;
    CLKOS2 = os2 < CLKOS2_DIV / 2;
    CLKOS3 = os3 < CLKOS3_DIV / 2;
    LOCK   = ticks > 300;
  end
`endif
endmodule

(* blackbox *)
module ODDRX1F (
  input  logic D0,
  input  logic D1,
  input  logic SCLK,
  input  logic RST,
  output logic Q
);
`ifndef SYNTHESIS
  logic first_q, second_q;

  always_ff @(posedge SCLK) begin
    first_q  <= !RST && D0;
    second_q <= !RST && D1;
  end

  assign Q = SCLK ? first_q : second_q;
`endif
endmodule

// A flip-flop at a pin.
(* blackbox *)
module OFS1P3BX (
  input  logic D,
  input  logic PD,
  input  logic SP,
  input  logic SCLK,
  output logic Q
);
`ifndef SYNTHESIS
  always_ff @(posedge SCLK) if (SP) Q <= D;
`endif
endmodule

// A pin in both directions, driven while T is 0.
(* blackbox *)
module BB (
  input  logic I,
  input  logic T,
  output logic O,
  inout  wire  B
);
`ifndef SYNTHESIS
  assign B = T ? 1'bz : I;
  assign O = B;
`endif
endmodule
