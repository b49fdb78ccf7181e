// Gives, for a hit point, the point that is lit and the direction from there to the light, both exact:
//   H_a = 32 p on the axis of the face, H_b = 2 h_b + 1 on the others      D = 2 L - H
// Both come after two clocks in which enable_i is high.
module voxrt_light_direction
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10
) (
  input  logic                                          clk_i,
  input  logic                                          enable_i,
  // Held during a frame.
  input  logic        [               MaxDepth:0]       side_i,          // Voxels, one-hot.
  input  logic        [                      2:0][31:0] light_i,         // 1/16 voxel, grid frame, signed.
  // The hit point; its tag is not used.
  input  hit_point_t                                    hit_point_i,
  // 1/32 voxel, grid frame.
  output logic signed [MaxDepth+FractionBits+2:0]       point_o    [3],
  output logic signed [ light_bits(MaxDepth)+1:0]       direction_o[3]
);
  localparam int unsigned HitBits = MaxDepth + FractionBits;
  localparam int unsigned PointBits = HitBits + 3;
  localparam int unsigned LightBits = light_bits(MaxDepth);
  localparam int unsigned WideBits = LightBits + 2;

  logic signed [PointBits-1:0] side, mirrored_point[3];
  logic signed [LightBits-1:0] light[3];
  logic signed [PointBits-1:0] point1_q[3], point2_q[3];
  logic signed [WideBits-1:0] direction2_q[3];

  assign side = {1'b0, side_i, ShadowFractionBits'(0)};

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      light[a]          = light_i[a][LightBits-1:0];
      mirrored_point[a] = {2'b0, hit_point_i.point[a][HitBits-1:0], 2'(a) != hit_point_i.face};
    end
  end

  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        point1_q[a]     <= hit_point_i.mirrored[a] ? side - mirrored_point[a] : mirrored_point[a];
        point2_q[a]     <= point1_q[a];
        direction2_q[a] <= (WideBits'(light[a]) <<< 1) - WideBits'(point1_q[a]);
      end
    end
  end

  assign point_o     = point2_q;
  assign direction_o = direction2_q;
endmodule
