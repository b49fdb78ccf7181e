// Traces rays through the octree: a ring of twelve stages that holds twelve rays; at every clock one of them reads one
// octree word. A memory that takes longer than two clocks adds a stage and a ray per clock, before stage 1.
//
//   stage      work                                                                       state of a slot, read
//   0 fetch    the memory takes the address                                               -
//   1 wait     the memory's output register; distance to the cell's near planes           -
//   2 decode   leaf or pointer; distance to the far planes (leaf) or middle planes        weights, by row
//   3 product  distance x weight, in parts; the pointer goes onto the stack               -
//   4          parts                                                                      -
//   5          T of three planes                                                          key
//   6 compare  leaf: T among themselves; pointer: T with the ray's key                    -
//   7 exit     leaf: the axis of its exit, and the corner's coordinate on that axis       -
//   8 add      the size to that coordinate                                                -
//   9 schedule the size of the next cell; the smallest T is the new key; a new ray is     tag
//              issued to the slot of one that retires
//   10 corner  the next cell's corner and octant; the stack is read                       -
//   11 block   the block from the stack, or the root's                                    -
//
// What many stages need of a ray goes round with it, in registers: its cell, which axes are mirrored and dead. The rest
// is in memories, by slot; its weights in the row that they were written to when the ray came.
//
// A ray's key (T, face) is the last plane that it crossed. Corner and size (one-hot) are those of the cell read; its
// octant is the corner's bit at size. The planes of cells crossed at that time are those with keys <= the ray's key, so
// no two planes tie and a pointer's child is found by three compares. All T that are ever compared lie within the
// world's side of each other, so that T modulo 2**KeyBits is enough.
//
// The ring never stops: rays are issued only when the reorder buffer has an entry for them. A word that the memory did
// not deliver (mem_ack_i low) is asked for again when the ray comes round.
//
// Mirrors lets a ray continue after a hit: voxrt_slot_scheduler. With Light, a ray that hits goes to voxrt_hit_point;
// while that has no place for it, it stays in its slot and reads no word.
module voxrt_lane
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned BlockBits    = 12,
  parameter int unsigned MemoryClocks = 2,     // Clocks from an address to its word (memory_clocks): 2 .. 5.
  parameter int unsigned RowBits      = 5,     // 2**RowBits rays, in slots and waiting: 5, or, as with Light, 6.
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  parameter bit          Lod          = 1'b0
) (
  input logic clk_i,
  input logic rst_ni,
  // Held during a frame.
  input world_t world_i,
  input logic [payload_bits(BlockBits, Lod):0] root_i,  // A leaf with Light or Mirrors alone.
  input shading_t shading_i,
  input light_planes_t light_planes_i,
  // Material table, for mirrors.
  input material_write_t material_write_i,
  // The weights of a ray that comes later, into a free row; a row that is free again.
  input weights_write_t weights_write_i,
  output row_free_t row_free_o,
  // Rays of voxrt_ray_setup with their rows, taken in order. Their weights are not used.
  input logic ray_valid_i,
  output logic ray_ready_o,
  input ray_t ray_i,
  input logic [RowBits-1:0] ray_row_i,
  // Octree memory: the word comes MemoryClocks clocks after its address, or not.
  output logic mem_read_o,
  output logic [BlockBits+2:0] mem_address_o,  // {block, octant}
  input logic mem_ack_i,
  input logic [payload_bits(BlockBits, Lod):0] mem_word_i,
  // Reorder buffer. Results of entries that were allocated before, or at this clock.
  output logic allocate_o,  // Only with allocate_ready_i.
  input logic allocate_ready_i,
  input logic [TagBits-1:0] allocate_tag_i,
  output result_t result_o,
  output logic [pixel_bits(MaxDepth, Light, Mirrors)-1:0] result_pixel_o,
  // For voxrt_light: the claim says that a hit point will come. It needs hit_point_ready_i, or that a shadow ray is issued.
  output logic hit_point_claim_o,
  input logic hit_point_ready_i,
  output logic hit_point_valid_o,
  output hit_point_t hit_point_o,
  // Errors, for one clock each.
  output logic bad_pointer_o,
  output logic step_limit_o
);
  if (MemoryClocks < 2 || MemoryClocks > 5) $error("voxrt_lane: MemoryClocks must be 2 to 5 clocks");
  if (RowBits < 5 || RowBits > RowLimit) $error("voxrt_lane: RowBits must be 5 or 6 bits");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);

  // Stages as the table numbers them, and those in which a slower memory keeps rays waiting.
  localparam int unsigned Stages = 12;
  localparam int unsigned Extra = MemoryClocks - 2;
  localparam int unsigned Slots = lane_slots(MemoryClocks);
  localparam int unsigned SlotBits = $clog2(Slots);
  localparam int unsigned LevelBits = $clog2(MaxDepth);
  localparam int unsigned WholeBits = distance_bits(MaxDepth, PositionBits) - FractionBits;

  // Which slot is in which stage, and whether it has a ray.
  logic [SlotBits-1:0] slot[Stages];
  logic [SlotBits-1:0] slot_q[Slots];
  logic [Slots-1:0] active_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= slot_q[(s+Slots-1)%Slots];
    if (!rst_ni) for (int unsigned s = 0; s < Slots; s++) slot_q[s] <= SlotBits'(s);
  end

  always_comb for (int unsigned s = 0; s < Stages; s++) slot[s] = slot_q[s+Extra];

  // What goes round with a ray, and from stage 0 to 6. Registers hold where no ray is.
  localparam int unsigned CellStages = 7 + Extra;
  logic [2:0] mirrored_q[Slots], dead_q[Slots];
  logic [RowBits-1:0] row_q[Slots];
  logic [MaxDepth-1:0] corner_q[CellStages][3];
  logic [MaxDepth-1:0] size_q[CellStages];

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
  face_e key_face_q[Slots];

  // 0 fetch.
  logic [BlockBits-1:0] block0_q;
  logic [2:0] octant0_q;
  logic root_is_leaf;
  ray_modes_t modes;

  // A root that is a leaf is read as if it were a block of eight such leaves.
  assign root_is_leaf  = (Light || Mirrors) && root_i[PayloadBits];
  assign mem_read_o    = active_q[0] && !modes.waits0 && !root_is_leaf;
  assign mem_address_o = {block0_q, octant0_q};

  // 2 decode.
  logic leaf, bad_pointer, step_limit, arrived;
  logic [PayloadBits:0] word;
  leaf_t content;  // What a leaf holds.
  action_e action;
  logic [MaxDepth-1:0] size2;

  assign size2       = size_q[2+Extra];
  assign word        = root_is_leaf ? root_i : mem_word_i;
  assign arrived     = (mem_ack_i || root_is_leaf) && !modes.waits2;
  assign leaf        = word[PayloadBits];
  assign content     = word[$bits(leaf_t)-1:0];
  assign bad_pointer = leaf && content.error;
  assign step_limit  = !leaf && size2[0];

  always_comb begin
    action = Finish;
    if (modes.waits2) action = Finish;
    else if (!arrived) action = Retry;
    else if (!leaf && !size2[0]) action = Descend;
    else if (leaf && content == '0) action = Leave;
  end

  // With Lod, a ray may stop at a pointer.
  logic stops5;
  material_t mean5;
  action_e action3_q, action4_q, action5_q, action6_q;
  logic [BlockBits-1:0] block3_q;
  material_t material3_q, material4_q, material5_q, material6_q;
  material_t material7_q, material8_q, material9_q;
  logic [LevelBits-1:0] child_level3_q;
  logic bad_pointer_q, step_limit_q;

  // Binary number of a one-hot size.
  function automatic logic [LevelBits-1:0] level_of(logic [MaxDepth-1:0] size);
    level_of = '0;
    for (int unsigned i = 0; i < MaxDepth; i++) if (size[i]) level_of |= LevelBits'(i);
  endfunction

  always_ff @(posedge clk_i) begin
    action3_q      <= action;
    block3_q       <= word[BlockBits-1:0];
    material3_q    <= modes.waits2 ? modes.material2 : leaf && !bad_pointer ? content.material : '0;
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

  // 1 to 5: T of planes. With Light, a ray that hits needs the near planes of its leaf.
  decision_t decision;
  step_t next_step, step9;
  logic [KeyBits-1:0] time6[3];
  logic signed [WholeBits-1:0] near2[3];
  logic [WholeBits-1:0] reach3;
  weights_t weights3;

  voxrt_cell_times #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Slots       (Slots),
    .RowBits     (RowBits),
    .Light       (Light),
    .Mirrors     (Mirrors)
  ) u_times (
    .clk_i,
    .world_i,
    .weights_write_i,
    .slot1_i      (slot[1]),
    .corner1_i    (corner_q[1+Extra]),
    .mirrored1_i  (mirrored_q[1+Extra]),
    .dead1_i      (dead_q[1+Extra]),
    .shadow1_i    (modes.shadow1),
    .row2_i       (row_q[2+Extra]),
    .size2_i      (size2),
    .shadow2_i    (modes.shadow2),
    .takes_far2_i (leaf),
    .takes_near2_i(Light && action == Finish),
    .slot9_i      (slot[9]),
    .decision_i   (decision),
    .ray_origin_i (ray_i.origin),
    .key_face_i   (step9.key_face),
    .time_o       (time6),
    .weights3_o   (weights3),
    .near2_o      (near2),
    .reach3_o     (reach3)
  );

  // 2 to 5: level of detail.
  if (Lod) begin : gen_lod
    voxrt_lod #(
      .LevelBits(LevelBits),
      .WholeBits(WholeBits)
    ) u_lod (
      .clk_i,
      .pointer_i(active_q[2+Extra] && action == Descend),
      .mean_i   (word[PayloadBits-1-:$bits(material_t)]),
      .near_i   (near2),
      .level_i  (level_of(size2)),
      .reach_i  (reach3),
      .stops_o  (stops5),
      .mean_o   (mean5)
    );
  end else begin : gen_no_lod
    logic unused_lod;
    always_comb begin
      unused_lod = ^reach3;
      for (int unsigned a = 0; a < 3; a++) unused_lod ^= ^near2[a];
    end
    assign stops5 = 1'b0;
    assign mean5  = '0;
  end

  logic [KeyBits-1:0] key_time6_q;
  face_e key_face6_q;

  always_ff @(posedge clk_i) begin
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    action6_q   <= stops5 ? Finish : action5_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    material6_q <= stops5 ? mean5 : material5_q;
    material7_q <= material6_q;
    material8_q <= material7_q;
    material9_q <= material8_q;
    key_time6_q <= key_time_q[slot[5]];
    key_face6_q <= key_face_q[slot[5]];
  end

  // 6 to 10: the next cell.
  logic leaves_cell9, restarts;
  logic [MaxDepth-1:0] top_size, corner8[3], size10, corner11[3], size11;
  logic [2:0] octant11;
  logic [KeyBits-1:0] exit_time9[3], until6[3];
  face_e key_face8, exit_face9;

  assign restarts = decision.issues || decision.reflects;
  assign top_size = world_i.side[MaxDepth:1];

  voxrt_next_cell #(
    .MaxDepth(MaxDepth),
    .Light   (Light)
  ) u_next_cell (
    .clk_i,
    .rst_ni,
    .outside_mask_i(world_i.outside_mask[MaxDepth-1:0]),
    .top_size_i    (top_size),
    .active_i      (active_q[8+Extra:6+Extra]),
    .action_i      (action6_q),
    .time_i        (time6),
    .key_time_i    (key_time6_q),
    .key_face_i    (key_face6_q),
    .dead_i        (dead_q[6+Extra]),
    .corner_i      (corner_q[6+Extra]),
    .size_i        (size_q[6+Extra]),
    .until_o       (until6),
    .corner8_o     (corner8),
    .key_face8_o   (key_face8),
    .step_o        (next_step),
    .leaves_cell_o (leaves_cell9),
    .exit_time_o   (exit_time9),
    .exit_face_o   (exit_face9),
    .restarts_i    (restarts),
    .set_i         (decision.issues ? ray_i.octant : decision.set),
    .size10_o      (size10),
    .corner11_o    (corner11),
    .size11_o      (size11),
    .octant11_o    (octant11)
  );

  // 3 to 9, beside the ring: hit points.
  logic holds9, takes9, point_valid, point_ready;
  hit_point_t hit9, point;
  material_t point_material;

  if (Light) begin : gen_hit_point
    voxrt_hit_point #(
      .MaxDepth(MaxDepth)
    ) u_hit_point (
      .clk_i,
      .rst_ni,
      .hit3_i     (active_q[3+Extra] && action3_q == Finish && material3_q != '0 && !modes.shadow3),
      .weights3_i (weights3),
      .until6_i   (until6),
      .size6_i    (size_q[6+Extra]),
      .holds9_o   (holds9),
      .takes9_i   (takes9),
      .hit9_i     (hit9),
      .material9_i(material9_q),
      .valid_o    (point_valid),
      .ready_i    (point_ready),
      .hit_point_o(point),
      .material_o (point_material)
    );
  end else begin : gen_no_hit_point
    logic unused_hit_point;
    always_comb begin
      unused_hit_point = &{weights3, takes9, hit9, point_ready, modes.shadow3};
      for (int unsigned a = 0; a < 3; a++) unused_hit_point ^= ^until6[a];
    end
    assign {holds9, point_valid, point, point_material} = '0;
  end

  // 9 schedule.
  logic [KeyBits-1:0] keys[4];
  face_e key_face;

  always_comb begin
    step9          = next_step;
    step9.material = material9_q;
    step9.mirrored = mirrored_q[9+Extra];
  end

  voxrt_slot_scheduler #(
    .MaxDepth(MaxDepth),
    .Slots   (Slots),
    .Light   (Light),
    .Mirrors (Mirrors)
  ) u_scheduler (
    .clk_i,
    .rst_ni,
    .side_i          (world_i.side[MaxDepth:0]),
    .shading_i,
    .light_planes_i,
    .material_write_i,
    .slot0_i         (slot_q[0]),
    .slot_i          (slot[1:9]),
    .modes_o         (modes),
    .material3_i     (material3_q),
    .corner8_i       (corner8),
    .key_face8_i     (key_face8),
    .step_i          (step9),
    .ray_valid_i,
    .ray_ready_o,
    .ray_i,
    .decision_o      (decision),
    .allocate_o,
    .allocate_ready_i,
    .allocate_tag_i,
    .result_o,
    .result_pixel_o,
    .holds_i         (holds9),
    .takes_o         (takes9),
    .hit_o           (hit9),
    .point_valid_i   (point_valid),
    .point_ready_o   (point_ready),
    .point_i         (point),
    .point_material_i(point_material),
    .hit_point_ready_i
  );

  assign hit_point_claim_o = takes9;
  assign hit_point_valid_o = point_valid && point_ready;
  assign hit_point_o       = point;

  assign row_free_o.valid  = decision.bypasses || ((step9.done || step9.continues) && !decision.keeps);
  assign row_free_o.row    = RowLimit'(decision.bypasses ? ray_row_i : row_q[9+Extra]);

  // FaceNone selects the time of a new ray.
  assign key_face          = face_e'(exit_face9 | {2{decision.issues}});
  assign keys              = '{exit_time9[0], exit_time9[1], exit_time9[2], ray_i.entry_time[KeyBits-1:0]};

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
    if (restarts) mirrored_q[10+Extra] <= decision.issues ? ray_i.mirrored : decision.mirrored;
    if (decision.issues) begin
      dead_q[10+Extra] <= ray_i.dead;
      row_q[10+Extra]  <= ray_row_i;
    end
    active_q           <= {active_q[Slots-2:0], active_q[Slots-1]};
    active_q[10+Extra] <= decision.issues || decision.keeps;
    if (!rst_ni) active_q <= '0;
    if (decision.issues || leaves_cell9) begin
      key_time_q[slot[9]] <= keys[key_face];
      key_face_q[slot[9]] <= decision.issues ? ray_i.entry_face : exit_face9;
    end
  end

  // 10 corner. The stack has the blocks of cells by slot and size, in block RAM.
  (* ram_style = "block" *)
  logic [BlockBits-1:0] stack_q[2 ** (SlotBits + LevelBits)];
  logic [BlockBits-1:0] block11_q;
  logic [2:0] mirrored11;
  logic top11_q;

  assign mirrored11 = mirrored_q[11+Extra];

  always_ff @(posedge clk_i) begin
    if (action3_q == Descend) stack_q[{slot[3], child_level3_q}] <= block3_q;
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
