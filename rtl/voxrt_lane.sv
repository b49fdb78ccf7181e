// Follows rays through the octree: a ring of eleven stages that holds eleven rays; every clock one of them reads one
// octree word. A memory that takes longer than two clocks adds a stage and a ray a clock, before stage 1.
//
//   stage     work                                                                        state of a slot, read
//   0 fetch   the memory takes the address                                                mirrored, dead
//   1 wait    the memory's output register; distance to the cell's near planes            -
//   2 decode  leaf or pointer; distance to the far planes (leaf) or middle planes         weight
//   3 product distance x weight, in two parts; the pointer goes onto the stack            -
//   4 sum     T of three planes                                                           key, dead
//   5 compare leaf: T among themselves; pointer: T with the ray's key                     corner, size
//   6 exit    leaf: the axis that it is left by, and the corner's place on that axis      -
//   7 add     the size to that place                                                      -
//   8 turn    the size of the next cell; the smallest T is the new key; a new ray in the  tag
//             place of one that ended
//   9 corner  the next cell's corner and octant; the stack is read                        mirrored
//   10 block  the block from the stack, or the root's                                     -
//
// A ray's key (T, face) is the last plane that it crossed. Corner and size (one-hot) are those of the cell read; its
// octant is the corner's bit at size. Planes of cells at that time crossed are those with keys <= the ray's key, so
// no two planes tie and a pointer's child is found by three compares. All T that are ever compared lie within the
// world's side of each other, so that T modulo 2**KeyBits is enough.
//
// The next corner is the old one with one bit set, that of the next size:
//   pointer   size / 2, on the axes whose middle plane is behind
//   leaf      place + size on the exit axis sets one bit and clears those below it, down to size. The bit set is the
//             size of the cell that follows, below the common ancestor, whose block is on the stack under that size;
//             the bits cleared are cleared on all axes. Outside the world when the bit is the world's own size.
//   new ray   half the world, on the axes of its first octant; all other bits are cleared
//
// The ring never stops: rays start only when the pixel buffer has a place for them. A word that the memory did not
// deliver (mem_ack_i low) is asked for again at the ray's next turn.
//
// Mirrors: a ray that hits one starts anew at the root in its slot, with the key of the hit, the mirror bit of that axis
// flipped and the origin moved by 16 (side - 2 plane), so that the plane's T stays; it stands in the cell that it came
// from. The root's octant needs no compare: that cell and the one hit differ on the one axis alone.
//
// Light: a camera's ray that hits goes on with its descent, by the same compares, to the sub-cell of 1/16 voxel: no word is
// read, corner and size have four bits more. The sub-cell leaves for voxrt_light; the slot is free. A shadow ray, in
// 1/32 voxel, comes back with the tag. Whether what it hits is before the light is a compare of cells on the axis of
// the face: T_hit < T_light there says that the plane is before the light's coordinate. Another such compare finds
// faces that are turned away from the light, whose rays need neither sub-cell nor shadow ray.
// A ray whose sub-cell finds voxrt_light's queue full asks again at its next turn, and changes places with a shadow ray if
// one waits: so neither waits for the other for ever.
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
  localparam int unsigned KeyBits      = key_bits(MaxDepth, Light),
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
  // Planes of lower number are before the light, or not behind it, by axis, in the grid's frame ([0]) and mirrored.
  input  logic        [      MaxDepth:0] before_light_i    [2][3],
  input  logic        [      MaxDepth:0] to_light_i        [2][3],
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
  input  logic        [     KeyBits-1:0] ray_entry_time_i,
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
  localparam int unsigned Stages = 11;
  localparam int unsigned Extra = MemoryClocks - 2;
  localparam int unsigned Slots = Stages + Extra;
  localparam int unsigned SlotBits = $clog2(Slots);
  localparam int unsigned LevelBits = $clog2(MaxDepth);

  // Rays have their own origins, and a root that is a leaf is read as if it were eight.
  localparam bit OwnOrigin = Light || Mirrors;
  localparam int unsigned DistanceBits = Mirrors ? reflected_distance_bits(MaxDepth, PositionBits) : OriginBits;
  localparam int unsigned TimeBits = DistanceBits + WeightBits;
  // Corners and sizes count 1 / 2**SubBits voxel.
  localparam int unsigned SubBits = Light ? FractionBits : 0;
  localparam int unsigned CellBits = MaxDepth + SubBits;

  // Which slot is in which stage, and whether there is a ray in it that has not ended.
  logic [SlotBits-1:0] slot  [Stages];
  logic [SlotBits-1:0] slot_q[Slots];
  logic [   Slots-1:0] active_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= slot_q[(s+Slots-1)%Slots];
    if (!rst_ni) for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= SlotBits'(s);
  end

  always_comb for (int unsigned s = 0; s < Stages; s++) slot[s] = slot_q[s+Extra];

  // State by slot.
  logic        [WeightBits-1:0] weight_x_q[Slots], weight_y_q[Slots], weight_z_q[Slots];
  logic        [           2:0] mirrored_q[Slots];
  logic        [           2:0] dead_q    [Slots];
  logic        [   TagBits-1:0] tag_q     [Slots];
  logic        [   KeyBits-1:0] key_time_q[Slots];
  face_e                        key_face_q[Slots];
  logic        [  CellBits-1:0] corner_x_q[Slots], corner_y_q[Slots], corner_z_q[Slots];
  logic        [  CellBits-1:0] size_q    [Slots];

  // 0 fetch.
  logic [BlockBits-1:0] block0_q;
  logic [2:0]           octant0_q;
  logic [CellBits-1:0]  corner0_q[Extra+1][3];
  logic [CellBits-1:0]  size0_q  [Extra+1];
  logic [CellBits-1:0]  corner1_q[3];
  logic [CellBits-1:0]  size1_q;
  logic [2:0]           mirrored1_q, dead1_q;
  logic                 sinks0, sinks2, sinks3, sinks8;  // The ray has hit, and looks for the sub-cell.
  logic                 shadow1, shadow2, shadow8;       // It is a shadow ray.
  logic                 root_is_leaf;

  assign root_is_leaf = OwnOrigin && root_i[PayloadBits];
  assign mem_read_o   = active_q[0] && !sinks0 && !root_is_leaf;
  assign mem_block_o  = block0_q;
  assign mem_octant_o = octant0_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 1; s <= Extra; s++) begin
      corner0_q[s] <= corner0_q[s-1];
      size0_q[s]   <= size0_q[s-1];
    end
    corner1_q   <= corner0_q[Extra];
    size1_q     <= size0_q[Extra];
    mirrored1_q <= mirrored_q[slot[0]];
    dead1_q     <= dead_q[slot[0]];
  end

  // 1 wait, 2 decode: from the origin to the cell's near planes; to the far or middle planes.
  logic signed [DistanceBits-1:0] distance3_q[3];
  logic        [    CellBits-1:0] size2_q;
  logic                           takes_far;

  always_ff @(posedge clk_i) size2_q <= size1_q;

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

  assign word        = root_is_leaf ? root_i : mem_word_i;
  assign arrived     = (mem_ack_i || root_is_leaf) && !sinks2;
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

  // A ray that hits, or looks for the sub-cell, needs the middle planes of its leaf.
  assign takes_far = Light ? action == Leave : leaf;

  logic        [  WeightBits-1:0] weight3_q  [3];
  action_e                        action3_q, action4_q, action5_q, action6_q, action7_q;
  logic        [   BlockBits-1:0] block3_q;
  material_t                      material3_q, material4_q, material5_q, material6_q, material7_q, material8_q;
  logic        [   LevelBits-1:0] child_level3_q;
  logic                           bad_pointer_q, step_limit_q;

  // Binary number of a one-hot size.
  function automatic logic [LevelBits-1:0] level_of(logic [CellBits-1:0] size);
    level_of = '0;
    for (int unsigned i = 0; i < MaxDepth; i++) if (size[i+SubBits]) level_of |= LevelBits'(i);
  endfunction

  always_ff @(posedge clk_i) begin
    action3_q <= action;
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
  logic signed [TimeBits-1:0] exact_time5[3];
  logic        [KeyBits-1:0]  time5      [3];

  for (genvar a = 0; a < 3; a++) begin : gen_time
    voxrt_plane_time #(
      .DistanceBits(DistanceBits)
    ) u_time (
      .clk_i,
      .distance_i(distance3_q[a]),
      .weight_i  (weight3_q[a]),
      .time_o    (exact_time5[a])
    );

    assign time5[a] = KeyBits'(exact_time5[a]);
  end

  logic [KeyBits-1:0] key_time5_q;
  face_e              key_face5_q;
  logic [        2:0] dead5_q;

  always_ff @(posedge clk_i) begin
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    key_time5_q <= key_time_q[slot[4]];
    key_face5_q <= key_face_q[slot[4]];
    dead5_q     <= dead_q[slot[4]];
  end

  // 5 compare. Leaf: is x before y, y before z, z before x; pointer: is the middle plane before the key, on a dead
  // axis before the start. Equal times go by axis: x is before y, y before z, and x before z.
  logic        [ KeyBits-1:0] other    [3];
  logic        [   KeyBits:0] difference[3];
  logic        [         2:0] first;  // Of equals.
  logic        [         2:0] before6_q;
  logic        [ KeyBits-1:0] time6_q  [3];
  face_e                      key_face6_q, key_face7_q;
  logic        [CellBits-1:0] corner6_q[3], size6_q;
  logic        [         2:0] dead6_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      other[a]      = action5_q == Leave ? time5[(a+1)%3] : key_time5_q;
      first[a]      = action5_q == Leave ? a != 2 : 2'(a) <= key_face5_q;
      difference[a] = {time5[a], 1'b0} - {other[a], first[a]};
    end
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      before6_q[a] <= difference[a][KeyBits];
      if (dead5_q[a] && action5_q != Leave) before6_q[a] <= time5[a][KeyBits-1];
    end
  end

  always_ff @(posedge clk_i) begin
    time6_q      <= time5;
    key_face6_q  <= key_face5_q;
    corner6_q[0] <= corner_x_q[slot[5]];
    corner6_q[1] <= corner_y_q[slot[5]];
    corner6_q[2] <= corner_z_q[slot[5]];
    size6_q      <= size_q[slot[5]];
    dead6_q      <= dead5_q;
    action6_q    <= action5_q;
    material6_q  <= material5_q;
  end

  // 6 exit.
  logic                      x_before_y, y_before_z, x_before_z;
  logic       [         2:0] exit;  // One-hot.
  face_e                     exit_face, exit_face7_q, exit_face8_q;
  logic       [ KeyBits-1:0] time7_q  [3], time8_q[3];
  logic       [CellBits-1:0] corner7_q[3], corner8_q[3];
  logic       [CellBits-1:0] size7_q, place7_q;
  logic       [         2:0] set7_q, set8_q;  // Axes on which the corner gets the next size's bit.
  logic                      dead7_q, descends6, descends7_q;

  assign x_before_y = !dead6_q[0] && (dead6_q[1] || before6_q[0]);
  assign y_before_z = !dead6_q[1] && (dead6_q[2] || before6_q[1]);
  assign x_before_z = !dead6_q[0] && (dead6_q[2] || !before6_q[2]);
  assign exit       = {!x_before_z && !y_before_z, !x_before_y && y_before_z, x_before_y && x_before_z};
  assign exit_face  = exit[0] ? FaceX : exit[1] ? FaceY : FaceZ;
  assign descends6  = action6_q == Descend || (Light && action6_q == Finish);

  always_ff @(posedge clk_i) begin
    // Registers keep what they have where no ray is.
    if (active_q[6+Extra]) begin
      time7_q   <= time6_q;
      corner7_q <= corner6_q;
    end
    action7_q    <= action6_q;
    material7_q  <= material6_q;
    key_face7_q  <= key_face6_q;
    exit_face7_q <= exit_face;
    size7_q      <= size6_q;
    place7_q     <= corner6_q[exit_face];
    dead7_q      <= dead6_q == '1;
    descends7_q  <= descends6;
    set7_q       <= action6_q == Leave ? exit : descends6 ? before6_q : '0;
  end

  // 7 add.
  logic [CellBits:0]   sum8_q;
  logic [CellBits-1:0] place8_q, inner_size8_q;
  logic                leaves8_q, finished8_q;
  face_e               face8_q, key_face8_q;

  always_ff @(posedge clk_i) begin
    if (active_q[7+Extra]) begin
      time8_q   <= time7_q;
      corner8_q <= corner7_q;
    end
    sum8_q        <= {1'b0, place7_q} + (action7_q == Leave ? {1'b0, size7_q} : '0);
    place8_q      <= place7_q;
    inner_size8_q <= action7_q == Leave ? '0 : descends7_q ? size7_q >> 1 : size7_q;
    set8_q        <= set7_q;
    exit_face8_q  <= exit_face7_q;
    leaves8_q     <= action7_q == Leave;
    finished8_q   <= action7_q == Finish || (action7_q == Leave && dead7_q);
    material8_q   <= material7_q;
    face8_q       <= material7_q == '0 ? FaceNone : key_face7_q;
    key_face8_q   <= key_face7_q;
  end

  // 8 turn. A ray that finishes is reflected, or goes on to the sub-cell, or ends.
  logic                finishes, meets_face, reflects, reflects_out, shows_mean, is_lightable, sinks, requests;
  logic                turned_away;
  logic                ends, starts, resolves, renews;
  logic [CellBits-1:0] corner9_q[3], size9_q, cleared9_q, top_size;
  logic [         2:0] set9_q, set8, mirrored8;
  logic [ KeyBits-1:0] keys     [4];
  face_e               key_face;

  assign finishes   = active_q[8+Extra] && (finished8_q || (sum8_q[CellBits:SubBits] & world_i) != '0);
  assign meets_face = finishes && face8_q != FaceNone && !shadow8;
  assign is_lightable = Light && meets_face && light_i && !reflects && !reflects_out && !shows_mean;
  assign sinks        = is_lightable && !turned_away;
  assign requests   = Light && active_q[8+Extra] && sinks8 && inner_size8_q[0] &&
      (request_ready_i || (ray_valid_i && ray_shadow_i && !ray_resolved_i));
  assign ends       = finishes && !reflects && !sinks;

  assign starts   = ray_valid_i && !ray_resolved_i && (ray_shadow_i || take_ready_i) &&
      (ends || requests || !active_q[8+Extra]);
  assign resolves = ray_valid_i && ray_resolved_i && (ray_shadow_i || take_ready_i) && !finishes && !requests;
  assign renews   = starts || reflects;
  assign top_size = CellBits'(world_i[MaxDepth:1]) << SubBits;

  assign ray_ready_o = starts || resolves;
  assign take_o      = ray_ready_o && !ray_shadow_i;

  assign fill_o        = ends || resolves;
  assign fill_tag_o    = finishes || requests ? tag_q[slot[8]] : ray_shadow_i ? ray_tag_i : take_tag_i;
  assign store_pixel_o = (finishes && !reflects && !shadow8) || (resolves && !ray_shadow_i);
  assign fill_pixel_o  = !finishes ? ray_pixel_i : reflects_out ?
      '{material: '0, face: FaceNone} : '{material: material8_q, face: face8_q};

  // FaceNone stands for a new ray's time.
  assign key_face = face_e'(exit_face8_q | {2{starts}});
  assign keys     = '{time8_q[0], time8_q[1], time8_q[2], ray_entry_time_i};

  always_ff @(posedge clk_i) begin
    size9_q    <= renews ? top_size : inner_size8_q | (sum8_q[CellBits-1:0] & ~place8_q);
    cleared9_q <= place8_q & ~sum8_q[CellBits-1:0];
    set9_q     <= starts ? ray_octant_i : set8;
    corner9_q  <= corner8_q;
    if (renews) corner9_q <= '{default: '0};
    active_q          <= {active_q[Slots-2:0], active_q[Slots-1]};
    active_q[9+Extra] <= starts || (active_q[8+Extra] && !ends && !requests);
    if (!rst_ni) active_q <= '0;
    if (starts || leaves8_q) begin
      key_time_q[slot[8]] <= keys[key_face];
      key_face_q[slot[8]] <= starts ? ray_entry_face_i : exit_face8_q;
    end
    if (starts) begin
      weight_x_q[slot[8]] <= ray_weight_i[0];
      weight_y_q[slot[8]] <= ray_weight_i[1];
      weight_z_q[slot[8]] <= ray_weight_i[2];
      dead_q[slot[8]]     <= ray_dead_i;
      tag_q[slot[8]]      <= ray_shadow_i ? ray_tag_i : take_tag_i;
    end
    if (renews) mirrored_q[slot[8]] <= starts ? ray_mirrored_i : mirrored8;
  end

  // 9 corner. The stack has the blocks of cells by slot and size, in block RAM.
  (* ram_style = "block" *)
  logic [BlockBits-1:0] stack_q[2 ** (SlotBits + LevelBits)];
  logic [CellBits-1:0]  corner10_q[3], size10_q;
  logic [BlockBits-1:0] block10_q;
  logic [2:0]           octant10_q;
  logic                 top10_q;

  always_ff @(posedge clk_i) begin
    if (action3_q == Descend && !sinks3) stack_q[{slot[3], child_level3_q}] <= block3_q;
    block10_q <= stack_q[{slot[9], level_of(size9_q)}];
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      corner10_q[a] <= (corner9_q[a] & ~cleared9_q) | (set9_q[a] ? size9_q : '0);
      octant10_q[a] <= (set9_q[a] || (corner9_q[a] & size9_q) != '0) != mirrored_q[slot[9]][a];
    end
    size10_q <= size9_q;
    top10_q  <= (size9_q & top_size) != '0;
  end

  // 10 block.
  always_ff @(posedge clk_i) begin
    block0_q     <= top10_q ? root_i[BlockBits-1:0] : block10_q;
    octant0_q    <= octant10_q;
    corner0_q[0] <= corner10_q;
    size0_q[0]   <= size10_q;

    corner_x_q[slot[10]] <= corner10_q[0];
    corner_y_q[slot[10]] <= corner10_q[1];
    corner_z_q[slot[10]] <= corner10_q[2];
    size_q[slot[10]]     <= size10_q;
  end

  // Distances from the ray's own origin, or from the camera.
  if (OwnOrigin) begin : gen_own_origin
    logic signed [DistanceBits-1:0] origin_x_q[Slots], origin_y_q[Slots], origin_z_q[Slots];
    logic signed [DistanceBits-1:0] origin1[3], near2_q[3], step2, shift8;
    logic                           unused_origin;

    assign unused_origin = &{origin_i[0], origin_i[1], origin_i[2], mirrored_origin_i[0], mirrored_origin_i[1],
                             mirrored_origin_i[2], mirrored1_q};

    assign origin1[0] = origin_x_q[slot[1]];
    assign origin1[1] = origin_y_q[slot[1]];
    assign origin1[2] = origin_z_q[slot[1]];
    assign step2      = (DistanceBits'(size2_q) << (FractionBits - SubBits)) >> !takes_far;

    // Planes of a dead axis must not meet the origin: a distance one less has the sign that tells where it is.
    always_ff @(posedge clk_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        near2_q[a] <= (DistanceBits'(corner1_q[a]) << (FractionBits - SubBits) << shadow1) - origin1[a] -
            DistanceBits'(dead1_q[a]);
        distance3_q[a] <= near2_q[a] + (step2 << shadow2);
      end
      if (starts) origin_x_q[slot[8]] <= DistanceBits'(ray_origin_i[0]);
      else if (reflects && key_face8_q == FaceX) origin_x_q[slot[8]] <= origin_x_q[slot[8]] + shift8;
      if (starts) origin_y_q[slot[8]] <= DistanceBits'(ray_origin_i[1]);
      else if (reflects && key_face8_q == FaceY) origin_y_q[slot[8]] <= origin_y_q[slot[8]] + shift8;
      if (starts) origin_z_q[slot[8]] <= DistanceBits'(ray_origin_i[2]);
      else if (reflects && key_face8_q == FaceZ) origin_z_q[slot[8]] <= origin_z_q[slot[8]] + shift8;
    end

    if (Mirrors) begin : gen_shift
      assign shift8 = gen_mirrors.shift8_q;
    end else begin : gen_no_shift
      assign shift8 = '0;
    end
  end else begin : gen_shared_origin
    localparam int unsigned WholeBits = DistanceBits - FractionBits;
    logic signed [   WholeBits-1:0] near2_q    [3];
    logic        [FractionBits-1:0] fraction2_q[3];
    logic                           unused_origin;

    assign unused_origin = &{ray_origin_i[0], ray_origin_i[1], ray_origin_i[2], shadow1, shadow2};

    // The fraction of corner - origin is the other origin's, as the two add up to whole voxels. On a dead axis the
    // origin's fraction counts as above 0.
    for (genvar a = 0; a < 3; a++) begin : gen_near
      logic whole;
      assign whole = origin_i[a][FractionBits-1:0] == '0 && !dead1_q[a];

      always_ff @(posedge clk_i) begin
        near2_q[a] <= WholeBits'(corner1_q[a]) + WholeBits'(whole)
            + ~WholeBits'((mirrored1_q[a] ? mirrored_origin_i[a] : origin_i[a]) >>> FractionBits);
        fraction2_q[a] <= mirrored1_q[a] ? origin_i[a][FractionBits-1:0] : mirrored_origin_i[a][FractionBits-1:0];
        distance3_q[a] <= {near2_q[a] + WholeBits'({1'b0, takes_far ? size2_q : size2_q >> 1}), fraction2_q[a]};
      end
    end
  end

  // The mirror image of a ray.
  mirrors_t met8;

  if (Mirrors) begin : gen_mirrors
    logic                           reflects_here, outward8_q;
    logic signed [DistanceBits-1:0] shift8_q;
    logic        [    MaxDepth-1:0] plane7;

    always_comb begin
      unique case (key_face7_q)
        FaceX:   plane7 = corner7_q[0][CellBits-1:SubBits];
        FaceY:   plane7 = corner7_q[1][CellBits-1:SubBits];
        default: plane7 = corner7_q[2][CellBits-1:SubBits];
      endcase
    end

    always_ff @(posedge clk_i) begin
      shift8_q   <= (DistanceBits'(world_i) - DistanceBits'({plane7, 1'b0})) <<< FractionBits;
      outward8_q <= plane7 == '0;  // The world's own side: back where the ray came from there is nothing.
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
      .slot6_i   (slot[6]),
      .slot8_i   (slot[8]),
      .hit_i     (meets_face),
      .starts_i  (starts),
      .reflects_o(reflects_here),
      .ends_o    (shows_mean),
      .met_o     (met8)
    );

    assign reflects     = reflects_here && !outward8_q;
    assign reflects_out = reflects_here && outward8_q;

    // The root's octant in which the ray goes on.
    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        mirrored8[a] = mirrored_q[slot[8]][a] ^ (reflects && key_face8_q == 2'(a));
        set8[a]      = set8_q[a];
        if (reflects) set8[a] = key_face8_q == 2'(a) ? !shift8_q[DistanceBits-1] : (corner8_q[a] & top_size) != '0;
      end
    end
  end else begin : gen_no_mirrors
    logic unused_mirrors;
    assign unused_mirrors = &{table_write_i, table_material_i, table_row_i, bounces_i, met8, key_face8_q};
    assign {reflects, reflects_out, shows_mean} = '0;
    assign met8      = '0;
    assign mirrored8 = mirrored_q[slot[8]];
    assign set8      = set8_q;
  end

  // Down to the sub-cell, and the answers of shadow rays.
  if (Light) begin : gen_light
    logic              sinks_q [Slots];
    logic              shadow_q[Slots];
    logic              in_shadow;

    assign sinks0  = sinks_q[slot_q[0]];
    assign sinks2  = sinks_q[slot[2]];
    assign sinks3  = sinks_q[slot[3]];
    assign sinks8  = sinks_q[slot[8]];
    assign shadow1 = shadow_q[slot[1]];
    assign shadow2 = shadow_q[slot[2]];
    assign shadow8 = shadow_q[slot[8]];

    always_ff @(posedge clk_i) begin
      if (starts || sinks) sinks_q[slot[8]] <= !starts;
      if (starts) shadow_q[slot[8]] <= ray_shadow_i;
    end

    // Of a shadow ray: what it hits is before the light. Of another: the light is not in front of the face.
    always_comb begin
      in_shadow   = face8_q == FaceNone;
      turned_away = 1'b0;
      for (int unsigned a = 0; a < 3; a++) begin
        if (face8_q == 2'(a)) begin
          in_shadow   = {1'b0, corner8_q[a][CellBits-1:SubBits]} < before_light_i[mirrored_q[slot[8]][a]][a];
          turned_away = {1'b0, corner8_q[a][CellBits-1:SubBits]} < to_light_i[mirrored_q[slot[8]][a]][a];
        end
        request_place_o[a] = corner8_q[a] | CellBits'(set8_q[a]);
      end
    end

    assign fill_lit_o         = finishes ? shadow8 && (material8_q == '0 || !in_shadow) : ray_lit_i;
    assign request_o          = requests;
    assign request_tag_o      = tag_q[slot[8]];
    assign request_face_o     = key_face8_q;
    assign request_mirrored_o = mirrored8;
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light = &{request_ready_i, ray_lit_i, light_i, before_light_i[0][0], before_light_i[0][1],
                            before_light_i[0][2], before_light_i[1][0], before_light_i[1][1], before_light_i[1][2],
                            to_light_i[0][0], to_light_i[0][1], to_light_i[0][2], to_light_i[1][0], to_light_i[1][1],
                            to_light_i[1][2]};
    assign {sinks0, sinks2, sinks3, sinks8, shadow1, shadow2, shadow8, turned_away} = '0;
    assign fill_lit_o         = 1'b0;
    assign request_o          = 1'b0;
    assign request_tag_o      = '0;
    assign request_face_o     = FaceNone;
    assign request_mirrored_o = '0;
    assign request_place_o    = '{default: '0};
  end

  assign store_detail_o = (ends && !shadow8) || (resolves && !ray_shadow_i) || requests;

  always_comb begin
    fill_detail_o = '0;
    if (Mirrors && shows_mean) fill_detail_o = DetailBits'(met8);
    if (Light && requests) begin
      fill_detail_o = DetailBits'({mirrored8, request_place_o[2], request_place_o[1], request_place_o[0]});
    end
    fill_detail_o[DetailBits-1-:2] = requests || is_lightable ? ShadeLight : shows_mean ? ShadeMean : ShadeAngle;
  end
endmodule
