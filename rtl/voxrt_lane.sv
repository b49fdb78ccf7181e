// Follows rays through the octree: a ring of twelve stages that holds twelve rays; every clock one of them reads one
// octree word. A memory that takes longer than two clocks adds a stage and a ray a clock, before stage 1.
//
//   stage     work                                                                        state of a slot, read
//   0 fetch   the memory takes the address                                                mirrored, dead
//   1 wait    the memory's output register; distance to the cell's near planes            -
//   2 decode  leaf or pointer; distance to the far planes (leaf) or middle planes         weight
//   3 product distance x weight, in parts; the pointer goes onto the stack                -
//   4         parts                                                                       -
//   5         T of three planes                                                           key, dead
//   6 compare leaf: T among themselves; pointer: T with the ray's key                     corner, size
//   7 exit    leaf: the axis that it is left by, and the corner's place on that axis      -
//   8 add     the size to that place                                                      -
//   9 turn    the size of the next cell; the smallest T is the new key; a new ray in the  tag
//             place of one that ended
//   10 corner the next cell's corner and octant; the stack is read                        mirrored
//   11 block  the block from the stack, or the root's                                     -
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
// Mirrors and Light give rays more ways to go on than to leave a leaf: voxrt_lane_turn. With Light, corner and size have four
// bits more, for sub-cells, and rays that look for theirs read no word.
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
  localparam int unsigned Width        = pixel_bits(MaxDepth, Light, Mirrors)
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
  output logic                           store_o,
  output logic        [       Width-1:0] store_pixel_o,
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
  localparam int unsigned Stages = 12;
  localparam int unsigned Extra = MemoryClocks - 2;
  localparam int unsigned Slots = Stages + Extra;
  localparam int unsigned SlotBits = $clog2(Slots);
  localparam int unsigned LevelBits = $clog2(MaxDepth);

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
  logic [         2:0] mirrored_q[Slots];
  logic [         2:0] dead_q    [Slots];
  logic [ KeyBits-1:0] key_time_q[Slots];
  face_e               key_face_q[Slots];
  logic [CellBits-1:0] corner_x_q[Slots], corner_y_q[Slots], corner_z_q[Slots];
  logic [CellBits-1:0] size_q    [Slots];

  // 0 fetch.
  logic [BlockBits-1:0] block0_q;
  logic [2:0]           octant0_q;
  logic [CellBits-1:0]  corner0_q[Extra+1][3];
  logic [CellBits-1:0]  size0_q  [Extra+1];
  logic [CellBits-1:0]  corner1_q[3];
  logic [CellBits-1:0]  size1_q;
  logic [2:0]           mirrored1_q, dead1_q;
  logic                 sinks0, sinks2, sinks3;  // The ray has hit, and looks for the sub-cell.
  logic                 shadow1, shadow2;        // It is a shadow ray.
  logic                 root_is_leaf;

  // Then it is read as if it were eight.
  assign root_is_leaf = (Light || Mirrors) && root_i[PayloadBits];
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

  // 1 wait.
  logic [CellBits-1:0] size2_q;

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

  action_e              action3_q, action4_q, action5_q, action6_q, action7_q, action8_q;
  logic [BlockBits-1:0] block3_q;
  material_t            material3_q, material4_q, material5_q, material6_q;
  material_t            material7_q, material8_q, material9_q;
  logic [LevelBits-1:0] child_level3_q;
  logic                 bad_pointer_q, step_limit_q;

  // Binary number of a one-hot size.
  function automatic logic [LevelBits-1:0] level_of(logic [CellBits-1:0] size);
    level_of = '0;
    for (int unsigned i = 0; i < MaxDepth; i++) if (size[i+SubBits]) level_of |= LevelBits'(i);
  endfunction

  always_ff @(posedge clk_i) begin
    action3_q      <= action;
    block3_q       <= word[BlockBits-1:0];
    material3_q    <= leaf && !bad_pointer ? word[7:0] : '0;
    child_level3_q <= level_of(size2_q >> 1);
    bad_pointer_q  <= active_q[2+Extra] && arrived && bad_pointer;
    step_limit_q   <= active_q[2+Extra] && arrived && step_limit;
  end

  assign bad_pointer_o = bad_pointer_q;
  assign step_limit_o  = step_limit_q;

  // 1 to 5: T of planes. A ray that hits, or looks for the sub-cell, needs the middle planes of its leaf.
  logic                       starts, reflects;
  face_e                      key_face9_q;
  logic        [KeyBits-1:0]  time6[3];
  logic signed [MaxDepth+1:0] shift9;

  voxrt_cell_times #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Slots       (Slots),
    .Light       (Light),
    .Mirrors     (Mirrors)
  ) u_times (
    .clk_i,
    .origin_i,
    .mirrored_origin_i,
    .slot1_i     (slot[1]),
    .corner1_i   (corner1_q),
    .mirrored1_i (mirrored1_q),
    .dead1_i     (dead1_q),
    .shadow1_i   (shadow1),
    .slot2_i     (slot[2]),
    .size2_i     (size2_q),
    .shadow2_i   (shadow2),
    .takes_far_i (Light ? action == Leave : leaf),
    .slot9_i     (slot[9]),
    .starts_i    (starts),
    .weight_i    (ray_weight_i),
    .ray_origin_i,
    .reflects_i  (reflects),
    .face_i      (key_face9_q),
    .shift_i     (shift9),
    .time_o      (time6)
  );

  logic [KeyBits-1:0] key_time6_q;
  face_e              key_face6_q;
  logic [        2:0] dead6_q;

  always_ff @(posedge clk_i) begin
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    action6_q   <= action5_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    material6_q <= material5_q;
    key_time6_q <= key_time_q[slot[5]];
    key_face6_q <= key_face_q[slot[5]];
    dead6_q     <= dead_q[slot[5]];
  end

  // 6 compare. Leaf: is x before y, y before z, z before x; pointer: is the middle plane before the key, on a dead
  // axis before the start. Equal times go by axis: x is before y, y before z, and x before z.
  logic        [ KeyBits-1:0] other    [3];
  logic        [   KeyBits:0] difference[3];
  logic        [         2:0] first;  // Of equals.
  logic        [         2:0] before7_q;
  logic        [ KeyBits-1:0] time7_q  [3];
  face_e                      key_face7_q, key_face8_q;
  logic        [CellBits-1:0] corner7_q[3], size7_q;
  logic        [         2:0] dead7_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      other[a]      = action6_q == Leave ? time6[(a+1)%3] : key_time6_q;
      first[a]      = action6_q == Leave ? a != 2 : 2'(a) <= key_face6_q;
      difference[a] = {time6[a], 1'b0} - {other[a], first[a]};
    end
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      before7_q[a] <= difference[a][KeyBits];
      if (dead6_q[a] && action6_q != Leave) before7_q[a] <= time6[a][KeyBits-1];
    end
  end

  always_ff @(posedge clk_i) begin
    time7_q      <= time6;
    key_face7_q  <= key_face6_q;
    corner7_q[0] <= corner_x_q[slot[6]];
    corner7_q[1] <= corner_y_q[slot[6]];
    corner7_q[2] <= corner_z_q[slot[6]];
    size7_q      <= size_q[slot[6]];
    dead7_q      <= dead6_q;
    action7_q    <= action6_q;
    material7_q  <= material6_q;
  end

  // 7 exit.
  logic                      x_before_y, y_before_z, x_before_z;
  logic       [         2:0] exit;  // One-hot.
  face_e                     exit_face, exit_face8_q, exit_face9_q;
  logic       [ KeyBits-1:0] time8_q  [3], time9_q[3];
  logic       [CellBits-1:0] corner8_q[3], corner9_q[3];
  logic       [CellBits-1:0] size8_q, place8_q;
  logic       [         2:0] set8_q, set9_q;  // Axes on which the corner gets the next size's bit.
  logic                      dead8_q, descends7, descends8_q;

  assign x_before_y = !dead7_q[0] && (dead7_q[1] || before7_q[0]);
  assign y_before_z = !dead7_q[1] && (dead7_q[2] || before7_q[1]);
  assign x_before_z = !dead7_q[0] && (dead7_q[2] || !before7_q[2]);
  assign exit       = {!x_before_z && !y_before_z, !x_before_y && y_before_z, x_before_y && x_before_z};
  assign exit_face  = exit[0] ? FaceX : exit[1] ? FaceY : FaceZ;
  assign descends7  = action7_q == Descend || (Light && action7_q == Finish);

  always_ff @(posedge clk_i) begin
    // Registers keep what they have where no ray is.
    if (active_q[7+Extra]) begin
      time8_q   <= time7_q;
      corner8_q <= corner7_q;
    end
    action8_q    <= action7_q;
    material8_q  <= material7_q;
    key_face8_q  <= key_face7_q;
    exit_face8_q <= exit_face;
    size8_q      <= size7_q;
    place8_q     <= corner7_q[exit_face];
    dead8_q      <= dead7_q == '1;
    descends8_q  <= descends7;
    set8_q       <= action7_q == Leave ? exit : descends7 ? before7_q : '0;
  end

  // 8 add.
  logic [CellBits:0]   sum9_q;
  logic [CellBits-1:0] place9_q, inner_size9_q;
  logic                leaves9_q, finished9_q;
  face_e               face9_q;

  always_ff @(posedge clk_i) begin
    if (active_q[8+Extra]) begin
      time9_q   <= time8_q;
      corner9_q <= corner8_q;
    end
    sum9_q        <= {1'b0, place8_q} + (action8_q == Leave ? {1'b0, size8_q} : '0);
    place9_q      <= place8_q;
    inner_size9_q <= action8_q == Leave ? '0 : descends8_q ? size8_q >> 1 : size8_q;
    set9_q        <= set8_q;
    exit_face9_q  <= exit_face8_q;
    leaves9_q     <= action8_q == Leave;
    finished9_q   <= action8_q == Finish || (action8_q == Leave && dead8_q);
    material9_q   <= material8_q;
    face9_q       <= material8_q == '0 ? FaceNone : key_face8_q;
    key_face9_q   <= key_face8_q;
  end

  // 9 turn.
  logic                leaves, continues, renews;
  logic [CellBits-1:0] corner10_q[3], size10_q, cleared10_q, top_size;
  logic [         2:0] set10_q, set9, mirrored9;
  logic [ KeyBits-1:0] keys     [4];
  face_e               key_face;

  assign leaves   = (sum9_q[CellBits:SubBits] & world_i) != '0;
  assign renews   = starts || reflects;
  assign top_size = CellBits'(world_i[MaxDepth:1]) << SubBits;

  voxrt_lane_turn #(
    .MaxDepth(MaxDepth),
    .TagBits (TagBits),
    .Slots   (Slots),
    .Light   (Light),
    .Mirrors (Mirrors)
  ) u_turn (
    .clk_i,
    .world_i,
    .light_i,
    .bounces_i,
    .before_light_i,
    .to_light_i,
    .table_write_i,
    .table_material_i,
    .table_row_i,
    .slot0_i      (slot_q[0]),
    .slot_i       (slot[1:9]),
    .sinks0_o     (sinks0),
    .shadow1_o    (shadow1),
    .sinks2_o     (sinks2),
    .shadow2_o    (shadow2),
    .sinks3_o     (sinks3),
    .material3_i  (material3_q),
    .corner8_i    (corner8_q),
    .key_face8_i  (key_face8_q),
    .active_i     (active_q[9+Extra]),
    .finishes_i   (finished9_q || leaves),
    .material_i   (material9_q),
    .face_i       (face9_q),
    .key_face_i   (key_face9_q),
    .mirrored_i   (mirrored_q[slot[9]]),
    .corner_i     (corner9_q),
    .set_i        (set9_q),
    .smallest_i   (inner_size9_q[0]),
    .ray_valid_i,
    .ray_ready_o,
    .ray_resolved_i,
    .ray_pixel_i,
    .ray_shadow_i,
    .ray_tag_i,
    .ray_lit_i,
    .starts_o     (starts),
    .reflects_o   (reflects),
    .continues_o  (continues),
    .shift_o      (shift9),
    .mirrored_o   (mirrored9),
    .set_o        (set9),
    .take_o,
    .take_ready_i,
    .take_tag_i,
    .fill_o,
    .fill_tag_o,
    .fill_lit_o,
    .store_o,
    .store_pixel_o,
    .request_o,
    .request_ready_i,
    .request_tag_o,
    .request_face_o,
    .request_mirrored_o,
    .request_place_o
  );

  // FaceNone stands for a new ray's time.
  assign key_face = face_e'(exit_face9_q | {2{starts}});
  assign keys     = '{time9_q[0], time9_q[1], time9_q[2], ray_entry_time_i};

  always_ff @(posedge clk_i) begin
    size10_q    <= renews ? top_size : inner_size9_q | (sum9_q[CellBits-1:0] & ~place9_q);
    cleared10_q <= place9_q & ~sum9_q[CellBits-1:0];
    set10_q     <= starts ? ray_octant_i : set9;
    corner10_q  <= corner9_q;
    if (renews) corner10_q <= '{default: '0};
    active_q          <= {active_q[Slots-2:0], active_q[Slots-1]};
    active_q[10+Extra] <= starts || continues;
    if (!rst_ni) active_q <= '0;
    if (starts || leaves9_q) begin
      key_time_q[slot[9]] <= keys[key_face];
      key_face_q[slot[9]] <= starts ? ray_entry_face_i : exit_face9_q;
    end
    if (starts) dead_q[slot[9]] <= ray_dead_i;
    if (renews) mirrored_q[slot[9]] <= starts ? ray_mirrored_i : mirrored9;
  end

  // 10 corner. The stack has the blocks of cells by slot and size, in block RAM.
  (* ram_style = "block" *)
  logic [BlockBits-1:0] stack_q[2 ** (SlotBits + LevelBits)];
  logic [CellBits-1:0]  corner11_q[3], size11_q;
  logic [BlockBits-1:0] block11_q;
  logic [2:0]           octant11_q;
  logic                 top11_q;

  always_ff @(posedge clk_i) begin
    if (action3_q == Descend && !sinks3) stack_q[{slot[3], child_level3_q}] <= block3_q;
    block11_q <= stack_q[{slot[10], level_of(size10_q)}];
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      corner11_q[a] <= (corner10_q[a] & ~cleared10_q) | (set10_q[a] ? size10_q : '0);
      octant11_q[a] <= (set10_q[a] || (corner10_q[a] & size10_q) != '0) != mirrored_q[slot[10]][a];
    end
    size11_q <= size10_q;
    top11_q  <= (size10_q & top_size) != '0;
  end

  // 11 block.
  always_ff @(posedge clk_i) begin
    block0_q     <= top11_q ? root_i[BlockBits-1:0] : block11_q;
    octant0_q    <= octant11_q;
    corner0_q[0] <= corner11_q;
    size0_q[0]   <= size11_q;

    corner_x_q[slot[11]] <= corner11_q[0];
    corner_y_q[slot[11]] <= corner11_q[1];
    corner_z_q[slot[11]] <= corner11_q[2];
    size_q[slot[11]]     <= size11_q;
  end

endmodule
