// Follows rays through the octree: a ring of eight stages that holds eight rays; every clock one of them reads one
// octree word. A memory that takes longer than two clocks adds a stage and a ray a clock, before stage 1.
//
//   stage     work                                                                          state kept by slot
//   0 fetch   the memory takes the address; far planes of the cell                          corner, size
//   1 wait    the memory's output register                                                  size
//   2 decode  leaf or pointer; distance to the far planes (leaf) or middle planes (pointer) mirrored, dead, weight
//   3 product distance x weight, in two parts; the pointer goes onto the stack              stack
//   4 sum     T of three planes                                                             key
//   5 compare leaf: T among themselves; pointer: T with the ray's key. Far planes again     corner, size, dead
//   6 select  leaf: the smallest T is the new key, the ancestor that holds both cells;      -
//             pointer: the child's corner
//   7 turn    the block from the stack, the octant; or a new ray in the place of one that   all
//             ended
//
// A ray's key (T, face) is the last plane that it crossed. Corner and size (one-hot) are those of the cell read; its
// octant is the corner's bit at size. Planes of cells at that time crossed are those with keys <= the ray's key, so
// no two planes tie and a pointer's child is found by three compares. Leaving a leaf by one face changes the corner on
// one axis: corner + size. The one bit that this sets is the size of the cell that follows, below the common ancestor,
// whose block is on the stack under that size; outside the world when it is the world's own size.
//
// The ring never stops: rays start only when the pixel buffer has a place for them. A word that the memory did not
// deliver (mem_ack_i low) is asked for again at the ray's next turn.
//
// T is kept modulo 2**TimeBits: planes that a ray compares lie within one world, wherever its origin is.
//
// Mirrors: a ray that hits one starts anew at the root in its slot, with the key of the hit, the mirror bit of that axis
// flipped and the origin moved by 16 (side - 2 plane), so that the plane's T stays; it stands in the cell that it came
// from. The root's octant needs no compare: that cell and the one hit differ on the one axis alone.
//
// Light: a camera's ray that hits goes on with its descent, by the same compares, to the sub-cell of 1/16 voxel: no word is
// read, corner and size have four bits more. The sub-cell leaves for voxrt_light; the slot is free. A shadow ray, in
// 1/32 voxel, comes back with the tag. Whether what it hits is before the light is a compare of cells on the axis of
// the face: T_hit < T_light there says that the plane is before the light's coordinate.
// A ray whose sub-cell finds voxrt_light's queue full asks again at its next turn, and changes places with a shadow ray if
// one waits: so the two wait for each other never.
module voxrt_lane
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned BlockBits    = 12,
  parameter  int unsigned TagBits      = 8,
  parameter  int unsigned MemoryClocks = 2,
  parameter  bit          Light        = 1'b0,
  parameter  bit          Mirrors      = 1'b0,
  localparam int unsigned OriginBits   = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned TimeBits     = lane_time_bits(MaxDepth, Light),
  localparam int unsigned PayloadBits  = payload_bits(BlockBits),
  localparam int unsigned PlaceBits    = MaxDepth + FractionBits,
  localparam int unsigned DetailBits   = detail_bits(MaxDepth, Light, Mirrors)
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Held during a frame.
  input  logic signed [  OriginBits-1:0] origin_i          [3],
  input  logic signed [  OriginBits-1:0] mirrored_origin_i [3],
  input  logic        [      MaxDepth:0] world_i,                // One-hot: the world's side.
  input  logic        [   PayloadBits:0] root_i,                 // A leaf only with Light or Mirrors.
  input  logic                           light_i,
  input  logic        [  BounceBits-1:0] bounces_i,              // 0: no material is a mirror.
  // Planes of lower number are before the light, by axis, in the grid's frame and mirrored.
  input  logic        [      MaxDepth:0] light_plane_i     [3],
  input  logic        [      MaxDepth:0] mirrored_light_plane_i[3],
  // Material table, for mirrors.
  input  logic                           table_write_i,
  input  material_t                      table_material_i,
  input  row_t                           table_row_i,
  // Rays, as voxrt_ray_setup makes them; taken in order.
  input  logic                           ray_valid_i,
  output logic                           ray_ready_o,
  input  logic                           ray_resolved_i,
  input  pixel_t                         ray_pixel_i,
  input  logic        [             2:0] ray_mirrored_i,
  input  logic        [             2:0] ray_dead_i,
  input  logic        [             2:0] ray_octant_i,
  input  logic        [  WeightBits-1:0] ray_weight_i      [3],
  input  logic        [    TimeBits-1:0] ray_entry_time_i,
  input  face_e                          ray_entry_face_i,
  // With Light or Mirrors; mirrored frame. A shadow ray has its place in the pixel buffer already.
  input  logic signed [  OriginBits-1:0] ray_origin_i      [3],
  input  logic                           ray_shadow_i,
  input  logic        [     TagBits-1:0] ray_tag_i,
  input  logic                           ray_lit_i,              // The answer, where resolved.
  // Octree memory: the word comes two clocks after its address, or not.
  output logic                           mem_read_o,
  output logic        [   BlockBits-1:0] mem_block_o,
  output logic        [             2:0] mem_octant_o,
  input  logic                           mem_ack_i,
  input  logic        [   PayloadBits:0] mem_word_i,
  // Pixel buffer.
  output logic                           take_o,
  input  logic                           take_ready_i,
  input  logic        [     TagBits-1:0] take_tag_i,
  output logic                           fill_o,                 // The pixel is whole.
  output logic        [     TagBits-1:0] fill_tag_o,             // Of what is filled or stored.
  output logic                           fill_lit_o,
  output logic                           store_pixel_o,
  output pixel_t                         fill_pixel_o,
  output logic                           store_detail_o,
  output logic        [  DetailBits-1:0] fill_detail_o,
  // Sub-cells for voxrt_light, as ShadeLight has them.
  output logic                           request_o,
  input  logic                           request_ready_i,
  output logic        [     TagBits-1:0] request_tag_o,
  output face_e                          request_face_o,
  output logic        [             2:0] request_mirrored_o,
  output logic        [   PlaceBits-1:0] request_place_o   [3],
  // Sticky errors.
  output logic                           bad_pointer_o,
  output logic                           step_limit_o
);
  // Stages as the table numbers them, and those in which a slower memory keeps rays waiting.
  localparam int unsigned Extra = MemoryClocks - 2;
  localparam int unsigned Slots = 8 + Extra;
  localparam int unsigned SlotBits = $clog2(Slots);
  localparam int unsigned LevelBits = $clog2(MaxDepth);

  // Rays have their own origins, and a root that is a leaf is read as if it were eight.
  localparam bit OwnOrigin = Light || Mirrors;
  localparam int unsigned DistanceBits = Mirrors ? reflected_distance_bits(MaxDepth, PositionBits) : OriginBits;
  // Corners and sizes count 1 / 2**SubBits voxel.
  localparam int unsigned SubBits = Light ? FractionBits : 0;
  localparam int unsigned CellBits = MaxDepth + SubBits;

  // Which slot is in which stage.
  logic [SlotBits-1:0] slot[8];
  logic [SlotBits-1:0] slot_q[Slots];

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= slot_q[(s+Slots-1)%Slots];
    if (!rst_ni) for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= SlotBits'(s);
  end

  always_comb for (int unsigned s = 0; s < 8; s++) slot[s] = slot_q[s+Extra];

  // State by slot.
  logic        [  WeightBits-1:0] weight_x_q[Slots], weight_y_q[Slots], weight_z_q[Slots];
  logic        [             2:0] mirrored_q[Slots];
  logic        [             2:0] dead_q    [Slots];
  logic        [     TagBits-1:0] tag_q     [Slots];
  logic        [    TimeBits-1:0] key_time_q[Slots];
  face_e                          key_face_q[Slots];
  logic        [    CellBits-1:0] corner_x_q[Slots], corner_y_q[Slots], corner_z_q[Slots];
  logic        [    CellBits-1:0] size_q    [Slots];
  logic        [   BlockBits-1:0] stack_q   [2 ** (SlotBits + LevelBits)];

  // There is a ray in this stage that has not ended.
  logic [Slots-1:0] active_q;

  // 0 fetch, 1 wait: far planes.
  logic [BlockBits-1:0] block0_q;
  logic [2:0]           octant0_q;
  logic [CellBits:0]    far1_q   [3], far2_q   [3];
  logic [CellBits-1:0]  corner1_q[3], middle2_q[3];
  logic [CellBits-1:0]  size1_q, size2_q;
  logic                 sinks0, sinks2, sinks7;  // The ray has hit, and looks for the sub-cell.
  logic                 shadow2, shadow7;        // It is a shadow ray.

  assign mem_read_o   = active_q[0] && !sinks0 && !(OwnOrigin && root_i[PayloadBits]);
  assign mem_block_o  = block0_q;
  assign mem_octant_o = octant0_q;

  always_ff @(posedge clk_i) begin
    corner1_q[0] <= corner_x_q[slot[0]];
    corner1_q[1] <= corner_y_q[slot[0]];
    corner1_q[2] <= corner_z_q[slot[0]];
    far1_q[0]    <= {1'b0, corner_x_q[slot[0]]} + {1'b0, size_q[slot[0]]};
    far1_q[1]    <= {1'b0, corner_y_q[slot[0]]} + {1'b0, size_q[slot[0]]};
    far1_q[2]    <= {1'b0, corner_z_q[slot[0]]} + {1'b0, size_q[slot[0]]};
    size1_q      <= size_q[slot[0]];
    size2_q      <= size1_q;
    for (int unsigned a = 0; a < 3; a++) begin
      far2_q[a]    <= far1_q[a];
      middle2_q[a] <= corner1_q[a] | (size1_q >> 1);
    end
  end

  // 2 decode.
  typedef enum logic [1:0] {
    Retry,    // No word came.
    Descend,  // Into the block of a pointer.
    Leave,    // An empty leaf, through one of its faces.
    Finish    // The ray has ended: hit or error.
  } action_e;

  logic                 leaf, bad_pointer, step_limit, arrived;
  logic [PayloadBits:0] word;
  action_e              action;

  assign word        = OwnOrigin && root_i[PayloadBits] ? root_i : mem_word_i;
  assign arrived     = (mem_ack_i || (OwnOrigin && root_i[PayloadBits])) && !sinks2;
  assign leaf        = word[PayloadBits];
  assign bad_pointer = leaf && word[8];
  assign step_limit  = !leaf && size2_q[SubBits];

  always_comb begin
    action = Finish;
    if (sinks2) action = size2_q[0] ? Retry : Descend;
    else if (!arrived) action = Retry;
    else if (!leaf && !size2_q[SubBits]) action = Descend;
    else if (leaf && word[8:0] == '0) action = Leave;
  end

  logic signed [DistanceBits-1:0] distance3_q[3];
  logic        [  WeightBits-1:0] weight3_q  [3];
  action_e                        action3_q, action4_q, action5_q, action6_q;
  logic        [   BlockBits-1:0] block3_q;
  material_t                      material3_q, material4_q, material5_q, material6_q, material7_q;
  logic        [   LevelBits-1:0] child_level3_q;
  logic                           bad_pointer_q, step_limit_q;

  // Binary number of a one-hot size.
  function automatic logic [LevelBits-1:0] level_of(logic [CellBits-1:0] size);
    level_of = '0;
    for (int unsigned i = 0; i < MaxDepth; i++) if (size[i+SubBits]) level_of |= LevelBits'(i);
  endfunction

  // Planes and origins at stage 2. A ray that sinks, or will, needs middle planes of its leaf. Planes and the origin of an
  // axis that is dead must not meet: where planes may have any fraction, a distance one less gives the same sign.
  logic signed [DistanceBits-1:0] plane2[3], origin2[3];
  logic                           takes_far;
  logic        [             2:0] before_dead2;

  assign takes_far = Light ? action == Leave : leaf;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      plane2[a] = DistanceBits'(takes_far ? far2_q[a] : {1'b0, middle2_q[a]}) <<< (FractionBits - SubBits);
      if (shadow2) plane2[a] = plane2[a] <<< 1;
    end
  end

  always_ff @(posedge clk_i) begin
    action3_q <= action;
    for (int unsigned a = 0; a < 3; a++) begin
      distance3_q[a] <= plane2[a] - origin2[a] - DistanceBits'(before_dead2[a]);
    end
    weight3_q[0]   <= weight_x_q[slot[2]];
    weight3_q[1]   <= weight_y_q[slot[2]];
    weight3_q[2]   <= weight_z_q[slot[2]];
    block3_q       <= word[BlockBits-1:0];
    material3_q    <= leaf && !bad_pointer ? word[7:0] : '0;
    child_level3_q <= level_of(size2_q >> 1);
    bad_pointer_q  <= active_q[2+Extra] && arrived && bad_pointer;
    step_limit_q   <= active_q[2+Extra] && arrived && step_limit;
  end

  assign bad_pointer_o = bad_pointer_q;
  assign step_limit_o  = step_limit_q;

  // 3 product, 4 sum.
  logic [TimeBits-1:0] time5[3];

  for (genvar a = 0; a < 3; a++) begin : gen_time
    voxrt_plane_time #(
      .DistanceBits(DistanceBits),
      .TimeBits    (TimeBits)
    ) u_time (
      .clk_i,
      .distance_i(distance3_q[a]),
      .weight_i  (weight3_q[a]),
      .time_o    (time5[a])
    );
  end

  logic [TimeBits-1:0] key_time5_q;
  face_e               key_face5_q;
  logic                sinks3_q;

  always_ff @(posedge clk_i) begin
    sinks3_q <= sinks2;
    if (action3_q == Descend && !sinks3_q) stack_q[{slot[3], child_level3_q}] <= block3_q;
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    key_time5_q <= key_time_q[slot[4]];
    key_face5_q <= key_face_q[slot[4]];
  end

  // 5 compare. Leaf: is x before y, y before z, z before x; pointer: is the middle plane before the key.
  logic [         2:0] before6_q;
  logic [TimeBits-1:0] time6_q[3], key_time6_q;
  face_e               key_face6_q;
  logic [  CellBits:0] far6_q   [3];
  logic [CellBits-1:0] corner6_q[3], size6_q;
  logic [         2:0] dead6_q;
  logic [  CellBits:0] far5     [3];
  logic [  TimeBits:0] ahead5   [3];  // Negative: before. Equal times go by axis.

  assign far5[0] = {1'b0, corner_x_q[slot[5]]} + {1'b0, size_q[slot[5]]};
  assign far5[1] = {1'b0, corner_y_q[slot[5]]} + {1'b0, size_q[slot[5]]};
  assign far5[2] = {1'b0, corner_z_q[slot[5]]} + {1'b0, size_q[slot[5]]};

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      // x is before y, y before z, and x before z.
      ahead5[a] = {time5[a], 1'b0} -
          (action5_q == Leave ? {time5[(a+1)%3], a != 2} : {key_time5_q, 2'(a) <= key_face5_q});
    end
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      before6_q[a] <= ahead5[a][TimeBits];
      if (dead_q[slot[5]][a] && action5_q != Leave) before6_q[a] <= time5[a][TimeBits-1];
    end
    time6_q      <= time5;
    key_time6_q  <= key_time5_q;
    key_face6_q  <= key_face5_q;
    far6_q       <= far5;
    corner6_q[0] <= corner_x_q[slot[5]];
    corner6_q[1] <= corner_y_q[slot[5]];
    corner6_q[2] <= corner_z_q[slot[5]];
    size6_q      <= size_q[slot[5]];
    dead6_q      <= dead_q[slot[5]];
    action6_q    <= action5_q;
    material6_q  <= material5_q;
  end

  // 6 select.
  logic                       x_before_y, y_before_z, x_before_z;
  logic        [         2:0] exit;  // One-hot.
  logic        [TimeBits-1:0] key_time7_q;
  face_e                      key_face7_q;
  logic        [CellBits-1:0] corner7_q[3], size7_q;
  logic                       ended7_q;
  logic        [  CellBits:0] next_size;  // One-hot.
  logic        [CellBits-1:0] kept;

  assign x_before_y = !dead6_q[0] && (dead6_q[1] || before6_q[0]);
  assign y_before_z = !dead6_q[1] && (dead6_q[2] || before6_q[1]);
  assign x_before_z = !dead6_q[0] && (dead6_q[2] || !before6_q[2]);
  assign exit       = {!x_before_z && !y_before_z, !x_before_y && y_before_z, x_before_y && x_before_z};

  always_comb begin
    next_size = '0;
    for (int unsigned a = 0; a < 3; a++) if (exit[a]) next_size |= far6_q[a] & ~{1'b0, corner6_q[a]};
    kept = ~(next_size[CellBits-1:0] - 1'b1);
  end

  always_ff @(posedge clk_i) begin
    key_time7_q <= key_time6_q;
    key_face7_q <= key_face6_q;
    corner7_q   <= corner6_q;
    size7_q     <= size6_q;
    ended7_q    <= action6_q == Finish;
    material7_q <= material6_q;
    if (action6_q == Descend || (Light && action6_q == Finish)) begin
      for (int unsigned a = 0; a < 3; a++) if (before6_q[a]) corner7_q[a] <= corner6_q[a] | (size6_q >> 1);
      size7_q <= size6_q >> 1;
    end
    if (action6_q == Leave) begin
      key_time7_q <= time6_q[2];
      key_face7_q <= FaceZ;
      if (exit[0]) begin
        key_time7_q <= time6_q[0];
        key_face7_q <= FaceX;
      end
      if (exit[1]) begin
        key_time7_q <= time6_q[1];
        key_face7_q <= FaceY;
      end
      for (int unsigned a = 0; a < 3; a++) begin
        corner7_q[a] <= (exit[a] ? far6_q[a][CellBits-1:0] : corner6_q[a]) & kept;
      end
      size7_q  <= next_size[CellBits-1:0];
      ended7_q <= (next_size[CellBits:SubBits] & world_i) != '0 || dead6_q == '1;
    end
  end

  // 7 turn.
  logic                 finishes, meets_face, reflects, reflects_out, shows_mean, sinks, requests, ends;
  logic                 starts, resolves;
  logic [CellBits-1:0]  top_size, size7;
  logic [BlockBits-1:0] block7;
  logic [2:0]           upper7, mirrored7, octant7;  // Of the root or of the cell: halves, in the mirrored frame.
  mirrors_t             met7;

  // A ray that finishes is reflected, or goes on to the sub-cell, or ends.
  assign finishes   = active_q[7+Extra] && ended7_q;
  assign meets_face = finishes && material7_q != '0 && key_face7_q != FaceNone && !shadow7;
  assign sinks      = Light && meets_face && light_i && !reflects && !reflects_out && !shows_mean;
  assign requests   = Light && active_q[7+Extra] && sinks7 && size7_q[0] &&
      (request_ready_i || (ray_valid_i && ray_shadow_i && !ray_resolved_i));
  assign ends       = finishes && !reflects && !sinks;

  assign starts   = ray_valid_i && !ray_resolved_i && (ray_shadow_i || take_ready_i) &&
      (ends || requests || !active_q[7+Extra]);
  assign resolves = ray_valid_i && ray_resolved_i && (ray_shadow_i || take_ready_i) && !finishes && !requests;
  assign top_size = CellBits'(world_i[MaxDepth:1]) << SubBits;

  assign ray_ready_o = starts || resolves;
  assign take_o      = ray_ready_o && !ray_shadow_i;

  assign fill_o        = ends || resolves;
  assign fill_tag_o    = finishes || requests ? tag_q[slot[7]] : ray_shadow_i ? ray_tag_i : take_tag_i;
  assign store_pixel_o = (finishes && !reflects && !shadow7) || (resolves && !ray_shadow_i);
  assign fill_pixel_o  = !finishes ? ray_pixel_i : material7_q == '0 || reflects_out ?
      '{material: '0, face: FaceNone} : '{material: material7_q, face: key_face7_q};

  assign size7  = starts || reflects ? top_size : size7_q;
  assign block7 = size7 == top_size ? root_i[BlockBits-1:0] : stack_q[{slot[7], level_of(size7_q)}];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) octant7[a] = (corner7_q[a] & size7) != '0;
    if (starts) octant7 = ray_octant_i;
    else if (reflects) octant7 = upper7;
  end

  always_ff @(posedge clk_i) begin
    active_q  <= rst_ni ? {active_q[Slots-2:0], starts || (active_q[7+Extra] && !ends && !requests)} : '0;
    block0_q  <= block7;
    octant0_q <= octant7 ^ (starts ? ray_mirrored_i : mirrored7);

    size_q[slot[7]]     <= size7;
    corner_x_q[slot[7]] <= starts || reflects ? (octant7[0] ? top_size : '0) : corner7_q[0];
    corner_y_q[slot[7]] <= starts || reflects ? (octant7[1] ? top_size : '0) : corner7_q[1];
    corner_z_q[slot[7]] <= starts || reflects ? (octant7[2] ? top_size : '0) : corner7_q[2];
    key_time_q[slot[7]] <= starts ? ray_entry_time_i : key_time7_q;
    key_face_q[slot[7]] <= starts ? ray_entry_face_i : key_face7_q;
    if (starts) begin
      weight_x_q[slot[7]] <= ray_weight_i[0];
      weight_y_q[slot[7]] <= ray_weight_i[1];
      weight_z_q[slot[7]] <= ray_weight_i[2];
      dead_q[slot[7]]     <= ray_dead_i;
      tag_q[slot[7]]      <= ray_shadow_i ? ray_tag_i : take_tag_i;
    end
    if (starts || reflects) mirrored_q[slot[7]] <= starts ? ray_mirrored_i : mirrored7;
  end

  // The mirror image of the ray.
  if (Mirrors) begin : gen_mirrors
    logic                           reflects_here, ends_here, outward7_q;
    logic signed [DistanceBits-1:0] shift7_q;
    logic        [    MaxDepth-1:0] plane6;

    always_comb begin
      unique case (key_face6_q)
        FaceX:   plane6 = corner6_q[0][CellBits-1:SubBits];
        FaceY:   plane6 = corner6_q[1][CellBits-1:SubBits];
        default: plane6 = corner6_q[2][CellBits-1:SubBits];
      endcase
    end

    always_ff @(posedge clk_i) begin
      shift7_q   <= (DistanceBits'(world_i) - DistanceBits'({plane6, 1'b0})) <<< FractionBits;
      outward7_q <= plane6 == '0;  // The world's own side: back where the ray came from there is nothing.
    end

    voxrt_reflect #(
      .Slots(Slots)
    ) u_reflect (
      .clk_i,
      .bounces_i,
      .table_write_i,
      .table_material_i,
      .table_row_i,
      .material_i(material3_q),
      .slot5_i   (slot[5]),
      .slot7_i   (slot[7]),
      .hit_i     (meets_face),
      .starts_i  (starts),
      .reflects_o(reflects_here),
      .ends_o    (ends_here),
      .met_o     (met7)
    );

    assign reflects     = reflects_here && !outward7_q;
    assign reflects_out = reflects_here && outward7_q;
    assign shows_mean   = ends_here;

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        mirrored7[a] = mirrored_q[slot[7]][a] ^ (reflects && key_face7_q == 2'(a));
        upper7[a]    = key_face7_q == 2'(a) ? !shift7_q[DistanceBits-1] : (corner7_q[a] & top_size) != '0;
      end
    end
  end else begin : gen_no_mirrors
    logic unused_mirrors;
    assign unused_mirrors = &{table_write_i, table_material_i, table_row_i, bounces_i, met7};
    assign reflects     = 1'b0;
    assign reflects_out = 1'b0;
    assign shows_mean   = 1'b0;
    assign met7         = '0;
    assign mirrored7    = mirrored_q[slot[7]];
    assign upper7       = '0;
  end

  // Origins by slot.
  if (OwnOrigin) begin : gen_own_origin
    logic signed [DistanceBits-1:0] origin_x_q[Slots], origin_y_q[Slots], origin_z_q[Slots];
    logic signed [DistanceBits-1:0] shift7;
    logic                           unused_origin;
    assign unused_origin = &{origin_i[0], origin_i[1], origin_i[2], mirrored_origin_i[0], mirrored_origin_i[1],
                             mirrored_origin_i[2]};

    if (Mirrors) begin : gen_shift
      assign shift7 = gen_mirrors.shift7_q;
    end else begin : gen_no_shift
      assign shift7 = '0;
    end

    assign origin2[0] = origin_x_q[slot[2]];
    assign origin2[1] = origin_y_q[slot[2]];
    assign origin2[2] = origin_z_q[slot[2]];

    always_ff @(posedge clk_i) begin
      if (starts) origin_x_q[slot[7]] <= DistanceBits'(ray_origin_i[0]);
      else if (reflects && key_face7_q == FaceX) origin_x_q[slot[7]] <= origin_x_q[slot[7]] + shift7;
      if (starts) origin_y_q[slot[7]] <= DistanceBits'(ray_origin_i[1]);
      else if (reflects && key_face7_q == FaceY) origin_y_q[slot[7]] <= origin_y_q[slot[7]] + shift7;
      if (starts) origin_z_q[slot[7]] <= DistanceBits'(ray_origin_i[2]);
      else if (reflects && key_face7_q == FaceZ) origin_z_q[slot[7]] <= origin_z_q[slot[7]] + shift7;
    end

    assign before_dead2 = dead_q[slot[2]];
  end else begin : gen_shared_origin
    logic unused_ray_origin;
    assign unused_ray_origin = &{ray_origin_i[0], ray_origin_i[1], ray_origin_i[2]};

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        origin2[a] = (mirrored_q[slot[2]][a] ? mirrored_origin_i[a] : origin_i[a]) |
            DistanceBits'(dead_q[slot[2]][a] ? 2 ** FractionBits - 1 : 0);
      end
    end

    assign before_dead2 = '0;
  end

  // Down to the sub-cell, and the answers of shadow rays.
  if (Light) begin : gen_light
    logic              sinks_q[Slots];
    logic              shadow_q[Slots];
    logic [MaxDepth:0] light_plane[3];
    logic              in_shadow;

    assign sinks0  = sinks_q[slot_q[0]];
    assign sinks2  = sinks_q[slot[2]];
    assign sinks7  = sinks_q[slot[7]];
    assign shadow2 = shadow_q[slot[2]];
    assign shadow7 = shadow_q[slot[7]];

    always_ff @(posedge clk_i) begin
      if (starts || sinks) sinks_q[slot[7]] <= !starts;
      if (starts) shadow_q[slot[7]] <= ray_shadow_i;
    end

    // The hit's plane is before the light's.
    always_comb begin
      in_shadow = key_face7_q == FaceNone;
      for (int unsigned a = 0; a < 3; a++) begin
        light_plane[a] = mirrored_q[slot[7]][a] ? mirrored_light_plane_i[a] : light_plane_i[a];
        if (key_face7_q == 2'(a) && {1'b0, corner7_q[a][CellBits-1:SubBits]} < light_plane[a]) in_shadow = 1'b1;
      end
    end

    assign fill_lit_o         = finishes ? material7_q == '0 || !in_shadow : ray_lit_i;
    assign request_o          = requests;
    assign request_tag_o      = tag_q[slot[7]];
    assign request_face_o     = key_face7_q;
    assign request_mirrored_o = mirrored7;
    assign request_place_o    = corner7_q;
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light = &{request_ready_i, ray_lit_i, light_i, light_plane_i[0], light_plane_i[1], light_plane_i[2],
                            mirrored_light_plane_i[0], mirrored_light_plane_i[1], mirrored_light_plane_i[2]};
    assign {sinks0, sinks2, sinks7, shadow2, shadow7} = '0;
    assign fill_lit_o         = 1'b0;
    assign request_o          = 1'b0;
    assign request_tag_o      = '0;
    assign request_face_o     = FaceNone;
    assign request_mirrored_o = '0;
    assign request_place_o    = '{default: '0};
  end

  // Detail.
  assign store_detail_o = (ends && !shadow7) || (resolves && !ray_shadow_i) || requests;

  always_comb begin
    fill_detail_o = '0;
    if (Mirrors && shows_mean) fill_detail_o = DetailBits'(met7);
    if (Light && requests) begin
      fill_detail_o = DetailBits'({mirrored7, request_place_o[2], request_place_o[1], request_place_o[0]});
    end
    fill_detail_o[DetailBits-1-:2] = requests ? ShadeLight : shows_mean ? ShadeMean : ShadeAngle;
  end
endmodule
