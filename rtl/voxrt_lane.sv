// Follows rays through the octree: a ring of twelve stages that holds twelve rays; every clock one of them reads one
// octree word. A memory that takes longer than two clocks adds a stage and a ray a clock, before stage 1.
//
//   stage     work                                                                        state of a slot, read
//   0 fetch   the memory takes the address                                                -
//   1 wait    the memory's output register; distance to the cell's near planes            -
//   2 decode  leaf or pointer; distance to the far planes (leaf) or middle planes         weights, by row
//   3 product distance x weight, in parts; the pointer goes onto the stack                -
//   4         parts                                                                       -
//   5         T of three planes                                                           key
//   6 compare leaf: T among themselves; pointer: T with the ray's key                     -
//   7 exit    leaf: the axis that it is left by, and the corner's place on that axis      -
//   8 add     the size to that place                                                      -
//   9 turn    the size of the next cell; the smallest T is the new key; a new ray in the  tag
//             place of one that ended
//   10 corner the next cell's corner and octant; the stack is read                        -
//   11 block  the block from the stack, or the root's                                     -
//
// What many stages want of a ray goes round with it, in registers: its cell, which axes are mirrored and dead. The rest
// stands in memories, by slot; its weights where they were put when the ray came, by row.
//
// A ray's key (T, face) is the last plane that it crossed. Corner and size (one-hot) are those of the cell read; its
// octant is the corner's bit at size. Planes of cells at that time crossed are those with keys <= the ray's key, so
// no two planes tie and a pointer's child is found by three compares. All T that are ever compared lie within the
// world's side of each other, so that T modulo 2**KeyBits is enough.
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
  parameter  int unsigned RowBits      = 5,
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
  input  logic        [    MaxDepth-1:0] beyond_i,               // The bits above the world's places.
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
  // A ray has come, and will be offered below: its weights, in a free row of the memory that holds them until it ends.
  input  logic                           arrives_i,
  input  logic        [     RowBits-1:0] arrival_row_i,
  input  logic        [  WeightBits-1:0] arrival_weight_i  [3],
  output logic                           releases_o,             // A row is free again.
  output logic        [     RowBits-1:0] released_row_o,
  // Rays, as voxrt_ray_setup makes them; taken in order.
  input  logic                           ray_valid_i,
  output logic                           ray_ready_o,
  input  logic                           ray_resolved_i,
  input  pixel_t                         ray_pixel_i,
  input  logic        [             2:0] ray_mirrored_i,
  input  logic        [             2:0] ray_dead_i,
  input  logic        [             2:0] ray_octant_i,
  input  logic        [     RowBits-1:0] ray_row_i,
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
  localparam int unsigned Slots = lane_slots(MemoryClocks);
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

  // What goes round with a ray, and from stage 0 to 6. Registers keep what they have where no ray is.
  localparam int unsigned CellStages = 7 + Extra;
  logic [         2:0] mirrored_q[Slots], dead_q[Slots];
  logic [ RowBits-1:0] row_q     [Slots];
  logic [CellBits-1:0] corner_q  [CellStages][3];
  logic [CellBits-1:0] size_q    [CellStages];

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 1; s < CellStages; s++) begin
      if (active_q[s-1]) begin
        corner_q[s] <= corner_q[s-1];
        size_q[s]   <= size_q[s-1];
      end
    end
  end

  // State by slot.
  logic [KeyBits-1:0] key_time_q[Slots];
  face_e              key_face_q[Slots];

  // 0 fetch.
  logic [BlockBits-1:0] block0_q;
  logic [2:0]           octant0_q;
  logic                 sinks0, sinks2, sinks3;  // The ray has hit, and looks for the sub-cell.
  logic                 shadow1, shadow2;        // It is a shadow ray.
  logic                 root_is_leaf;

  // Then it is read as if it were eight.
  assign root_is_leaf = (Light || Mirrors) && root_i[PayloadBits];
  assign mem_read_o   = active_q[0] && !sinks0 && !root_is_leaf;
  assign mem_block_o  = block0_q;
  assign mem_octant_o = octant0_q;

  // 2 decode.
  logic                 leaf, bad_pointer, step_limit, arrived;
  logic [PayloadBits:0] word;
  action_e              action;
  logic [CellBits-1:0]  size2;

  assign size2       = size_q[2+Extra];
  assign word        = root_is_leaf ? root_i : mem_word_i;
  assign arrived     = (mem_ack_i || root_is_leaf) && !sinks2;
  assign leaf        = word[PayloadBits];
  assign bad_pointer = leaf && word[8];
  assign step_limit  = !leaf && size2[SubBits];

  always_comb begin
    action = Finish;
    if (sinks2) action = size2[0] ? Retry : Descend;
    else if (!arrived) action = Retry;
    else if (!leaf && !size2[SubBits]) action = Descend;
    else if (leaf && word[8:0] == '0) action = Leave;
  end

  action_e              action3_q, action4_q, action5_q, action6_q;
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
    child_level3_q <= level_of(size2 >> 1);
    bad_pointer_q  <= active_q[2+Extra] && arrived && bad_pointer;
    step_limit_q   <= active_q[2+Extra] && arrived && step_limit;
    if (!rst_ni) begin
      bad_pointer_q <= 1'b0;
      step_limit_q  <= 1'b0;
    end
  end

  assign bad_pointer_o = bad_pointer_q;
  assign step_limit_o  = step_limit_q;

  // 1 to 5: T of planes. A ray that hits, or looks for the sub-cell, needs the middle planes of its leaf.
  logic                       starts, reflects;
  face_e                      key_face9;
  logic        [KeyBits-1:0]  time6[3];
  logic signed [MaxDepth+1:0] shift9;

  voxrt_cell_times #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Slots       (Slots),
    .RowBits     (RowBits),
    .Light       (Light),
    .Mirrors     (Mirrors)
  ) u_times (
    .clk_i,
    .origin_i,
    .mirrored_origin_i,
    .arrives_i,
    .arrival_row_i,
    .weight_i    (arrival_weight_i),
    .slot1_i     (slot[1]),
    .corner1_i   (corner_q[1+Extra]),
    .mirrored1_i (mirrored_q[1+Extra]),
    .dead1_i     (dead_q[1+Extra]),
    .shadow1_i   (shadow1),
    .row2_i      (row_q[2+Extra]),
    .size2_i     (size2),
    .shadow2_i   (shadow2),
    .takes_far_i (Light ? action == Leave : leaf),
    .slot9_i     (slot[9]),
    .starts_i    (starts),
    .ray_origin_i,
    .reflects_i  (reflects),
    .face_i      (key_face9),
    .shift_i     (shift9),
    .time_o      (time6)
  );

  logic [KeyBits-1:0] key_time6_q;
  face_e              key_face6_q;

  always_ff @(posedge clk_i) begin
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    action6_q   <= action5_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    material6_q <= material5_q;
    material7_q <= material6_q;
    material8_q <= material7_q;
    material9_q <= material8_q;
    key_time6_q <= key_time_q[slot[5]];
    key_face6_q <= key_face_q[slot[5]];
  end

  // 6 to 10: the next cell.
  logic                finishes9, goes_on9, leaves9, smallest9, renews;
  logic [CellBits-1:0] top_size, corner8[3], corner9[3], size10, corner11[3], size11;
  logic [         2:0] set9, turned_set9, mirrored9, octant11;
  logic [ KeyBits-1:0] exit_time9[3];
  face_e               key_face8, exit_face9;

  assign renews   = starts || reflects;
  assign top_size = CellBits'(world_i[MaxDepth:1]) << SubBits;

  voxrt_next_cell #(
    .MaxDepth(MaxDepth),
    .Light   (Light)
  ) u_next_cell (
    .clk_i,
    .rst_ni,
    .beyond_i,
    .top_size_i    (top_size),
    .active_i      (active_q[8+Extra:6+Extra]),
    .action_i      (action6_q),
    .time_i        (time6),
    .key_time_i    (key_time6_q),
    .key_face_i    (key_face6_q),
    .dead_i        (dead_q[6+Extra]),
    .corner_i      (corner_q[6+Extra]),
    .size_i        (size_q[6+Extra]),
    .corner8_o     (corner8),
    .key_face8_o   (key_face8),
    .finishes_o    (finishes9),
    .goes_on_o     (goes_on9),
    .leaves_cell_o (leaves9),
    .corner9_o     (corner9),
    .key_face9_o   (key_face9),
    .set_o         (set9),
    .smallest_o    (smallest9),
    .exit_time_o   (exit_time9),
    .exit_face_o   (exit_face9),
    .renews_i      (renews),
    .set_i         (starts ? ray_octant_i : turned_set9),
    .size10_o      (size10),
    .corner11_o    (corner11),
    .size11_o      (size11),
    .octant11_o    (octant11)
  );

  // 9 turn.
  logic               continues, resolves;
  logic [KeyBits-1:0] keys[4];
  face_e              key_face;

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
    .corner8_i    (corner8),
    .key_face8_i  (key_face8),
    .finishes_i   (finishes9),
    .goes_on_i    (goes_on9),
    .material_i   (material9_q),
    .key_face_i   (key_face9),
    .mirrored_i   (mirrored_q[9+Extra]),
    .corner_i     (corner9),
    .set_i        (set9),
    .smallest_i   (smallest9),
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
    .resolves_o   (resolves),
    .shift_o      (shift9),
    .mirrored_o   (mirrored9),
    .set_o        (turned_set9),
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

  assign releases_o     = resolves || ((finishes9 || goes_on9) && !continues);
  assign released_row_o = resolves ? ray_row_i : row_q[9+Extra];

  // FaceNone stands for a new ray's time.
  assign key_face = face_e'(exit_face9 | {2{starts}});
  assign keys     = '{exit_time9[0], exit_time9[1], exit_time9[2], ray_entry_time_i};

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 1; s < Slots; s++) begin
      if (active_q[s-1]) begin
        mirrored_q[s] <= mirrored_q[s-1];
        dead_q[s]     <= dead_q[s-1];
        row_q[s]      <= row_q[s-1];
      end
    end
    if (active_q[Slots-1]) begin
      mirrored_q[0] <= mirrored_q[Slots-1];
      dead_q[0]     <= dead_q[Slots-1];
      row_q[0]      <= row_q[Slots-1];
    end
    if (renews) mirrored_q[10+Extra] <= starts ? ray_mirrored_i : mirrored9;
    if (starts) begin
      dead_q[10+Extra] <= ray_dead_i;
      row_q[10+Extra]  <= ray_row_i;
    end
    active_q           <= {active_q[Slots-2:0], active_q[Slots-1]};
    active_q[10+Extra] <= starts || continues;
    if (!rst_ni) active_q <= '0;
    if (starts || leaves9) begin
      key_time_q[slot[9]] <= keys[key_face];
      key_face_q[slot[9]] <= starts ? ray_entry_face_i : exit_face9;
    end
  end

  // 10 corner. The stack has the blocks of cells by slot and size, in block RAM.
  (* ram_style = "block" *)
  logic [BlockBits-1:0] stack_q[2 ** (SlotBits + LevelBits)];
  logic [BlockBits-1:0] block11_q;
  logic [          2:0] mirrored11;
  logic                 top11_q;

  assign mirrored11 = mirrored_q[11+Extra];

  always_ff @(posedge clk_i) begin
    if (action3_q == Descend && !sinks3) stack_q[{slot[3], child_level3_q}] <= block3_q;
    block11_q <= stack_q[{slot[10], level_of(size10)}];
    top11_q   <= (size10 & top_size) != '0;
  end

  // 11 block.
  always_ff @(posedge clk_i) begin
    block0_q  <= top11_q ? root_i[BlockBits-1:0] : block11_q;
    octant0_q <= octant11 ^ mirrored11;
    if (active_q[11+Extra]) begin
      corner_q[0] <= corner11;
      size_q[0]   <= size11;
    end
  end
endmodule
