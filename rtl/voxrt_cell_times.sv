// When a ray crosses three planes of its cell: T, stages 1 to 5 of voxrt_lane. Far planes, or middle ones, one an axis;
// modulo 2**KeyBits.
//
// Distances from origins to planes come from the camera's origin, which all rays share, or, with Light or Mirrors, from
// one that each ray has of its own: reflections move it, and shadow rays start at the lit point and count 1/32 voxel.
module voxrt_cell_times
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned Slots        = 11,
  parameter  int unsigned RowBits      = 5,
  parameter  bit          Light        = 1'b0,
  parameter  bit          Mirrors      = 1'b0,
  localparam int unsigned SlotBits     = $clog2(Slots),
  localparam int unsigned SubBits      = Light ? FractionBits : 0,
  localparam int unsigned CellBits     = MaxDepth + SubBits,
  localparam int unsigned OriginBits   = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned KeyBits      = key_bits(MaxDepth, Light)
) (
  input  logic                         clk_i,
  // Held during a frame.
  input  logic signed [OriginBits-1:0] origin_i          [3],
  input  logic signed [OriginBits-1:0] mirrored_origin_i [3],
  // A ray has come, and will start some time: its weights, in the row that holds them until it has ended.
  input  logic                         arrives_i,
  input  logic        [   RowBits-1:0] arrival_row_i,
  input  logic        [WeightBits-1:0] weight_i          [3],
  // Stage 1: the cell's lowest corner. Stage 2: the ray's row, the cell's size, one-hot, and whether its far planes are
  // asked for.
  input  logic        [  SlotBits-1:0] slot1_i,
  input  logic        [  CellBits-1:0] corner1_i         [3],
  input  logic        [           2:0] mirrored1_i,
  input  logic        [           2:0] dead1_i,
  input  logic                         shadow1_i,
  input  logic        [   RowBits-1:0] row2_i,
  input  logic        [  CellBits-1:0] size2_i,
  input  logic                         shadow2_i,
  input  logic                         takes_far_i,
  // Stage 9: a new ray; or the ray is reflected by a plane of this number and axis, in its own mirrored frame.
  input  logic        [  SlotBits-1:0] slot9_i,
  input  logic                         starts_i,
  input  logic signed [OriginBits-1:0] ray_origin_i      [3],
  input  logic                         reflects_i,
  input  face_e                        face_i,
  input  logic signed [MaxDepth+1:0]   shift_i,               // Side - 2 plane.
  output logic        [   KeyBits-1:0] time_o            [3]  // At stage 6.
);
  localparam int unsigned DistanceBits = Mirrors ? reflected_distance_bits(MaxDepth, PositionBits) : OriginBits;
  localparam int unsigned TimeBits = DistanceBits + WeightBits;

  // 1, 2: from the origin to the cell's near planes; to the far or middle planes.
  logic signed [DistanceBits-1:0] distance3_q[3];

  if (Light || Mirrors) begin : gen_own_origin
    logic signed [DistanceBits-1:0] origin_x_q[Slots], origin_y_q[Slots], origin_z_q[Slots];
    logic signed [DistanceBits-1:0] origin1[3], near2_q[3], step2, shift;
    logic                           unused_origin;

    assign unused_origin = &{origin_i[0], origin_i[1], origin_i[2], mirrored_origin_i[0], mirrored_origin_i[1],
                             mirrored_origin_i[2], mirrored1_i};

    assign shift = Mirrors ? DistanceBits'(shift_i) <<< FractionBits : '0;

    assign origin1[0] = origin_x_q[slot1_i];
    assign origin1[1] = origin_y_q[slot1_i];
    assign origin1[2] = origin_z_q[slot1_i];
    assign step2      = (DistanceBits'(size2_i) << (FractionBits - SubBits)) >> !takes_far_i;

    // Planes of a dead axis must not meet the origin: a distance one less has the sign that tells where it is.
    always_ff @(posedge clk_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        near2_q[a] <= (DistanceBits'(corner1_i[a]) << (FractionBits - SubBits) << shadow1_i) - origin1[a] -
            DistanceBits'(dead1_i[a]);
        distance3_q[a] <= near2_q[a] + (step2 << shadow2_i);
      end
      if (starts_i) origin_x_q[slot9_i] <= DistanceBits'(ray_origin_i[0]);
      else if (reflects_i && face_i == FaceX) origin_x_q[slot9_i] <= origin_x_q[slot9_i] + shift;
      if (starts_i) origin_y_q[slot9_i] <= DistanceBits'(ray_origin_i[1]);
      else if (reflects_i && face_i == FaceY) origin_y_q[slot9_i] <= origin_y_q[slot9_i] + shift;
      if (starts_i) origin_z_q[slot9_i] <= DistanceBits'(ray_origin_i[2]);
      else if (reflects_i && face_i == FaceZ) origin_z_q[slot9_i] <= origin_z_q[slot9_i] + shift;
    end
  end else begin : gen_shared_origin
    localparam int unsigned WholeBits = DistanceBits - FractionBits;
    logic signed [   WholeBits-1:0] near2_q    [3];
    logic        [FractionBits-1:0] fraction2_q[3];
    logic                           unused_origin;

    assign unused_origin = &{ray_origin_i[0], ray_origin_i[1], ray_origin_i[2], shadow1_i, shadow2_i, slot1_i, slot9_i,
                             starts_i, reflects_i, face_i, shift_i};

    // The fraction of corner - origin is the other origin's, as the two add up to whole voxels. On a dead axis the
    // origin's fraction counts as above 0.
    for (genvar a = 0; a < 3; a++) begin : gen_near
      logic whole;
      assign whole = origin_i[a][FractionBits-1:0] == '0 && !dead1_i[a];

      always_ff @(posedge clk_i) begin
        near2_q[a] <= WholeBits'(corner1_i[a]) + WholeBits'(whole)
            + ~WholeBits'((mirrored1_i[a] ? mirrored_origin_i[a] : origin_i[a]) >>> FractionBits);
        fraction2_q[a] <= mirrored1_i[a] ? origin_i[a][FractionBits-1:0] : mirrored_origin_i[a][FractionBits-1:0];
        distance3_q[a] <= {near2_q[a] + WholeBits'({1'b0, takes_far_i ? size2_i : size2_i >> 1}), fraction2_q[a]};
      end
    end
  end

  // 3, 4, 5.
  logic        [WeightBits-1:0] weight_x_q[2**RowBits], weight_y_q[2**RowBits], weight_z_q[2**RowBits];
  logic        [WeightBits-1:0] weight3_q [3];
  logic signed [  TimeBits-1:0] exact_time[3];

  always_ff @(posedge clk_i) begin
    weight3_q[0] <= weight_x_q[row2_i];
    weight3_q[1] <= weight_y_q[row2_i];
    weight3_q[2] <= weight_z_q[row2_i];
    if (arrives_i) begin
      weight_x_q[arrival_row_i] <= weight_i[0];
      weight_y_q[arrival_row_i] <= weight_i[1];
      weight_z_q[arrival_row_i] <= weight_i[2];
    end
  end

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
