// The time at which a ray crosses a plane: distance * weight, exact, three clocks later.
//
// Cut to the multipliers of the part (voxrt_pkg::MultiplierBits). 25 x 18: each half is one DSP slice of a 7-series
// part, and the sum is the second one's adder, 17 bits up, as the slices are cascaded. 18 x 18: three parts, the
// upper two a clock later from registers of their own, as the paths to multipliers are long.
module voxrt_plane_time
  import voxrt_pkg::*;
#(
  parameter int unsigned DistanceBits = 18,
  parameter int unsigned TimeBits     = DistanceBits + WeightBits  // Fewer: T modulo 2**TimeBits.
) (
  input  logic                           clk_i,
  input  logic signed [DistanceBits-1:0] distance_i,  // Plane minus origin, 1/16 voxel.
  input  logic        [  WeightBits-1:0] weight_i,
  output logic signed [    TimeBits-1:0] time_o
);
  if (MultiplierBits >= 25) begin : gen_wide
    localparam int unsigned LowBits = 17;
    localparam int unsigned HighBits = TimeBits - LowBits;

    logic signed [    DistanceBits+LowBits-1:0] low1_q, low2_q;
    logic signed [            DistanceBits-1:0] distance1_q;
    logic        [WeightBits-LowBits-1:0]       weight1_q;
    logic signed [                HighBits-1:0] high2_q, sum3_q;
    logic        [                 LowBits-1:0] low3_q;

    always_ff @(posedge clk_i) begin
      low1_q      <= (DistanceBits + LowBits)'(distance_i) * $signed((DistanceBits + LowBits)'(weight_i[LowBits-1:0]));
      low2_q      <= low1_q;
      distance1_q <= distance_i;
      weight1_q   <= weight_i[WeightBits-1:LowBits];
      high2_q     <= HighBits'(distance1_q) * $signed(HighBits'(weight1_q));
      sum3_q      <= high2_q + HighBits'(low2_q >>> LowBits);
      low3_q      <= low2_q[LowBits-1:0];
    end

    assign time_o = {sum3_q, low3_q};
  end else begin : gen_narrow
    localparam int unsigned LowBits = 14;
    localparam int unsigned MiddleBits = 13;
    localparam int unsigned UpperBits = TimeBits - LowBits;
    localparam int unsigned HighBits = UpperBits - MiddleBits;

    logic signed [   DistanceBits+LowBits-1:0] low1_q, low2_q;
    logic signed [           DistanceBits-1:0] distance1_q;
    logic        [     WeightBits-LowBits-1:0] weight1_q;
    logic signed [DistanceBits+MiddleBits-1:0] middle2_q;
    logic signed [               HighBits-1:0] high2_q;
    logic signed [              UpperBits-1:0] sum3_q;
    logic        [                LowBits-1:0] low3_q;

    always_ff @(posedge clk_i) begin
      low1_q      <= (DistanceBits + LowBits)'(distance_i) * $signed((DistanceBits + LowBits)'(weight_i[LowBits-1:0]));
      low2_q      <= low1_q;
      distance1_q <= distance_i;
      weight1_q   <= weight_i[WeightBits-1:LowBits];
      middle2_q   <= (DistanceBits + MiddleBits)'(distance1_q) *
          $signed((DistanceBits + MiddleBits)'(weight1_q[MiddleBits-1:0]));
      high2_q     <= HighBits'(distance1_q) * $signed(HighBits'(weight1_q[WeightBits-LowBits-1:MiddleBits]));
      sum3_q      <= UpperBits'(middle2_q) + $signed({high2_q, MiddleBits'(0)}) + UpperBits'(low2_q >>> LowBits);
      low3_q      <= low2_q[LowBits-1:0];
    end

    assign time_o = {sum3_q, low3_q};
  end
endmodule
