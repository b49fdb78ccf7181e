// Latches a frame at its start, makes its values legal, and derives its world. So registers may be written during a
// frame, and no other module needs to check a value.
//
// Width, height and depth 0 count as 1, depths above MaxDepth as MaxDepth. Of positions PositionBits bits count. A
// feature that is not built in is off.
module voxrt_frame
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  parameter bit          Lod          = 1'b0
) (
  input  logic   clk_i,
  input  logic   start_i,
  input  frame_t frame_i,
  // Valid from the clock after start_i on.
  output frame_t frame_o,
  output world_t world_o
);
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned DepthBits = $clog2(MaxDepth + 1);
  localparam int unsigned LightBits = light_bits(MaxDepth);

  frame_t legal, frame_q;
  logic [DepthBits-1:0] depth;
  logic signed [PositionBits-1:0] position[3];
  logic signed [LightBits-1:0] light[3];
  logic signed [DistanceBits-1:0] mirrored_origin_q[3];
  logic [MaxDepth:0] side_q;  // One-hot.
  logic [MaxDepth-1:0] outside_mask_q;

  always_comb begin
    legal = frame_i;
    depth = frame_i.depth[DepthBits-1:0];
    if (frame_i.depth == '0) depth = DepthBits'(1);
    if (frame_i.depth > 5'(MaxDepth)) depth = DepthBits'(MaxDepth);
    legal.depth = 5'(depth);
    if (frame_i.width == '0) legal.width = SizeBits'(1);
    if (frame_i.height == '0) legal.height = SizeBits'(1);
    for (int unsigned a = 0; a < 3; a++) begin
      position[a]       = frame_i.position[a][PositionBits-1:0];
      light[a]          = frame_i.light[a][LightBits-1:0];
      legal.position[a] = 32'(position[a]);
      legal.light[a]    = 32'(light[a]);
    end
    legal.shading.light   = Light && frame_i.shading.light;
    legal.shading.ambient = Light ? frame_i.shading.ambient : '0;
    legal.shading.bounces = Mirrors ? frame_i.shading.bounces : '0;
    legal.lod_words       = Lod && frame_i.lod_words;
    legal.lod_scale       = Lod && frame_i.lod_words ? frame_i.lod_scale : '0;
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      frame_q        <= legal;
      side_q         <= (MaxDepth + 1)'(1) << depth;
      outside_mask_q <= '1 << depth;
      for (int unsigned a = 0; a < 3; a++) begin
        mirrored_origin_q[a] <= (DistanceBits'(2 ** FractionBits) << depth) - DistanceBits'(position[a]);
      end
    end
  end

  assign frame_o = frame_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      world_o.origin[a]          = DistanceLimit'($signed(frame_q.position[a]));
      world_o.mirrored_origin[a] = DistanceLimit'(mirrored_origin_q[a]);
    end
    world_o.depth        = frame_q.depth;
    world_o.side         = (DepthLimit + 1)'(side_q);
    world_o.outside_mask = DepthLimit'(outside_mask_q);
  end
endmodule
