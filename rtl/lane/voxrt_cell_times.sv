// When a ray crosses three planes of its cell, one per axis: T modulo 2**KeyBits. These are stages 1 to 5 of
// voxrt_lane. The planes are the far ones of a leaf, the middle ones of a pointer's cell, or the near ones of a leaf
// that is hit.
//
// Distances from origins to planes come from the camera's origin, which all rays share, or, with Light or Mirrors, from
// an origin per ray: reflections move it, and shadow rays start at a hit point and count 1/32 voxel.
module voxrt_cell_times
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned Slots        = 12,    // Rays in the ring of the lane, as lane_slots has it: 12 .. 15.
  parameter int unsigned RowBits      = 5,     // 2**RowBits rays, in slots and waiting: 5, or, as with Light, 6.
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0
) (
  input logic clk_i,
  // Held during a frame.
  input world_t world_i,
  // The weights of a ray, in the row that holds them until it has ended.
  input weights_write_t weights_write_i,
  // Stage 1: the cell's lowest corner. Stage 2: the ray's row, the cell's size, one-hot, and whether the far planes are
  // wanted.
  input logic [$clog2(Slots)-1:0] slot1_i,
  input logic [MaxDepth-1:0] corner1_i[3],
  input logic [2:0] mirrored1_i,
  input logic [2:0] dead1_i,
  input logic shadow1_i,
  input logic [RowBits-1:0] row2_i,
  input logic [MaxDepth-1:0] size2_i,
  input logic shadow2_i,
  input logic takes_far2_i,
  input logic takes_near2_i,  // Only with Light.
  // Stage 9: a new ray with its origin; or the ray is reflected by a plane of the key's face.
  input logic [$clog2(Slots)-1:0] slot9_i,
  input decision_t decision_i,
  input logic [2:0][DistanceLimit-1:0] ray_origin_i,
  input face_e key_face_i,
  // Stage 6.
  output logic [key_bits(MaxDepth, Light)-1:0] time_o[3],
  // For voxrt_hit_point: stage 3.
  output weights_t weights3_o,
  // For voxrt_lod, with an origin that all rays share: stage 2, near plane - origin, voxels, signed; stage 3.
  output logic signed [distance_bits(MaxDepth, PositionBits)-FractionBits-1:0] near2_o[3],
  output logic [distance_bits(MaxDepth, PositionBits)-FractionBits-1:0] reach3_o
);
  if (Slots < 12 || Slots > 15) $error("voxrt_cell_times: Slots must be 12 to 15");
  if (RowBits < 5 || RowBits > RowLimit) $error("voxrt_cell_times: RowBits must be 5 or 6 bits");

  localparam int unsigned OriginBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);
  localparam int unsigned DistanceBits = Mirrors ? reflected_distance_bits(MaxDepth, PositionBits) : OriginBits;
  localparam int unsigned TimeBits = DistanceBits + WeightBits;

  // 1, 2: from the origin to the cell's near planes; to the far or middle planes.
  logic signed [DistanceBits-1:0] distance3_q[3];

  if (Light || Mirrors) begin : gen_own_origin
    logic signed [DistanceBits-1:0] origin_x_q[Slots], origin_y_q[Slots], origin_z_q[Slots];
    logic signed [DistanceBits-1:0] origin1[3], ray_origin[3], near2_q[3], step2, shift;
    logic signed [OriginBits-1:0] exact_origin[3];
    logic signed [MaxDepth+1:0] planes;
    logic unused_shared;

    assign unused_shared = &{world_i, mirrored1_i};
    assign near2_o       = '{default: '0};

    assign planes        = decision_i.shift[MaxDepth+1:0];
    assign shift         = Mirrors ? DistanceBits'(planes) <<< FractionBits : '0;

    assign origin1[0]    = origin_x_q[slot1_i];
    assign origin1[1]    = origin_y_q[slot1_i];
    assign origin1[2]    = origin_z_q[slot1_i];
    assign step2         = takes_near2_i ? '0 : (DistanceBits'(size2_i) << FractionBits) >> !takes_far2_i;

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        exact_origin[a] = ray_origin_i[a][OriginBits-1:0];
        ray_origin[a]   = DistanceBits'(exact_origin[a]);
      end
    end

    // Planes of a dead axis must not meet the origin: a distance one less has the sign that tells where it is.
    always_ff @(posedge clk_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        near2_q[a] <= (DistanceBits'(corner1_i[a]) << FractionBits << shadow1_i) - origin1[a] -
            DistanceBits'(dead1_i[a]);
        distance3_q[a] <= near2_q[a] + (step2 << shadow2_i);
      end
      if (decision_i.issues) origin_x_q[slot9_i] <= ray_origin[0];
      else if (decision_i.reflects && key_face_i == FaceX) origin_x_q[slot9_i] <= origin_x_q[slot9_i] + shift;
      if (decision_i.issues) origin_y_q[slot9_i] <= ray_origin[1];
      else if (decision_i.reflects && key_face_i == FaceY) origin_y_q[slot9_i] <= origin_y_q[slot9_i] + shift;
      if (decision_i.issues) origin_z_q[slot9_i] <= ray_origin[2];
      else if (decision_i.reflects && key_face_i == FaceZ) origin_z_q[slot9_i] <= origin_z_q[slot9_i] + shift;
    end
  end else begin : gen_shared_origin
    localparam int unsigned WholeBits = DistanceBits - FractionBits;
    logic signed [WholeBits-1:0] near2_q[3];
    logic [FractionBits-1:0] fraction2_q[3];
    logic unused_origin;

    assign near2_o = near2_q;
    assign unused_origin = &{ray_origin_i, shadow1_i, shadow2_i, takes_near2_i, slot1_i, slot9_i, decision_i,
                             key_face_i};

    // The fraction of corner - origin is the other origin's, as the two add up to whole voxels. On a dead axis the
    // origin's fraction counts as above 0.
    for (genvar a = 0; a < 3; a++) begin : gen_near
      logic signed [OriginBits-1:0] origin, mirrored_origin;
      logic whole;

      assign origin          = world_i.origin[a][OriginBits-1:0];
      assign mirrored_origin = world_i.mirrored_origin[a][OriginBits-1:0];
      assign whole           = origin[FractionBits-1:0] == '0 && !dead1_i[a];

      always_ff @(posedge clk_i) begin
        near2_q[a] <= WholeBits'(corner1_i[a]) + WholeBits'(whole)
            + ~WholeBits'((mirrored1_i[a] ? mirrored_origin : origin) >>> FractionBits);
        fraction2_q[a] <= mirrored1_i[a] ? origin[FractionBits-1:0] : mirrored_origin[FractionBits-1:0];
        distance3_q[a] <= {near2_q[a] + WholeBits'({1'b0, takes_far2_i ? size2_i : size2_i >> 1}), fraction2_q[a]};
      end
    end
  end

  // 3, 4, 5.
  logic [WeightBits-1:0] weight_x_q[2**RowBits], weight_y_q[2**RowBits], weight_z_q[2**RowBits];
  logic [WeightBits-1:0] weight3_q[3];
  logic [RowBits-1:0] written_row;
  logic [OriginBits-FractionBits-1:0] reach_q[2**RowBits], reach3_q;
  logic signed [TimeBits-1:0] exact_time[3];

  assign written_row = weights_write_i.row[RowBits-1:0];

  always_ff @(posedge clk_i) begin
    weight3_q[0] <= weight_x_q[row2_i];
    weight3_q[1] <= weight_y_q[row2_i];
    weight3_q[2] <= weight_z_q[row2_i];
    reach3_q     <= reach_q[row2_i];
    if (weights_write_i.valid) begin
      weight_x_q[written_row] <= weights_write_i.weights[0];
      weight_y_q[written_row] <= weights_write_i.weights[1];
      weight_z_q[written_row] <= weights_write_i.weights[2];
      reach_q[written_row]    <= weights_write_i.reach[OriginBits-FractionBits-1:0];
    end
  end

  assign reach3_o   = reach3_q;
  assign weights3_o = Light ? {weight3_q[2], weight3_q[1], weight3_q[0]} : '0;

  for (genvar a = 0; a < 3; a++) begin : gen_time
    voxrt_plane_time #(
      .DistanceBits(DistanceBits)
    ) u_time (
      .clk_i,
      .distance_i(distance3_q[a]),
      .weight_i  (weight3_q[a]),
      .time_o    (exact_time[a])
    );

    assign time_o[a] = KeyBits'(exact_time[a]);
  end
endmodule
