// Coverage of the traversal, for the benches: bound to voxrt_lane, and no part of the core.
//
// Sampled at stage 8 (add) of voxrt_lane, where a leaf's exit is known, in lanes without light, whose rays read a word
// at every pass. When the simulation ends, the counts are written to traversal.txt, a line per bin that was hit:
// rtl/benches/coverage.py reads it, and says which bins are impossible. Counters, because as many cover properties take
// minutes to compile.
module voxrt_lane_coverage
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10,
  parameter int unsigned KeyBits  = 55
) (
  input logic                     clk_i,
  input logic                     active_i,
  input logic                     retry_i,           // No word came.
  input logic                     descend_i,         // Into a pointer's block.
  input logic                     leave_i,           // An empty leaf.
  input logic                     finish_i,          // Material, or an error.
  input logic      [MaxDepth-1:0] size_i,            // Size of the cell, one-hot.
  input logic      [MaxDepth-1:0] coordinate_i,      // Coordinate of its corner on the axis of the exit.
  input face_e                    exit_i,
  input face_e                    key_face_i,        // The plane that the ray crossed last.
  input material_t                material_i,
  input logic      [         2:0] mirrored_i,
  input logic      [         2:0] dead_i,
  input logic      [         2:0] child_i,           // A pointer's child, in the mirrored frame.
  input logic      [ KeyBits-1:0] time_i       [3],
  input logic      [  MaxDepth:0] side_i,            // Side of the world, one-hot.
  input logic                     bad_pointer_i,
  input logic                     step_limit_i
);
  localparam int unsigned Levels = 16;

  logic leaves, outside, hits, descends;
  logic [MaxDepth:0] sum, ancestor;  // Ancestor: the size of the cell that follows, one-hot.
  logic [2:0] ties;
  logic [3:0] level, climbed;

  function automatic logic [4:0] level_of(logic [MaxDepth:0] size);
    level_of = '0;
    for (int unsigned i = 0; i <= MaxDepth; i++) if (size[i]) level_of |= 5'(i);
  endfunction

  assign sum = {1'b0, coordinate_i} + {1'b0, size_i};
  assign ancestor = sum & ~{1'b0, coordinate_i};
  assign outside = (sum & side_i) != '0;
  assign level = 4'(level_of({1'b0, size_i}));
  assign climbed = 4'(level_of(ancestor) - level_of({1'b0, size_i}));
  assign leaves = active_i && leave_i && dead_i != '1;
  assign hits = active_i && finish_i && material_i != '0;
  assign descends = active_i && descend_i;

  // Planes that are crossed at the same time: z and x, y and z, x and y.
  assign ties = {time_i[2] == time_i[0] && !dead_i[2] && !dead_i[0], time_i[1] == time_i[2] && !dead_i[1] && !dead_i[2],
                 time_i[0] == time_i[1] && !dead_i[0] && !dead_i[1]};

  int unsigned leaf_q[Levels][3][8][Levels];  // By level, exit, mirrored axes, levels climbed.
  int unsigned leaf_out_q[Levels][3][8];  // Out of the world.
  int unsigned solid_q[Levels][4][8];  // By level, face, mirrored axes.
  int unsigned pointer_q[Levels][8][8];  // By level, child, mirrored axes.
  int unsigned dead_q[8][3];  // By dead axes, exit.
  int unsigned tie_q[8][3];  // By ties, exit.
  int unsigned depth_q[Levels+1];  // Out of worlds of a depth.
  int unsigned word_q[3];  // Not delivered, bad pointer, step limit.

  always_ff @(posedge clk_i) begin
    if (leaves && !outside) begin
      leaf_q[level][exit_i][mirrored_i][climbed] <= leaf_q[level][exit_i][mirrored_i][climbed] + 1;
    end
    if (leaves && outside) leaf_out_q[level][exit_i][mirrored_i] <= leaf_out_q[level][exit_i][mirrored_i] + 1;
    if (hits) solid_q[level][key_face_i][mirrored_i] <= solid_q[level][key_face_i][mirrored_i] + 1;
    if (descends) pointer_q[level][child_i][mirrored_i] <= pointer_q[level][child_i][mirrored_i] + 1;
    if (active_i && leave_i) dead_q[dead_i][exit_i] <= dead_q[dead_i][exit_i] + 1;
    if (leaves) tie_q[ties][exit_i] <= tie_q[ties][exit_i] + 1;
    if (leaves && outside) depth_q[level_of(side_i)] <= depth_q[level_of(side_i)] + 1;
    if (active_i && retry_i) word_q[0] <= word_q[0] + 1;
    if (bad_pointer_i) word_q[1] <= word_q[1] + 1;
    if (step_limit_i) word_q[2] <= word_q[2] + 1;
  end

  initial begin
    leaf_q     = '{default: '0};
    leaf_out_q = '{default: '0};
    solid_q    = '{default: '0};
    pointer_q  = '{default: '0};
    dead_q     = '{default: '0};
    tie_q      = '{default: '0};
    depth_q    = '{default: '0};
    word_q     = '{default: '0};
  end

  final begin
    int file;
    file = $fopen("traversal.txt", "w");
    for (int l = 0; l < Levels; l++) begin
      for (int m = 0; m < 8; m++) begin
        for (int a = 0; a < 3; a++) begin
          for (int c = 0; c < Levels; c++) begin
            if (leaf_q[l][a][m][c] != 0) $fdisplay(file, "leaf %0d %0d %0d %0d %0d", l, a, m, c, leaf_q[l][a][m][c]);
          end
          if (leaf_out_q[l][a][m] != 0) $fdisplay(file, "leaf_out %0d %0d %0d %0d", l, a, m, leaf_out_q[l][a][m]);
        end
        for (int f = 0; f < 4; f++) begin
          if (solid_q[l][f][m] != 0) $fdisplay(file, "solid %0d %0d %0d %0d", l, f, m, solid_q[l][f][m]);
        end
        for (int o = 0; o < 8; o++) begin
          if (pointer_q[l][o][m] != 0) $fdisplay(file, "pointer %0d %0d %0d %0d", l, o, m, pointer_q[l][o][m]);
        end
      end
    end
    for (int t = 0; t < 8; t++) begin
      for (int a = 0; a < 3; a++) begin
        if (dead_q[t][a] != 0) $fdisplay(file, "dead %0d %0d %0d", t, a, dead_q[t][a]);
        if (tie_q[t][a] != 0) $fdisplay(file, "tie %0d %0d %0d", t, a, tie_q[t][a]);
      end
    end
    for (int w = 0; w <= Levels; w++) if (depth_q[w] != 0) $fdisplay(file, "depth %0d %0d", w, depth_q[w]);
    for (int w = 0; w < 3; w++) if (word_q[w] != 0) $fdisplay(file, "word %0d %0d", w, word_q[w]);
    $fclose(file);
  end
endmodule

bind voxrt_lane voxrt_lane_coverage #(
  .MaxDepth(MaxDepth),
  .KeyBits (KeyBits)
) u_coverage (
  .clk_i,
  .active_i     (active_q[8+Extra]),
  .retry_i      (u_next_cell.action8_q == Retry),
  .descend_i    (u_next_cell.action8_q == Descend),
  .leave_i      (u_next_cell.action8_q == Leave),
  .finish_i     (u_next_cell.action8_q == Finish),
  .size_i       (u_next_cell.size8_q),
  .coordinate_i (u_next_cell.coordinate8_q & ~world_i.outside_mask[MaxDepth-1:0]),
  .exit_i       (u_next_cell.exit_face8_q),
  .key_face_i   (u_next_cell.key_face8_q),
  .material_i   (material8_q),
  .mirrored_i   (mirrored_q[8+Extra]),
  .dead_i       (dead_q[8+Extra]),
  .child_i      (u_next_cell.set8_q),
  .time_i       (u_next_cell.time8_q),
  .side_i       (world_i.side[MaxDepth:0]),
  .bad_pointer_i(bad_pointer_o),
  .step_limit_i (step_limit_o)
);
