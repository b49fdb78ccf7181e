// The work of voxrt_ray_setup with a ray per eight clocks, for parts with few flip-flops: one multiplier, one plane time,
// one adder and one comparison, which take the axes one after the other. No shadow rays, no level of detail.
//
// A beat has eight turns. In its first beat a ray's weights and near planes are made, in its second one it enters the
// world, while the next ray is in its first. What the turns of axis 0 do; axis 1 is a turn later, axis 2 two:
//
//   0, 1  weight           2        weight kept | plane 0: 2 to 4        5  plane 0 kept
//   6     entry key        9        half of the world's time: 9, 10; plane 0 - key: 10
//   11    middle and far plane before the entry                         14  out, all axes
module voxrt_serial_ray_setup
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned Lanes        = 1
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  // See voxrt_ray_setup.
  input  world_t                     world_i,
  input  logic                       root_leaf_i,
  input  material_t                  root_material_i,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  logic        [   Lanes-1:0] lane_i,
  input  logic signed [ScanBits-1:0] direction_i    [3],
  output logic                       valid_o,
  output logic        [   Lanes-1:0] lane_o,
  output logic                       overflow_o,
  output ray_t                       ray_o,
  output weights_t                   weights_o
);
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned TimeBits = DistanceBits + WeightBits;
  localparam int unsigned KeyBits = key_bits(MaxDepth, 1'b0);
  localparam int unsigned DepthBits = $clog2(MaxDepth + 1);
  localparam int unsigned SpanBits = WeightBits + FractionBits + MaxDepth;
  localparam int unsigned GapBits = TimeBits + 1;

  // Whose turn: axis[t] is the axis whose step t it is, in either beat; none above 2.
  logic [2:0] turn_q, axis[8];
  logic beat_q, advance;  // The beat's number: odd or even.

  assign advance = turn_q == 3'd7;
  assign ready_o = advance;

  always_comb for (int unsigned t = 0; t < 8; t++) axis[t] = turn_q - 3'(t);

  always_ff @(posedge clk_i) begin
    turn_q <= turn_q + 3'd1;
    if (advance) beat_q <= !beat_q;
    if (!rst_ni) begin
      turn_q <= '0;
      beat_q <= 1'b0;
    end
  end

  // A ray in its first beat, and in its second.
  logic [1:0] valid_q, overflow_q;
  logic [Lanes-1:0] lane_q[2];
  logic [2:0] mirrored_q[2], dead_q[2];

  // Sign and size. The sizes go round, so that the multiplier finds the next two axes' at the same place.
  logic [DirectionBits-1:0] size_q[3];
  logic [DirectionBits:0] magnitude[3];
  logic [2:0] negative, zero, too_large;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      negative[a] = direction_i[a] < 0;
      zero[a] = direction_i[a] == 0;
      magnitude[a] = (direction_i[a][DirectionBits:0] ^ {(DirectionBits + 1){negative[a]}}) +
          (DirectionBits + 1)'(negative[a]);
      too_large[a] = magnitude[a][DirectionBits] ||
          direction_i[a][ScanBits-1:DirectionBits] != {(ScanBits - DirectionBits){negative[a]}};
    end
  end

  always_ff @(posedge clk_i) begin
    size_q <= '{size_q[1], size_q[2], size_q[0]};
    if (advance) begin
      // A zero counts as 1 in the weights of the other axes.
      for (int unsigned a = 0; a < 3; a++) size_q[a] <= magnitude[a][DirectionBits-1:0] | DirectionBits'(zero[a]);
      valid_q    <= {valid_q[0], valid_i};
      overflow_q <= {overflow_q[0], too_large != '0};
      lane_q     <= '{lane_i, lane_q[0]};
      mirrored_q <= '{negative, mirrored_q[0]};
      dead_q     <= '{zero, dead_q[0]};
    end
    if (!rst_ni) valid_q <= '0;
  end

  // 0, 1: weight. It is kept for the second beat while the next ray's comes.
  logic [WeightBits-1:0] weight;
  (* ram_style = "distributed" *)
  logic [WeightBits-1:0] weight_x_q[2], weight_y_q[2], weight_z_q[2];
  logic [WeightBits-1:0] kept_weight[3];

  voxrt_multiply #(
    .ABits(DirectionBits),
    .BBits(DirectionBits)
  ) u_weight (
    .clk_i,
    .a_i      (size_q[1]),
    .b_i      (size_q[2]),
    .product_o(weight)
  );

  always_ff @(posedge clk_i) begin
    if (axis[2] == 3'd0) weight_x_q[beat_q] <= weight;
    if (axis[2] == 3'd1) weight_y_q[beat_q] <= weight;
    if (axis[2] == 3'd2) weight_z_q[beat_q] <= weight;
  end

  assign kept_weight = '{weight_x_q[!beat_q], weight_y_q[!beat_q], weight_z_q[!beat_q]};

  // 1: from the origin to the near plane, as voxrt_lane does it. 2, 3, 4: plane 0.
  logic signed [DistanceBits-1:0] distance, distance_q;
  logic signed [TimeBits-1:0] plane_time;

  always_comb begin
    distance = '0;
    for (int unsigned a = 0; a < 3; a++) begin
      logic signed [DistanceBits-1:0] origin, mirrored_origin;
      origin          = world_i.origin[a][DistanceBits-1:0];
      mirrored_origin = world_i.mirrored_origin[a][DistanceBits-1:0];
      if (axis[1] == 3'(a)) begin
        distance[FractionBits-1:0] = mirrored_q[0][a] ? origin[FractionBits-1:0] : mirrored_origin[FractionBits-1:0];
        distance[DistanceBits-1:FractionBits] =
            ~(mirrored_q[0][a] ? mirrored_origin[DistanceBits-1:FractionBits] : origin[DistanceBits-1:FractionBits]) +
            (DistanceBits - FractionBits)'(origin[FractionBits-1:0] == '0 && !dead_q[0][a]);
      end
    end
  end

  always_ff @(posedge clk_i) distance_q <= distance;

  voxrt_plane_time #(
    .DistanceBits(DistanceBits)
  ) u_near (
    .clk_i,
    .distance_i(distance_q),
    .weight_i  (weight),
    .time_o    (plane_time)
  );

  // 5, 6: the entry key, the last near plane that is ahead. On a dead axis no plane is at the origin, and 0 is ahead.
  logic signed [TimeBits-1:0] near_q, entry_time_q;
  logic dead6_q, enters, outside_q;
  face_e entry_face_q;

  assign enters = !near_q[TimeBits-1] && near_q != '0 && !dead6_q;

  always_ff @(posedge clk_i) begin
    near_q  <= plane_time;
    dead6_q <= '0;
    for (int unsigned a = 0; a < 3; a++) if (axis[5] == 3'(a)) dead6_q <= dead_q[0][a];
    if (axis[6] <= 3'd2) begin
      outside_q <= (axis[6] != 3'd0 && outside_q) || (dead6_q && !near_q[TimeBits-1]);
      if (axis[6] == 3'd0) begin
        entry_face_q <= enters ? FaceX : FaceNone;
        entry_time_q <= enters ? near_q : '0;
      end else if (enters && near_q >= entry_time_q) begin
        entry_face_q <= face_e'(axis[6][1:0]);
        entry_time_q <= near_q;
      end
    end
  end

  // The near planes, until the key is known.
  (* ram_style = "distributed" *)
  logic [TimeBits-1:0] kept_near_q[4];
  logic signed [TimeBits-1:0] kept_near;

  always_ff @(posedge clk_i) if (axis[6] <= 3'd2) kept_near_q[axis[6][1:0]] <= near_q;

  assign kept_near = kept_near_q[axis[2][1:0]];

  // 9, 10: near plane - key - 1, where a dead axis has the key 0; how long the ray takes through half of the world.
  logic signed [GapBits-1:0] gap_q;
  logic [SpanBits-2:0] part_span_q, half_span_q;
  logic [WeightBits-1:0] weight9;
  logic [DepthBits-1:0] depth;
  logic dead10, dead11_q, last;  // Last: which of two equal times comes last.

  assign depth = world_i.depth[DepthBits-1:0];

  always_comb begin
    weight9 = kept_weight[2];
    for (int unsigned a = 0; a < 2; a++) if (axis[1] == 3'(a)) weight9 = kept_weight[a];
    dead10 = dead_q[1][2];
    for (int unsigned a = 0; a < 2; a++) if (axis[2] == 3'(a)) dead10 = dead_q[1][a];
  end

  always_ff @(posedge clk_i) begin
    part_span_q <= (SpanBits - 1)'(weight9) << {1'b0, depth[0]} << (FractionBits - 1);
    half_span_q <= part_span_q << {depth[DepthBits-1:1], 1'b0};
    gap_q       <= GapBits'(kept_near) + ~(dead10 ? '0 : GapBits'(entry_time_q));
    dead11_q    <= dead10;
  end

  // 11: which middle and far planes come before the entry, as voxrt_ray_setup finds it.
  logic [GapBits:0] middle, far;
  logic [2:0] past_middle_q;
  logic past_far_q;

  assign last   = dead11_q || axis[3][1:0] > entry_face_q;
  assign middle = {gap_q, 1'b1} + (GapBits + 1)'({half_span_q, last});
  assign far    = {gap_q, 1'b1} + (GapBits + 1)'({half_span_q, 1'b0, last});

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) if (axis[3] == 3'(a)) past_middle_q[a] <= middle[GapBits];
    if (axis[3] <= 3'd2) past_far_q <= (axis[3] != 3'd0 && past_far_q) || far[GapBits];
  end

  // 14: out.
  logic outside;

  assign outside    = outside_q || past_far_q || overflow_q[1];
  assign valid_o    = valid_q[1] && turn_q == 3'd6;
  assign lane_o     = lane_q[1];
  assign overflow_o = overflow_q[1];

  always_comb begin
    ray_o            = '0;
    ray_o.resolved   = outside || root_leaf_i;
    ray_o.pixel      = '{material: '0, face: FaceNone};
    if (!outside && root_material_i != '0) ray_o.pixel = '{material: root_material_i, face: entry_face_q};
    ray_o.mirrored   = mirrored_q[1];
    ray_o.dead       = dead_q[1];
    ray_o.octant     = past_middle_q;
    ray_o.entry_time = KeyLimit'(KeyBits'(entry_time_q));
    ray_o.entry_face = entry_face_q;
    for (int unsigned a = 0; a < 3; a++) begin
      weights_o[a]    = kept_weight[a];
      ray_o.origin[a] = mirrored_q[1][a] ? world_i.mirrored_origin[a] : world_i.origin[a];
    end
  end
endmodule
