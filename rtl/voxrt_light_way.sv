// From a sub-cell that a ray met to the lit point in it and the way from there to the light, both exact:
//   H_a = 32 p on the axis of the face, H_b = 2 h_b + 1 on the others      D = 2 L - H
// Both after two clocks in which enable_i is high.
module voxrt_light_way
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth  = 10,
  localparam int unsigned PlaceBits = MaxDepth + FractionBits,
  localparam int unsigned LitBits   = PlaceBits + 3,
  localparam int unsigned LightBits = light_bits(MaxDepth),
  localparam int unsigned WayBits   = LightBits + 2
) (
  input  logic                        clk_i,
  input  logic                        enable_i,
  // Held during a frame.
  input  logic        [   MaxDepth:0] world_i,        // One-hot: the world's side, voxels.
  input  logic signed [LightBits-1:0] light_i    [3],  // 1/16 voxel, grid frame.
  // The sub-cell, in 1/16 voxel of the mirrored frame, behind a face.
  input  logic        [PlaceBits-1:0] place_i    [3],
  input  logic        [          2:0] mirrored_i,
  input  face_e                       face_i,
  // 1/32 voxel, grid frame.
  output logic signed [  LitBits-1:0] lit_o      [3],
  output logic signed [  WayBits-1:0] way_o      [3]
);
  logic signed [LitBits-1:0] side, mirrored_lit[3];
  logic signed [LitBits-1:0] lit1_q[3], lit2_q[3];
  logic signed [WayBits-1:0] way2_q[3];

  assign side = {1'b0, world_i, LitFractionBits'(0)};

  always_comb for (int unsigned a = 0; a < 3; a++) mirrored_lit[a] = {2'b0, place_i[a], 2'(a) != face_i};

  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        lit1_q[a] <= mirrored_i[a] ? side - mirrored_lit[a] : mirrored_lit[a];
        lit2_q[a] <= lit1_q[a];
        way2_q[a] <= (WayBits'(light_i[a]) <<< 1) - WayBits'(lit1_q[a]);
      end
    end
  end

  assign lit_o = lit2_q;
  assign way_o = way2_q;
endmodule
