// Finds the cell that follows from the times of a cell's planes: stages 6 to 10 of voxrt_lane, whose table says what
// each does. Times are modulo 2**KeyBits; sizes are one-hot.
//
// The next corner is the old one with one bit set, that of the next size:
//   Descend   size / 2, on the axes whose middle plane is behind
//   Leave     coordinate + size on the exit axis sets one bit and clears those below it, down to size. The bit set is
//             the size of the cell that follows, below the common ancestor, whose block is on the stack under that
//             size; the bits cleared are cleared on all axes. The addition overflows where the ray leaves the world:
//             coordinates are given the bits of outside_mask before.
//   restart   half the world, on the axes of the root's octant; all other bits are cleared
module voxrt_next_cell
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10,
  parameter bit          Light    = 1'b0
) (
  input  logic                                    clk_i,
  input  logic                                    rst_ni,
  // Held during a frame.
  input  logic    [                 MaxDepth-1:0] outside_mask_i,     // Bits that are 0 in the world.
  input  logic    [                 MaxDepth-1:0] top_size_i,         // Half of the world.
  // Which of stages 6, 7, 8 have a ray.
  input  logic    [                          8:6] active_i,
  // Stage 6.
  input  action_e                                 action_i,
  input  logic    [key_bits(MaxDepth, Light)-1:0] time_i        [3],  // Far planes, to leave by; else middle or near.
  input  logic    [key_bits(MaxDepth, Light)-1:0] key_time_i,
  input  face_e                                   key_face_i,
  input  logic    [                          2:0] dead_i,
  input  logic    [                 MaxDepth-1:0] corner_i      [3],
  input  logic    [                 MaxDepth-1:0] size_i,
  // For voxrt_hit_point, where near planes are given.
  output logic    [key_bits(MaxDepth, Light)-1:0] until_o       [3],
  // Stage 8.
  output logic    [                 MaxDepth-1:0] corner8_o     [3],
  output face_e                                   key_face8_o,
  // Stage 9: what the ray has done, and its next key, where it leaves its cell. Material and mirrored are the lane's.
  output step_t                                   step_o,
  output logic                                    leaves_cell_o,
  output logic    [key_bits(MaxDepth, Light)-1:0] exit_time_o   [3],
  output face_e                                   exit_face_o,
  // Stage 9: whether the slot's ray starts at the root; the axes on which the corner gets the next size.
  input  logic                                    restarts_i,
  input  logic    [                          2:0] set_i,
  // Stage 10.
  output logic    [                 MaxDepth-1:0] size10_o,
  // Stage 11; octant in the mirrored frame.
  output logic    [                 MaxDepth-1:0] corner11_o    [3],
  output logic    [                 MaxDepth-1:0] size11_o,
  output logic    [                          2:0] octant11_o
);
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);

  // 6 compare. To leave: is x before y, y before z, z before x; else: is the middle plane before the key, on a dead
  // axis before the start. Equal times go by axis: x is before y, y before z, and x before z.
  logic [KeyBits-1:0] other[3];
  logic [KeyBits:0] difference[3];
  logic [2:0] first;  // Which of two equal times comes first.
  logic [2:0] before7_q;
  logic [KeyBits-1:0] time7_q[3];
  face_e key_face7_q;
  logic [MaxDepth-1:0] corner7_q[3], size7_q;
  logic [2:0] dead7_q;
  action_e action7_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      other[a] = action_i == Leave ? time_i[(a+1)%3] : key_time_i;
      first[a] = action_i == Leave ? a != 2 : 2'(a) <= key_face_i;
      if (Light && dead_i[a] && action_i != Leave) {other[a], first[a]} = '0;
      difference[a] = {time_i[a], 1'b0} - {other[a], first[a]};
      until_o[a]    = Light ? difference[a][KeyBits:1] : '0;
    end
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      before7_q[a] <= difference[a][KeyBits];
      if (dead_i[a] && action_i != Leave) before7_q[a] <= time_i[a][KeyBits-1];
    end
    // Registers hold where no ray is.
    if (active_i[6]) begin
      time7_q   <= time_i;
      corner7_q <= corner_i;
      size7_q   <= size_i;
    end
    key_face7_q <= key_face_i;
    dead7_q     <= dead_i;
    action7_q   <= action_i;
  end

  // 7 exit.
  logic x_before_y, y_before_z, x_before_z, descends7;
  logic [2:0] exit;  // One-hot.
  face_e exit_face, exit_face8_q, key_face8_q;
  logic [KeyBits-1:0] time8_q[3];
  logic [MaxDepth-1:0] corner8_q[3], size8_q, coordinate8_q;
  logic [2:0] set8_q;
  logic dead8_q, descends8_q;
  action_e action8_q;

  assign x_before_y = !dead7_q[0] && (dead7_q[1] || before7_q[0]);
  assign y_before_z = !dead7_q[1] && (dead7_q[2] || before7_q[1]);
  assign x_before_z = !dead7_q[0] && (dead7_q[2] || !before7_q[2]);
  assign exit       = {!x_before_z && !y_before_z, !x_before_y && y_before_z, x_before_y && x_before_z};
  assign exit_face  = exit[0] ? FaceX : exit[1] ? FaceY : FaceZ;
  assign descends7  = action7_q == Descend;

  always_ff @(posedge clk_i) begin
    if (active_i[7]) begin
      time8_q   <= time7_q;
      corner8_q <= corner7_q;
    end
    action8_q     <= action7_q;
    key_face8_q   <= key_face7_q;
    exit_face8_q  <= exit_face;
    size8_q       <= size7_q;
    coordinate8_q <= corner7_q[exit_face] | outside_mask_i;
    dead8_q       <= dead7_q == '1;
    descends8_q   <= descends7;
    set8_q        <= action7_q == Leave ? exit : descends7 ? before7_q : '0;
  end

  assign corner8_o   = corner8_q;
  assign key_face8_o = key_face8_q;

  // 8 add.
  logic [MaxDepth-1:0] sum, sum9_q, coordinate9_q, inner_size9_q, corner9_q[3];
  logic [KeyBits-1:0] time9_q[3];
  logic [2:0] set9_q;
  logic done, leaves_world, leaves_cell9_q, done9_q, continues9_q;
  face_e exit_face9_q, key_face9_q;

  assign {leaves_world, sum} = {1'b0, coordinate8_q} + (action8_q == Leave ? {1'b0, size8_q} : '0);
  assign done                = leaves_world || action8_q == Finish || (action8_q == Leave && dead8_q);

  always_ff @(posedge clk_i) begin
    if (active_i[8]) begin
      time9_q   <= time8_q;
      corner9_q <= corner8_q;
    end
    sum9_q         <= sum;
    coordinate9_q  <= coordinate8_q;
    inner_size9_q  <= action8_q == Leave ? '0 : descends8_q ? size8_q >> 1 : size8_q;
    set9_q         <= set8_q;
    exit_face9_q   <= exit_face8_q;
    leaves_cell9_q <= action8_q == Leave;
    done9_q        <= active_i[8] && done;
    continues9_q   <= active_i[8] && !done;
    key_face9_q    <= key_face8_q;
    // Without a reset, a ray of before it would free its row, and could be reflected.
    if (!rst_ni) begin
      done9_q      <= 1'b0;
      continues9_q <= 1'b0;
    end
  end

  always_comb begin
    step_o           = '0;
    step_o.done      = done9_q;
    step_o.continues = continues9_q;
    step_o.key_face  = key_face9_q;
    step_o.set       = set9_q;
    for (int unsigned a = 0; a < 3; a++) step_o.corner[a] = DepthLimit'(corner9_q[a]);
  end

  assign leaves_cell_o = leaves_cell9_q;
  assign exit_time_o   = time9_q;
  assign exit_face_o   = exit_face9_q;

  // 9 schedule.
  logic [MaxDepth-1:0] corner10_q[3], size10_q, cleared10_q;
  logic [2:0] set10_q;

  always_ff @(posedge clk_i) begin
    size10_q    <= restarts_i ? top_size_i : inner_size9_q | (sum9_q & ~coordinate9_q);
    cleared10_q <= coordinate9_q & ~sum9_q;
    set10_q     <= set_i;
    corner10_q  <= corner9_q;
    if (restarts_i) corner10_q <= '{default: '0};
  end

  assign size10_o = size10_q;

  // 10 corner.
  logic [MaxDepth-1:0] corner11_q[3], size11_q;
  logic [2:0] octant11_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned a = 0; a < 3; a++) begin
      corner11_q[a] <= (corner10_q[a] & ~cleared10_q) | (set10_q[a] ? size10_q : '0);
      octant11_q[a] <= set10_q[a] || (corner10_q[a] & size10_q) != '0;
    end
    size11_q <= size10_q;
  end

  assign corner11_o = corner11_q;
  assign size11_o   = size11_q;
  assign octant11_o = octant11_q;
endmodule
