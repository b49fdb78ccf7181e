// From a direction to a ray that a lane can follow: mirrored, weighed, and entered into the world. One ray a clock.
//
// The weight of an axis is the product of the other two components (0 counts as 1), so that the plane p is crossed at
// T = (16 p - origin) * weight, an integer. Planes are ordered by (T, axis). The entry key is the last of the world's
// near planes, (0, FaceNone) for a camera inside. A ray that does not meet the world, or meets a world of one leaf,
// comes out resolved.
//
// An axis on which the ray does not move is dead: its planes are crossed before the start or never. Setting the
// fraction of its origin to 15/16 keeps planes and origin apart, so that the sign of T alone tells which.
//
// Shadow rays share the pipeline (Light): each has an origin of its own, in 1/32 voxel and in the world, and its entry key
// is (0, FaceNone). A lane reads one word in four turns or so for them; one setup has time for both kinds.
//
// Pipeline: sign and size | multiply | weight | plane 0: multiply | sum | compare | entry key | compare | out.
module voxrt_ray_setup
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned Lanes        = 1,
  parameter  int unsigned TagBits      = 8,
  parameter  bit          Light        = 1'b0,
  localparam int unsigned LitBits      = MaxDepth + LitFractionBits + 2,
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned TimeBits     = DistanceBits + WeightBits,
  localparam int unsigned KeyBits      = key_bits(MaxDepth, Light),
  localparam int unsigned DepthBits    = $clog2(MaxDepth + 1)
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Held during a frame.
  input  logic signed [DistanceBits-1:0] origin_i          [3],
  input  logic signed [DistanceBits-1:0] mirrored_origin_i [3],  // 16 * side - origin.
  input  logic        [   DepthBits-1:0] depth_i,
  input  logic        [      MaxDepth:0] world_i,                // One-hot: the world's side.
  input  logic                           root_leaf_i,            // The whole world is one leaf ...
  input  material_t                      root_material_i,        // ... of this material.
  // Directions, each for one lane (one-hot).
  input  logic                           valid_i,
  input  logic        [       Lanes-1:0] lane_i,
  input  logic signed [    ScanBits-1:0] direction_i       [3],
  input  logic                           shadow_i,               // A shadow ray, from ...
  input  logic signed [     LitBits-1:0] lit_i             [3],  // ... this point, 1/32 voxel, grid frame.
  input  logic        [     TagBits-1:0] tag_i,
  // Rays, in the same order.
  output logic                           valid_o,
  output logic        [       Lanes-1:0] lane_o,
  output logic                           resolved_o,             // pixel_o is the answer; nothing to trace.
  output pixel_t                         pixel_o,
  output logic                           overflow_o,             // A component was 2**DirectionBits or more.
  output logic        [             2:0] mirrored_o,
  output logic        [             2:0] dead_o,
  output logic        [             2:0] octant_o,               // First octant of the root, mirrored frame.
  output logic        [  WeightBits-1:0] weight_o          [3],
  output logic        [     KeyBits-1:0] entry_time_o,            // As lanes compare it.
  output face_e                          entry_face_o,
  output logic signed [DistanceBits-1:0] origin_o          [3],  // Mirrored frame.
  output logic                           shadow_o,
  output logic                           lit_o,                  // The answer, of a shadow ray that is resolved.
  output logic        [     TagBits-1:0] tag_o
);
  localparam int unsigned Stages = 9;

  // What travels along unchanged.
  logic [Stages:1]            valid_q;
  logic [Lanes-1:0]           lane_q     [1:Stages];
  logic [2:0]                 mirrored_q [1:Stages];
  logic [2:0]                 dead_q     [1:Stages];
  logic [Stages:1]            overflow_q;
  logic [WeightBits-1:0]      weight_q   [3:Stages] [3];

  always_ff @(posedge clk_i) begin
    valid_q <= rst_ni ? {valid_q[Stages-1:1], valid_i} : '0;
    for (int unsigned s = 2; s <= Stages; s++) begin
      lane_q[s]     <= lane_q[s-1];
      mirrored_q[s] <= mirrored_q[s-1];
      dead_q[s]     <= dead_q[s-1];
      overflow_q[s] <= overflow_q[s-1];
    end
    for (int unsigned s = 4; s <= Stages; s++) begin
      if (valid_q[s-1]) weight_q[s] <= weight_q[s-1];
    end
    lane_q[1] <= lane_i;
  end

  // Shadow rays.
  logic signed [DistanceBits-1:0] origin2[3];
  logic                           shadow3;

  if (Light) begin : gen_light
    logic        [  Stages:1] shadow_q;
    logic        [TagBits-1:0] tag_q[1:Stages];
    logic signed [LitBits-1:0] lit_q[1:Stages][3];

    always_ff @(posedge clk_i) begin
      shadow_q <= {shadow_q[Stages-1:1], shadow_i};
      tag_q[1] <= tag_i;
      lit_q[1] <= lit_i;
      for (int unsigned s = 2; s <= Stages; s++) begin
        tag_q[s] <= tag_q[s-1];
        lit_q[s] <= lit_q[s-1];
      end
      for (int unsigned a = 0; a < 3; a++) lit_q[3][a] <= LitBits'(origin2[a]);
    end

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        origin2[a]  = mirrored_q[2][a] ? mirrored_origin_i[a] : origin_i[a];
        origin_o[a] = mirrored_q[Stages][a] ? mirrored_origin_i[a] : origin_i[a];
        if (shadow_q[2]) begin
          origin2[a] = DistanceBits'(lit_q[2][a]);
          if (mirrored_q[2][a]) origin2[a] = DistanceBits'({world_i, LitFractionBits'(0)}) - DistanceBits'(lit_q[2][a]);
        end
        if (shadow_q[Stages]) origin_o[a] = DistanceBits'(lit_q[Stages][a]);
      end
    end

    assign shadow3  = shadow_q[3];
    assign shadow_o = shadow_q[9];
    assign tag_o    = tag_q[9];
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light = &{shadow_i, tag_i, lit_i[0], lit_i[1], lit_i[2], world_i};
    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        origin2[a]  = mirrored_q[2][a] ? mirrored_origin_i[a] : origin_i[a];
        origin_o[a] = mirrored_q[Stages][a] ? mirrored_origin_i[a] : origin_i[a];
      end
    end
    assign {shadow3, shadow_o} = '0;
    assign tag_o = '0;
  end

  // 1: sign and size.
  logic [DirectionBits-1:0] size_q[3];
  logic [2:0]               too_large;
  logic [ScanBits-1:0]      magnitude[3];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      magnitude[a] = direction_i[a] < 0 ? -direction_i[a] : direction_i[a];
      too_large[a] = magnitude[a][ScanBits-1:DirectionBits] != '0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        mirrored_q[1][a] <= direction_i[a] < 0;
        dead_q[1][a]     <= direction_i[a] == 0;
        // A zero counts as 1 in the weights of the other axes.
        size_q[a]        <= magnitude[a][DirectionBits-1:0] | DirectionBits'(direction_i[a] == 0);
      end
      overflow_q[1] <= too_large != '0;
    end
  end

  // 2, 3: weights.
  logic [WeightBits-1:0]          product_q [3];
  logic signed [DistanceBits-1:0] distance_q[3];  // From the origin to the near plane.

  always_ff @(posedge clk_i) begin
    if (valid_q[1]) begin
      product_q[0] <= WeightBits'(size_q[1]) * WeightBits'(size_q[2]);
      product_q[1] <= WeightBits'(size_q[2]) * WeightBits'(size_q[0]);
      product_q[2] <= WeightBits'(size_q[0]) * WeightBits'(size_q[1]);
    end
    if (valid_q[2]) begin
      weight_q[3] <= product_q;
      for (int unsigned a = 0; a < 3; a++) begin
        distance_q[a] <= -(origin2[a] | DistanceBits'(dead_q[2][a] ? 2 ** FractionBits - 1 : 0));
      end
    end
  end

  // 4, 5: plane 0, and how long the ray takes through half of the world.
  logic signed [TimeBits-1:0] near_time [3];
  logic signed [TimeBits-1:0] half_span_q [4:5] [3];

  for (genvar a = 0; a < 3; a++) begin : gen_near
    voxrt_plane_time #(
      .DistanceBits(DistanceBits)
    ) u_near (
      .clk_i,
      .distance_i(distance_q[a]),
      .weight_i  (weight_q[3][a]),
      .time_o    (near_time[a])
    );
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      if (valid_q[3]) half_span_q[4][a] <= TimeBits'(weight_q[3][a]) << (shadow3 ? FractionBits : FractionBits - 1);
      if (valid_q[4]) half_span_q[5][a] <= half_span_q[4][a] << depth_i;
    end
  end

  // 6: middle and far planes; order of the near planes.
  logic signed [TimeBits-1:0] near_q [3], middle_q[6:7] [3], far_q[6:7] [3];
  logic [2:0]                 ahead_q;  // The near plane is yet to be crossed.
  logic                       later_yx_q, later_zx_q, later_zy_q;
  logic [2:0]                 ahead;

  always_comb for (int unsigned a = 0; a < 3; a++) ahead[a] = near_time[a] > 0;

  always_ff @(posedge clk_i) begin
    if (valid_q[5]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        near_q[a]      <= near_time[a];
        middle_q[6][a] <= near_time[a] + half_span_q[5][a];
        far_q[6][a]    <= near_time[a] + (half_span_q[5][a] <<< 1);
      end
      ahead_q    <= ahead;
      later_yx_q <= near_time[1] >= near_time[0];
      later_zx_q <= near_time[2] >= near_time[0];
      later_zy_q <= near_time[2] >= near_time[1];
    end
    if (valid_q[6]) begin
      middle_q[7] <= middle_q[6];
      far_q[7]    <= far_q[6];
    end
  end

  // 7: the entry key, the last near plane that is ahead.
  logic signed [TimeBits-1:0] entry_time_q[7:8];
  logic        [KeyBits-1:0]  entry_time9_q;
  face_e                      entry_face_q[7:9];
  logic [2:0]                 enters;
  logic [9:7]                 outside_q;

  assign enters    = ahead_q & ~dead_q[6];

  always_ff @(posedge clk_i) begin
    if (valid_q[6]) begin
      entry_time_q[7] <= '0;
      entry_face_q[7] <= FaceNone;
      if (enters[2] && (!enters[1] || later_zy_q) && (!enters[0] || later_zx_q)) begin
        entry_time_q[7] <= near_q[2];
        entry_face_q[7] <= FaceZ;
      end else if (enters[1] && (!enters[0] || later_yx_q)) begin
        entry_time_q[7] <= near_q[1];
        entry_face_q[7] <= FaceY;
      end else if (enters[0]) begin
        entry_time_q[7] <= near_q[0];
        entry_face_q[7] <= FaceX;
      end
      outside_q[7] <= (ahead_q & dead_q[6]) != '0;
    end
  end

  // 8: which middle and far planes come before the entry.
  logic [2:0] past_middle_q[8:9], past_far_q;

  always_ff @(posedge clk_i) begin
    if (valid_q[7]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        past_middle_q[8][a] <= dead_q[7][a] ? middle_q[7][a] < 0
            : $signed({middle_q[7][a], 1'b0}) < $signed({entry_time_q[7], 2'(a) <= entry_face_q[7]});
        past_far_q[a] <= dead_q[7][a] ? far_q[7][a] < 0
            : $signed({far_q[7][a], 1'b0}) < $signed({entry_time_q[7], 2'(a) <= entry_face_q[7]});
      end
      entry_time_q[8] <= entry_time_q[7];
      entry_face_q[8] <= entry_face_q[7];
      outside_q[8]    <= outside_q[7];
    end
  end

  // 9: out.
  always_ff @(posedge clk_i) begin
    if (valid_q[8]) begin
      entry_time9_q    <= KeyBits'(entry_time_q[8]);
      entry_face_q[9]  <= entry_face_q[8];
      past_middle_q[9] <= past_middle_q[8];
      outside_q[9]     <= outside_q[8] || past_far_q != '0 || overflow_q[8];
    end
  end

  assign valid_o      = valid_q[9];
  assign lane_o       = lane_q[9];
  assign resolved_o   = outside_q[9] || root_leaf_i;
  assign overflow_o   = overflow_q[9];
  assign mirrored_o   = mirrored_q[9];
  assign dead_o       = dead_q[9];
  assign octant_o     = past_middle_q[9];
  assign weight_o     = weight_q[9];
  assign entry_time_o = entry_time9_q;
  assign entry_face_o = entry_face_q[9];
  assign lit_o        = !overflow_q[9];

  always_comb begin
    pixel_o = '{material: '0, face: FaceNone};
    if (!outside_q[9] && root_material_i != '0) pixel_o = '{material: root_material_i, face: entry_face_q[9]};
  end
endmodule
