// Cells of the ECP5 that the designs instantiate, for tools that read the sources.
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
endmodule

(* blackbox *)
module ODDRX1F (
  input  logic D0,
  input  logic D1,
  input  logic SCLK,
  input  logic RST,
  output logic Q
);
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
endmodule

// A pin in both directions, driven while T is 0.
(* blackbox *)
module BB (
  input  logic I,
  input  logic T,
  output logic O,
  inout  wire  B
);
endmodule
