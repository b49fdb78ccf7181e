// Makes a ray that a lane can trace of a direction: mirrored, weighed, and entered into the world. One setup serves all
// lanes, with one ray per RayClocks clocks, when ready_o is high.
//
// The weight of an axis is the product of the other two components (0 counts as 1), so that the plane p is crossed at
// T = (16 p - origin) * weight, an integer. Planes are ordered by (T, axis). The entry key is the last of the world's
// near planes, (0, FaceNone) for a camera inside. A ray that does not meet the world, or meets a world of one leaf,
// comes out resolved.
//
// An axis on which the ray does not move is dead: its planes are crossed before the start or never. Its origin counts
// as above the plane that it is on, so that the sign of T alone tells which: planes up to the origin have T < 0.
//
// Shadow rays share the pipeline (Light): each has an origin of its own, in 1/32 voxel and in the world, and its entry
// key is (0, FaceNone). Lanes read a dozen words per ray: one setup has time for both kinds.
//
// Pipeline: sign and size | multiply | weight | plane 0: three clocks | compare | entry key | key - plane 0, half of
// the world's time | compare | out.
module voxrt_ray_setup
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned Lanes        = 1,
  parameter bit          Light        = 1'b0,
  parameter bit          Lod          = 1'b0,
  parameter int unsigned RayClocks    = 1      // 1, or 4: one multiplier for three axes.
) (
  input logic clk_i,
  input logic rst_ni,
  // Held during a frame.
  input world_t world_i,
  input logic root_leaf_i,  // The whole world is one leaf.
  input material_t root_material_i,  // The material of that leaf.
  input logic [LodScaleBits-1:0] lod_scale_i,  // 0: off.
  // Directions.
  input logic valid_i,
  output logic ready_o,
  input logic [Lanes-1:0] lane_i,  // One-hot: which lane the ray is for.
  input logic signed [ScanBits-1:0] direction_i[3],
  input logic shadow_i,  // The ray is a shadow ray.
  input logic [2:0][ShadowPointLimit-1:0] point_i,  // Where a shadow ray starts, 1/32 voxel, grid frame, signed.
  input logic [TagBits-1:0] tag_i,
  // Rays, in the same order.
  output logic valid_o,
  output logic [Lanes-1:0] lane_o,
  output logic overflow_o,  // A component was 2**DirectionBits or more.
  output ray_t ray_o,
  output weights_t weights_o
);
  localparam int unsigned PointBits = MaxDepth + ShadowFractionBits + 2;
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned TimeBits = DistanceBits + WeightBits;
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);
  localparam int unsigned DepthBits = $clog2(MaxDepth + 1);
  localparam int unsigned Stages = 11;
  // The world's side, in time.
  localparam int unsigned SpanBits = WeightBits + (Light ? ShadowFractionBits : FractionBits) + MaxDepth;
  // Bits of the difference of two times that are compared.
  localparam int unsigned GapBits = TimeBits + 1;

  // Frame.
  logic signed [DistanceBits-1:0] world_origin[3], mirrored_world_origin[3];
  logic [DepthBits-1:0] depth;
  logic [MaxDepth:0] side;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      world_origin[a]          = world_i.origin[a][DistanceBits-1:0];
      mirrored_world_origin[a] = world_i.mirrored_origin[a][DistanceBits-1:0];
    end
    depth = world_i.depth[DepthBits-1:0];
    side  = world_i.side[MaxDepth:0];
  end

  // The pipeline moves when `advance` is high; `moves` says it of the stages that hold a ray.
  logic advance, takes;
  logic [1:0] turn;

  voxrt_turns #(
    .RayClocks(RayClocks)
  ) u_turns (
    .clk_i,
    .rst_ni,
    .turn_o   (turn),
    .advance_o(advance)
  );

  assign ready_o = advance;

  // With many lanes valid_i is a long path, so it does not enable the multipliers. They may read a direction without a
  // ray.
  if (many_lanes(Lanes)) begin : gen_takes_all
    assign takes = advance;
  end else begin : gen_takes
    assign takes = valid_i && advance;
  end

  // What travels along unchanged.
  logic [Stages:1] valid_q, moves;
  logic [Lanes-1:0] lane_q[1:Stages];
  logic [2:0] mirrored_q[1:Stages];
  logic [2:0] dead_q[1:Stages];
  logic [Stages:1] overflow_q;
  logic [WeightBits-1:0] weight3[3];
  logic [WeightBits-1:0] weight_q[4:Stages][3];

  assign moves = advance ? valid_q : '0;

  always_ff @(posedge clk_i) begin
    if (advance) begin
      valid_q   <= {valid_q[Stages-1:1], valid_i};
      lane_q[1] <= lane_i;
      for (int unsigned s = 2; s <= Stages; s++) begin
        lane_q[s]     <= lane_q[s-1];
        mirrored_q[s] <= mirrored_q[s-1];
        dead_q[s]     <= dead_q[s-1];
        overflow_q[s] <= overflow_q[s-1];
      end
    end
    if (!rst_ni) valid_q <= '0;
    // Registers keep what they have where no ray is.
    if (moves[3]) weight_q[4] <= weight3;
    for (int unsigned s = 5; s <= Stages; s++) begin
      if (moves[s-1]) weight_q[s] <= weight_q[s-1];
    end
  end

  // 1: sign and size.
  logic [DirectionBits-1:0] size_q[3];
  logic [DirectionBits:0] magnitude[3];
  logic [2:0] negative, zero, too_large;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      negative[a] = direction_i[a] < 0;
      zero[a] = direction_i[a] == 0;
      // A component is too large if a bit above its size differs from the sign; of -2**DirectionBits the size shows it.
      magnitude[a] = (direction_i[a][DirectionBits:0] ^ {(DirectionBits + 1){negative[a]}}) +
          (DirectionBits + 1)'(negative[a]);
      too_large[a] = magnitude[a][DirectionBits] ||
          direction_i[a][ScanBits-1:DirectionBits] != {(ScanBits - DirectionBits){negative[a]}};
    end
  end

  always_ff @(posedge clk_i) begin
    if (takes) begin
      mirrored_q[1] <= negative;
      dead_q[1]     <= zero;
      // A zero counts as 1 in the weights of the other axes.
      for (int unsigned a = 0; a < 3; a++) size_q[a] <= magnitude[a][DirectionBits-1:0] | DirectionBits'(zero[a]);
      overflow_q[1] <= too_large != '0;
    end
  end

  // Shadow rays, in stages 2 and 7: their origin, in the mirrored frame.
  logic shadow2, shadow7;
  logic signed [DistanceBits-1:0] point2[3];

  // 2, 3: weights; from the origin to the near plane, as voxrt_lane does it.
  logic signed [DistanceBits-1:0] distance_q[3], origin[3], other_origin[3];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      origin[a]       = mirrored_q[2][a] ? mirrored_world_origin[a] : world_origin[a];
      other_origin[a] = mirrored_q[2][a] ? world_origin[a] : mirrored_world_origin[a];
    end
  end

  logic [DirectionBits-1:0] next_size[3], previous_size[3];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      next_size[a]     = size_q[(a+1)%3];
      previous_size[a] = size_q[(a+2)%3];
    end
  end

  voxrt_three_products #(
    .RayClocks(RayClocks),
    .ABits    (DirectionBits),
    .BBits    (DirectionBits),
    .LogicBits({3{8'(DirectionBits - MultiplierSide)}})
  ) u_weights (
    .clk_i,
    .turn_i   (turn),
    .advance_i(advance),
    .a_i      (next_size),
    .b_i      (previous_size),
    .product_o(weight3)
  );

  always_ff @(posedge clk_i) begin
    if (moves[2]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        distance_q[a][FractionBits-1:0] <= other_origin[a][FractionBits-1:0];
        distance_q[a][DistanceBits-1:FractionBits] <= ~origin[a][DistanceBits-1:FractionBits] +
            (DistanceBits - FractionBits)'(world_origin[a][FractionBits-1:0] == '0 && !dead_q[2][a]);
        // The origin of a shadow ray is on no plane of a dead axis.
        if (shadow2) distance_q[a] <= -point2[a];
      end
    end
  end

  // Shadow rays.
  logic shadow11;
  logic [TagBits-1:0] tag11;
  logic signed [DistanceBits-1:0] point11[3];

  if (Light) begin : gen_light
    logic [Stages:1] shadow_q;
    logic [TagBits-1:0] tag_q[1:Stages];
    logic signed [PointBits-1:0] point_q[1:Stages][3];

    always_ff @(posedge clk_i) begin
      if (advance) begin
        shadow_q <= {shadow_q[Stages-1:1], shadow_i};
        tag_q[1] <= tag_i;
        for (int unsigned a = 0; a < 3; a++) point_q[1][a] <= point_i[a][PointBits-1:0];
        for (int unsigned s = 2; s <= Stages; s++) begin
          tag_q[s]   <= tag_q[s-1];
          point_q[s] <= point_q[s-1];
        end
        // Mirrored from here on.
        for (int unsigned a = 0; a < 3; a++) point_q[3][a] <= PointBits'(point2[a]);
      end
    end

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        point2[a] = DistanceBits'(point_q[2][a]);
        if (mirrored_q[2][a]) begin
          point2[a] = DistanceBits'({side, ShadowFractionBits'(0)}) - DistanceBits'(point_q[2][a]);
        end
        point11[a] = DistanceBits'(point_q[11][a]);
      end
    end

    assign shadow2  = shadow_q[2];
    assign shadow7  = shadow_q[7];
    assign shadow11 = shadow_q[11];
    assign tag11    = tag_q[11];
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light                 = &{shadow_i, tag_i, point_i, side};
    assign {shadow2, shadow7, shadow11} = '0;
    assign point2                       = '{default: '0};
    assign point11                      = '{default: '0};
    assign tag11                        = '0;
  end

  // 2 to 5: the reach of voxrt_lod, its largest component times the scale, plus one; none where that is beyond all
  // distances.
  localparam int unsigned WholeBits = DistanceBits - FractionBits;
  logic [ReachLimit-1:0] reach11;

  if (Lod) begin : gen_lod
    localparam int unsigned ProductBits = DirectionBits + LodScaleBits;
    localparam logic [WholeBits-1:0] NoReach = {1'b1, (WholeBits - 1)'(0)};
    logic [DirectionBits-1:0] larger_size, largest_q;
    logic [ProductBits-1:0] product4;
    logic [LodScaleBits:0] reach;
    logic [WholeBits-1:0] reach_q[5:Stages];

    assign larger_size = size_q[0] > size_q[1] ? size_q[0] : size_q[1];

    always_ff @(posedge clk_i) if (valid_q[1]) largest_q <= larger_size > size_q[2] ? larger_size : size_q[2];

    voxrt_multiply #(
      .ABits(DirectionBits),
      .BBits(LodScaleBits)
    ) u_reach (
      .clk_i,
      .a_i      (largest_q),
      .b_i      (lod_scale_i),
      .product_o(product4)
    );

    assign reach = {1'b0, product4[ProductBits-1-:LodScaleBits]} + 1'b1;

    always_ff @(posedge clk_i) begin
      if (valid_q[4]) begin
        reach_q[5] <= lod_scale_i == '0 || 32'(reach) >= 32'(NoReach) ? NoReach : WholeBits'(reach);
      end
      for (int unsigned s = 6; s <= Stages; s++) if (valid_q[s-1]) reach_q[s] <= reach_q[s-1];
    end

    logic unused_product;
    assign unused_product = ^product4[DirectionBits-1:0];

    assign reach11        = ReachLimit'(reach_q[11]);
  end else begin : gen_no_lod
    logic unused_scale;
    assign unused_scale = ^lod_scale_i;
    assign reach11      = '0;
  end

  // 4, 5, 6: plane 0.
  logic signed [TimeBits-1:0] near_time[3];

  voxrt_three_plane_times #(
    .RayClocks   (RayClocks),
    .DistanceBits(DistanceBits)
  ) u_near (
    .clk_i,
    .turn_i    (turn),
    .advance_i (advance),
    .distance_i(distance_q),
    .weight_i  (weight3),
    .time_o    (near_time)
  );

  // 7: order of the near planes.
  logic signed [TimeBits-1:0] near_q[7:8][3];
  logic [2:0] ahead_q, enters_q;  // The near plane is yet to be crossed; by moving.
  logic later_yx_q, later_zx_q, later_zy_q;

  always_ff @(posedge clk_i) begin
    if (moves[6]) begin
      near_q[7] <= near_time;
      // On a dead axis no plane is at the origin, and 0 is ahead.
      for (int unsigned a = 0; a < 3; a++) begin
        ahead_q[a]  <= !near_time[a][TimeBits-1] && (dead_q[6][a] || near_time[a] != '0);
        enters_q[a] <= !near_time[a][TimeBits-1] && !dead_q[6][a] && near_time[a] != '0;
      end
      later_yx_q <= near_time[1] >= near_time[0];
      later_zx_q <= near_time[2] >= near_time[0];
      later_zy_q <= near_time[2] >= near_time[1];
    end
  end

  // 8: the entry key, the last near plane that is ahead.
  logic signed [TimeBits-1:0] near[4], entry_time_q;
  logic [KeyBits-1:0] entry_time_key_q[9:11];
  face_e entry_face, entry_face_q[8:11];
  logic [11:8] outside_q;

  assign near = '{near_q[7][0], near_q[7][1], near_q[7][2], '0};

  always_comb begin
    entry_face = FaceNone;
    if (enters_q[0]) entry_face = FaceX;
    if (enters_q[1] && (!enters_q[0] || later_yx_q)) entry_face = FaceY;
    if (enters_q[2] && (!enters_q[1] || later_zy_q) && (!enters_q[0] || later_zx_q)) entry_face = FaceZ;
  end

  always_ff @(posedge clk_i) begin
    if (moves[7]) begin
      entry_time_q    <= near[entry_face];
      entry_face_q[8] <= entry_face;
      outside_q[8]    <= (ahead_q & dead_q[7]) != '0;
      near_q[8]       <= near_q[7];
    end
  end

  // 9: near plane - key - 1, where a dead axis has the key 0; how long the ray takes through half of the world, which
  // is 16 * weight * side / 2.
  logic signed [GapBits-1:0] gap_q[3];
  logic [SpanBits-2:0] half_span8_q[3], half_span_q[3];

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      if (moves[7]) begin
        half_span8_q[a] <= (SpanBits - 1)'(weight_q[7][a]) << {1'b0, depth[0]} << (FractionBits - 1) << shadow7;
      end
      if (moves[8]) begin
        half_span_q[a] <= half_span8_q[a] << {depth[DepthBits-1:1], 1'b0};
        gap_q[a]       <= GapBits'(near_q[8][a]) + ~(dead_q[8][a] ? '0 : GapBits'(entry_time_q));
      end
    end
    if (moves[8]) begin
      entry_time_key_q[9] <= KeyBits'(entry_time_q);
      entry_face_q[9]     <= entry_face_q[8];
      outside_q[9]        <= outside_q[8];
    end
  end

  // 10: which middle and far planes come before the entry: their T less the key is below 0, or is 0 and the axis comes
  // first. In whole numbers, less one: below 0.
  logic [2:0] last;  // Which of two equal times comes last.
  logic [GapBits:0] middle[3], far[3];
  logic [2:0] past_middle_q[10:11], past_far_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      last[a]   = dead_q[9][a] || 2'(a) > entry_face_q[9];
      middle[a] = {gap_q[a], 1'b1} + (GapBits + 1)'({half_span_q[a], last[a]});
      far[a]    = {gap_q[a], 1'b1} + (GapBits + 1)'({half_span_q[a], 1'b0, last[a]});
    end
  end

  always_ff @(posedge clk_i) begin
    if (moves[9]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        past_middle_q[10][a] <= middle[a][GapBits];
        past_far_q[a]        <= far[a][GapBits];
      end
      entry_time_key_q[10] <= entry_time_key_q[9];
      entry_face_q[10]     <= entry_face_q[9];
      outside_q[10]        <= outside_q[9];
    end
  end

  // 11: out.
  always_ff @(posedge clk_i) begin
    if (moves[10]) begin
      entry_time_key_q[11] <= entry_time_key_q[10];
      entry_face_q[11]     <= entry_face_q[10];
      past_middle_q[11]    <= past_middle_q[10];
      outside_q[11]        <= outside_q[10] || past_far_q != '0 || overflow_q[10];
    end
  end

  assign valid_o    = moves[11];
  assign lane_o     = lane_q[11];
  assign overflow_o = overflow_q[11];

  always_comb begin
    ray_o.resolved = outside_q[11] || root_leaf_i;
    ray_o.pixel    = '{material: '0, face: FaceNone};
    if (!outside_q[11] && root_material_i != '0) begin
      ray_o.pixel = '{material: root_material_i, face: entry_face_q[11]};
    end
    ray_o.lit        = !overflow_q[11];
    ray_o.shadow     = shadow11;
    ray_o.tag        = tag11;
    ray_o.mirrored   = mirrored_q[11];
    ray_o.dead       = dead_q[11];
    ray_o.octant     = past_middle_q[11];
    ray_o.entry_time = KeyLimit'(entry_time_key_q[11]);
    ray_o.entry_face = entry_face_q[11];
    ray_o.reach      = reach11;
    for (int unsigned a = 0; a < 3; a++) begin
      weights_o[a]    = weight_q[11][a];
      ray_o.origin[a] = DistanceLimit'(mirrored_q[11][a] ? mirrored_world_origin[a] : world_origin[a]);
      if (shadow11) ray_o.origin[a] = DistanceLimit'(point11[a]);
    end
  end
endmodule
