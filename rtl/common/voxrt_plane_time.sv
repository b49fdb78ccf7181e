// The time at which a ray crosses a plane: distance * weight, exact, three clocks later.
//
// It is no voxrt_multiply because the distance has a sign, and because this product is the longest path of a lane: here
// each multiplier has a register right behind it. voxrt_pkg::MultiplierBits says what the part has.
//
// 25 x 18: each half is one DSP slice of a 7-series part, and the sum is the second one's adder, 17 bits up, as the
// slices are cascaded. 18 x 18: three parts of the weight and up to two of the distance.
module voxrt_plane_time
  import voxrt_pkg::*;
#(
  parameter int unsigned DistanceBits = 18,                        // Signed: 2 .. DistanceLimit.
  // T modulo 2**TimeBits: 18 .. DistanceBits + WeightBits.
  parameter int unsigned TimeBits     = DistanceBits + WeightBits
) (
  input  logic                           clk_i,
  input  logic signed [DistanceBits-1:0] distance_i,  // Plane minus origin, 1/16 voxel.
  input  logic        [  WeightBits-1:0] weight_i,
  output logic signed [    TimeBits-1:0] time_o
);
  if (DistanceBits < 2 || DistanceBits > DistanceLimit)
    $error("voxrt_plane_time: DistanceBits must be 2 to DistanceLimit bits");
  if (TimeBits < 18 || TimeBits > DistanceBits + WeightBits)
    $error("voxrt_plane_time: TimeBits must be 18 to DistanceBits + WeightBits bits");

  if (MultiplierBits >= 25) begin : gen_wide
    localparam int unsigned LowBits = 17;
    localparam int unsigned HighBits = TimeBits - LowBits;

    logic signed [DistanceBits+LowBits-1:0] low1_q, low2_q;
    logic signed [DistanceBits-1:0] distance1_q;
    logic [WeightBits-LowBits-1:0] weight1_q;
    logic signed [HighBits-1:0] high2_q, sum3_q;
    logic [LowBits-1:0] low3_q;

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
    localparam int unsigned PartBits = 14;
    localparam int unsigned Parts = 3;
    localparam int unsigned LowBits = MultiplierSide;  // The lower part of the distance.
    localparam int unsigned ProductBits = MultiplierBits + PartBits;

    logic [Parts*PartBits-1:0] weight;
    logic signed [PartBits : 0] weight_part[Parts];
    logic signed [DistanceBits+PartBits-1:0] part2_q[Parts];

    assign weight = (Parts * PartBits)'(weight_i);

    always_comb begin
      for (int unsigned i = 0; i < Parts; i++) weight_part[i] = $signed({1'b0, weight[i*PartBits+:PartBits]});
    end

    if (DistanceBits > MultiplierBits) begin : gen_two
      localparam int unsigned HighBits = DistanceBits - LowBits;

      logic signed [LowBits:0] low_distance;
      logic signed [HighBits-1:0] high_distance;
      logic signed [ProductBits-1:0] low1_q[Parts];
      logic signed [HighBits+PartBits-1:0] high1_q[Parts];

      assign low_distance  = $signed({1'b0, distance_i[LowBits-1:0]});
      assign high_distance = distance_i[DistanceBits-1:LowBits];

      always_ff @(posedge clk_i) begin
        for (int unsigned i = 0; i < Parts; i++) begin
          low1_q[i]  <= ProductBits'(low_distance) * ProductBits'(weight_part[i]);
          high1_q[i] <= (HighBits + PartBits)'(high_distance) * (HighBits + PartBits)'(weight_part[i]);
          part2_q[i] <= {high1_q[i] + (HighBits + PartBits)'(low1_q[i] >>> LowBits), low1_q[i][LowBits-1:0]};
        end
      end
    end else begin : gen_one
      logic signed [DistanceBits+PartBits-1:0] part1_q[Parts];

      always_ff @(posedge clk_i) begin
        for (int unsigned i = 0; i < Parts; i++) begin
          part1_q[i] <= (DistanceBits + PartBits)'(distance_i) * (DistanceBits + PartBits)'(weight_part[i]);
          part2_q[i] <= part1_q[i];
        end
      end
    end

    localparam int unsigned UpperBits = TimeBits - PartBits;

    logic signed [UpperBits-1:0] sum3_q;
    logic [PartBits-1:0] low3_q;

    always_ff @(posedge clk_i) begin
      sum3_q <= UpperBits'(part2_q[1]) + $signed({(UpperBits - PartBits)'(part2_q[2]), PartBits'(0)}) +
          UpperBits'(part2_q[0] >>> PartBits);
      low3_q <= part2_q[0][PartBits-1:0];
    end

    assign time_o = {sum3_q, low3_q};
  end
endmodule
