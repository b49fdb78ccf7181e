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
module voxrt_lane
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned BlockBits    = 12,
  parameter  int unsigned TagBits      = 8,
  parameter  int unsigned MemoryClocks = 2,
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned TimeBits     = DistanceBits + WeightBits,
  localparam int unsigned PayloadBits  = payload_bits(BlockBits)
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Held during a frame.
  input  logic signed [DistanceBits-1:0] origin_i          [3],
  input  logic signed [DistanceBits-1:0] mirrored_origin_i [3],
  input  logic        [      MaxDepth:0] world_i,                // One-hot: the world's side.
  input  logic        [   BlockBits-1:0] root_block_i,
  // Rays, as voxrt_ray_setup makes them; taken in order.
  input  logic                           ray_valid_i,
  output logic                           ray_ready_o,
  input  logic                           ray_resolved_i,
  input  pixel_t                         ray_pixel_i,
  input  logic        [             2:0] ray_mirrored_i,
  input  logic        [             2:0] ray_dead_i,
  input  logic        [             2:0] ray_octant_i,
  input  logic        [  WeightBits-1:0] ray_weight_i      [3],
  input  logic signed [    TimeBits-1:0] ray_entry_time_i,
  input  face_e                          ray_entry_face_i,
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
  output logic                           fill_o,
  output logic        [     TagBits-1:0] fill_tag_o,
  output pixel_t                         fill_pixel_o,
  // Sticky errors.
  output logic                           bad_pointer_o,
  output logic                           step_limit_o
);
  // Stages as the table numbers them, and those in which a slower memory keeps rays waiting.
  localparam int unsigned Extra = MemoryClocks - 2;
  localparam int unsigned Slots = 8 + Extra;
  localparam int unsigned SlotBits = $clog2(Slots);
  localparam int unsigned LevelBits = $clog2(MaxDepth);

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
  logic signed [    TimeBits-1:0] key_time_q[Slots];
  face_e                          key_face_q[Slots];
  logic        [    MaxDepth-1:0] corner_x_q[Slots], corner_y_q[Slots], corner_z_q[Slots];
  logic        [    MaxDepth-1:0] size_q    [Slots];
  logic        [   BlockBits-1:0] stack_q   [2 ** (SlotBits + LevelBits)];

  // There is a ray in this stage that has not ended.
  logic [Slots-1:0] active_q;

  // 0 fetch, 1 wait: far planes.
  logic [BlockBits-1:0] block0_q;
  logic [2:0]           octant0_q;
  logic [MaxDepth:0]    far1_q   [3], far2_q   [3];
  logic [MaxDepth-1:0]  corner1_q[3], middle2_q[3];
  logic [MaxDepth-1:0]  size1_q, size2_q;

  assign mem_read_o   = active_q[0];
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

  logic    leaf, bad_pointer, step_limit;
  action_e action;

  assign leaf        = mem_word_i[PayloadBits];
  assign bad_pointer = leaf && mem_word_i[8];
  assign step_limit  = !leaf && size2_q[0];

  always_comb begin
    action = Finish;
    if (!mem_ack_i) action = Retry;
    else if (!leaf && !size2_q[0]) action = Descend;
    else if (leaf && mem_word_i[8:0] == '0) action = Leave;
  end

  logic signed [DistanceBits-1:0] distance3_q[3];
  logic        [  WeightBits-1:0] weight3_q  [3];
  action_e                        action3_q, action4_q, action5_q, action6_q;
  logic        [   BlockBits-1:0] block3_q;
  material_t                      material3_q, material4_q, material5_q, material6_q, material7_q;
  logic        [   LevelBits-1:0] child_level3_q;
  logic                           bad_pointer_q, step_limit_q;

  // Binary number of a one-hot size.
  function automatic logic [LevelBits-1:0] level_of(logic [MaxDepth-1:0] size);
    level_of = '0;
    for (int unsigned i = 0; i < MaxDepth; i++) if (size[i]) level_of |= LevelBits'(i);
  endfunction

  always_ff @(posedge clk_i) begin
    action3_q <= action;
    for (int unsigned a = 0; a < 3; a++) begin
      distance3_q[a] <= DistanceBits'({(leaf ? far2_q[a] : {1'b0, middle2_q[a]}), FractionBits'(0)}) -
          ((mirrored_q[slot[2]][a] ? mirrored_origin_i[a] : origin_i[a]) |
           DistanceBits'(dead_q[slot[2]][a] ? 2 ** FractionBits - 1 : 0));
    end
    weight3_q[0]   <= weight_x_q[slot[2]];
    weight3_q[1]   <= weight_y_q[slot[2]];
    weight3_q[2]   <= weight_z_q[slot[2]];
    block3_q       <= mem_word_i[BlockBits-1:0];
    material3_q    <= leaf && !bad_pointer ? mem_word_i[7:0] : '0;
    child_level3_q <= level_of(size2_q >> 1);
    bad_pointer_q  <= active_q[2+Extra] && mem_ack_i && bad_pointer;
    step_limit_q   <= active_q[2+Extra] && mem_ack_i && step_limit;
  end

  assign bad_pointer_o = bad_pointer_q;
  assign step_limit_o  = step_limit_q;

  // 3 product, 4 sum.
  logic signed [TimeBits-1:0] time5[3];

  for (genvar a = 0; a < 3; a++) begin : gen_time
    voxrt_plane_time #(
      .DistanceBits(DistanceBits)
    ) u_time (
      .clk_i,
      .distance_i(distance3_q[a]),
      .weight_i  (weight3_q[a]),
      .time_o    (time5[a])
    );
  end

  logic signed [TimeBits-1:0] key_time5_q;
  face_e                      key_face5_q;

  always_ff @(posedge clk_i) begin
    if (action3_q == Descend) stack_q[{slot[3], child_level3_q}] <= block3_q;
    action4_q   <= action3_q;
    action5_q   <= action4_q;
    material4_q <= material3_q;
    material5_q <= material4_q;
    key_time5_q <= key_time_q[slot[4]];
    key_face5_q <= key_face_q[slot[4]];
  end

  // 5 compare. Leaf: is x before y, y before z, z before x; pointer: is the middle plane before the key.
  logic        [         2:0] before6_q;
  logic signed [TimeBits-1:0] time6_q[3], key_time6_q;
  face_e                      key_face6_q;
  logic        [  MaxDepth:0] far6_q   [3];
  logic        [MaxDepth-1:0] corner6_q[3], size6_q;
  logic        [         2:0] dead6_q;
  logic        [  MaxDepth:0] far5     [3];

  assign far5[0] = {1'b0, corner_x_q[slot[5]]} + {1'b0, size_q[slot[5]]};
  assign far5[1] = {1'b0, corner_y_q[slot[5]]} + {1'b0, size_q[slot[5]]};
  assign far5[2] = {1'b0, corner_z_q[slot[5]]} + {1'b0, size_q[slot[5]]};

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      // Equal times go by axis: x is before y, y before z, and x before z.
      before6_q[a] <= $signed({time5[a], 1'b0}) < (action5_q == Leave ?
          $signed({time5[(a+1)%3], a != 2}) : $signed({key_time5_q, 2'(a) <= key_face5_q}));
      if (dead_q[slot[5]][a] && action5_q != Leave) before6_q[a] <= time5[a] < 0;
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
  logic signed [TimeBits-1:0] key_time7_q;
  face_e                      key_face7_q;
  logic        [MaxDepth-1:0] corner7_q[3], size7_q;
  logic                       ended7_q;
  logic        [  MaxDepth:0] next_size;  // One-hot.
  logic        [MaxDepth-1:0] kept;

  assign x_before_y = !dead6_q[0] && (dead6_q[1] || before6_q[0]);
  assign y_before_z = !dead6_q[1] && (dead6_q[2] || before6_q[1]);
  assign x_before_z = !dead6_q[0] && (dead6_q[2] || !before6_q[2]);
  assign exit       = {!x_before_z && !y_before_z, !x_before_y && y_before_z, x_before_y && x_before_z};

  always_comb begin
    next_size = '0;
    for (int unsigned a = 0; a < 3; a++) if (exit[a]) next_size |= far6_q[a] & ~{1'b0, corner6_q[a]};
    kept = ~(next_size[MaxDepth-1:0] - 1'b1);
  end

  always_ff @(posedge clk_i) begin
    key_time7_q <= key_time6_q;
    key_face7_q <= key_face6_q;
    corner7_q   <= corner6_q;
    size7_q     <= size6_q;
    ended7_q    <= action6_q == Finish;
    material7_q <= material6_q;
    if (action6_q == Descend) begin
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
        corner7_q[a] <= (exit[a] ? far6_q[a][MaxDepth-1:0] : corner6_q[a]) & kept;
      end
      size7_q  <= next_size[MaxDepth-1:0];
      ended7_q <= (next_size & world_i) != '0 || dead6_q == '1;
    end
  end

  // 7 turn.
  logic                 ends, starts, resolves;
  logic [MaxDepth-1:0]  top_size, size7;
  logic [BlockBits-1:0] block7;
  logic [2:0]           octant7;

  assign ends     = active_q[7+Extra] && ended7_q;
  assign starts   = ray_valid_i && !ray_resolved_i && take_ready_i && (ends || !active_q[7+Extra]);
  assign resolves = ray_valid_i && ray_resolved_i && take_ready_i && !ends;
  assign top_size = world_i[MaxDepth:1];

  assign ray_ready_o = starts || resolves;
  assign take_o      = starts || resolves;

  assign fill_o       = ends || resolves;
  assign fill_tag_o   = ends ? tag_q[slot[7]] : take_tag_i;
  assign fill_pixel_o = !ends ? ray_pixel_i :
      material7_q == '0 ? '{material: '0, face: FaceNone} : '{material: material7_q, face: key_face7_q};

  assign size7  = starts ? top_size : size7_q;
  assign block7 = size7 == top_size ? root_block_i : stack_q[{slot[7], level_of(size7_q)}];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) octant7[a] = (corner7_q[a] & size7_q) != '0;
    octant7 = starts ? ray_octant_i ^ ray_mirrored_i : octant7 ^ mirrored_q[slot[7]];
  end

  always_ff @(posedge clk_i) begin
    active_q  <= rst_ni ? {active_q[Slots-2:0], starts || (active_q[7+Extra] && !ends)} : '0;
    block0_q  <= block7;
    octant0_q <= octant7;

    size_q[slot[7]]     <= size7;
    corner_x_q[slot[7]] <= starts ? (ray_octant_i[0] ? top_size : '0) : corner7_q[0];
    corner_y_q[slot[7]] <= starts ? (ray_octant_i[1] ? top_size : '0) : corner7_q[1];
    corner_z_q[slot[7]] <= starts ? (ray_octant_i[2] ? top_size : '0) : corner7_q[2];
    key_time_q[slot[7]] <= starts ? ray_entry_time_i : key_time7_q;
    key_face_q[slot[7]] <= starts ? ray_entry_face_i : key_face7_q;
    if (starts) begin
      weight_x_q[slot[7]] <= ray_weight_i[0];
      weight_y_q[slot[7]] <= ray_weight_i[1];
      weight_z_q[slot[7]] <= ray_weight_i[2];
      mirrored_q[slot[7]] <= ray_mirrored_i;
      dead_q[slot[7]]     <= ray_dead_i;
      tag_q[slot[7]]      <= take_tag_i;
    end
  end
endmodule
