// The time at which a ray crosses a plane: distance * weight, exact, two clocks later.
//
// The weight is cut in halves so that each product fits one 25 x 18 multiplier of a 7-series DSP slice.
module voxrt_plane_time
  import voxrt_pkg::*;
#(
  parameter  int unsigned DistanceBits = 18,
  localparam int unsigned TimeBits     = DistanceBits + WeightBits
) (
  input  logic                           clk_i,
  input  logic signed [DistanceBits-1:0] distance_i,  // Plane minus origin, 1/16 voxel.
  input  logic        [  WeightBits-1:0] weight_i,
  output logic signed [    TimeBits-1:0] time_o
);
  localparam int unsigned LowBits = WeightBits / 2;
  localparam int unsigned PartBits = DistanceBits + LowBits + 1;

  logic signed [PartBits-1:0] low_q, high_q;
  logic signed [TimeBits-1:0] time_q;

  always_ff @(posedge clk_i) begin
    low_q  <= PartBits'(distance_i) * $signed(PartBits'(weight_i[LowBits-1:0]));
    high_q <= PartBits'(distance_i) * $signed(PartBits'(weight_i[WeightBits-1:LowBits]));
    time_q <= TimeBits'(low_q) + (TimeBits'(high_q) <<< LowBits);
  end

  assign time_o = time_q;
endmodule
