// Rays of a frame, for the lanes: one a clock. The camera's rays go to the lanes in turn, each when its lane has a place for
// it; shadow rays (Light) go first, at any clock that they come, for their places are there already.
module voxrt_rays
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes        = 1,
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned TagBits      = 9,
  parameter  bit          Light        = 1'b0,
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned KeyBits      = key_bits(MaxDepth, Light),
  localparam int unsigned DepthBits    = $clog2(MaxDepth + 1),
  localparam int unsigned LitBits      = MaxDepth + LitFractionBits + 2
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Frame; see voxrt_ray_generator and voxrt_ray_setup.
  input  logic                           start_i,
  input  logic                           corner_i,
  input  logic signed [    ScanBits-1:0] line_step_i       [3],
  input  logic signed [  CameraBits-1:0] right_i           [3],
  input  logic        [    SizeBits-1:0] width_i,
  input  logic        [    SizeBits-1:0] height_i,
  input  logic signed [DistanceBits-1:0] origin_i          [3],
  input  logic signed [DistanceBits-1:0] mirrored_origin_i [3],
  input  logic        [   DepthBits-1:0] depth_i,
  input  logic        [      MaxDepth:0] world_i,
  input  logic                           root_leaf_i,
  input  material_t                      root_material_i,
  // Lanes that have a place; the one to which a ray is on its way now.
  input  logic        [       Lanes-1:0] has_place_i,
  output logic        [       Lanes-1:0] promise_o,
  // Shadow rays, from voxrt_light.
  input  logic                           shadow_valid_i,
  input  logic        [       Lanes-1:0] shadow_lane_i,
  input  logic        [     TagBits-1:0] shadow_tag_i,
  input  logic signed [     LitBits-1:0] lit_point_i       [3],
  input  logic signed [    ScanBits-1:0] way_i             [3],
  // Rays, as voxrt_ray_setup makes them.
  output logic                           valid_o,
  output logic        [       Lanes-1:0] lane_o,
  output logic                           resolved_o,
  output pixel_t                         pixel_o,
  output logic                           overflow_o,
  output logic        [             2:0] mirrored_o,
  output logic        [             2:0] dead_o,
  output logic        [             2:0] octant_o,
  output logic        [  WeightBits-1:0] weight_o          [3],
  output logic        [     KeyBits-1:0] entry_time_o,
  output face_e                          entry_face_o,
  output logic signed [DistanceBits-1:0] origin_o          [3],
  output logic                           shadow_o,
  output logic                           lit_o,
  output logic        [     TagBits-1:0] tag_o
);
  logic                       direction_valid, issues;
  logic signed [ScanBits-1:0] direction[3], ray_direction[3];
  logic        [   Lanes-1:0] turn_q;  // One-hot.
  logic                       unused_first, unused_line_end, unused_last;

  assign issues    = direction_valid && (has_place_i & turn_q) != '0 && !shadow_valid_i;
  assign promise_o = issues ? turn_q : '0;

  always_comb for (int unsigned a = 0; a < 3; a++) ray_direction[a] = shadow_valid_i ? way_i[a] : direction[a];

  always_ff @(posedge clk_i) begin
    if (issues) turn_q <= Lanes'({turn_q, turn_q[Lanes-1]});
    if (!rst_ni || start_i) turn_q <= Lanes'(1);
  end

  voxrt_ray_generator u_ray_generator (
    .clk_i,
    .rst_ni,
    .start_i,
    .corner_i,
    .line_step_i,
    .right_i,
    .width_i,
    .height_i,
    .valid_o    (direction_valid),
    .ready_i    (issues),
    .direction_o(direction),
    .first_o    (unused_first),
    .line_end_o (unused_line_end),
    .last_o     (unused_last)
  );

  voxrt_ray_setup #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Lanes       (Lanes),
    .TagBits     (TagBits),
    .Light       (Light)
  ) u_ray_setup (
    .clk_i,
    .rst_ni,
    .origin_i,
    .mirrored_origin_i,
    .depth_i,
    .world_i,
    .root_leaf_i,
    .root_material_i,
    .valid_i    (issues || shadow_valid_i),
    .lane_i     (shadow_valid_i ? shadow_lane_i : turn_q),
    .direction_i(ray_direction),
    .shadow_i   (shadow_valid_i),
    .lit_i      (lit_point_i),
    .tag_i      (shadow_tag_i),
    .valid_o,
    .lane_o,
    .resolved_o,
    .pixel_o,
    .overflow_o,
    .mirrored_o,
    .dead_o,
    .octant_o,
    .weight_o,
    .entry_time_o,
    .entry_face_o,
    .origin_o,
    .shadow_o,
    .lit_o,
    .tag_o
  );
endmodule
