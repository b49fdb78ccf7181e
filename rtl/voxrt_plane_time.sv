// The time at which a ray crosses a plane: distance * weight, exact, two clocks later.
//
// Cut so that each half is one 25 x 18 multiplier of a 7-series DSP slice and the sum is the second one's adder, 17
// bits up, as the slices are cascaded.
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
  localparam int unsigned LowBits = 17;
  localparam int unsigned HighBits = TimeBits - LowBits;

  logic signed [DistanceBits+LowBits-1:0] low_q;
  logic signed [HighBits-1:0]             high_q, sum_q;
  logic        [LowBits-1:0]              low_bits_q;

  always_ff @(posedge clk_i) begin
    low_q      <= (DistanceBits + LowBits)'(distance_i) * $signed((DistanceBits + LowBits)'(weight_i[LowBits-1:0]));
    high_q     <= HighBits'(distance_i) * $signed(HighBits'(weight_i[WeightBits-1:LowBits]));
    sum_q      <= high_q + HighBits'(low_q >>> LowBits);
    low_bits_q <= low_q[LowBits-1:0];
  end

  assign time_o = {sum_q, low_bits_q};
endmodule
