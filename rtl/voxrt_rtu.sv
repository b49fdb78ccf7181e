// Ray tracing unit: camera and octree memory in, shaded pixels in pixel order out.
//
//   ray generator -> ray setup -> FIFO a lane -> lanes -> pixel buffer a lane -> merge -> shader
//                                                  |
//                                            octree memory
//
// start_i, while busy_o is low, latches the whole frame: camera, size, depth and root; nothing that changes later
// shows in it. busy_o falls when the last pixel has been accepted. A frame may be started with its first pixel not
// wanted yet: out_ready_i may be low at any time.
module voxrt_rtu
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes        = 1,
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned BlockBits    = 12,
  parameter  bit          Banked       = 1'b0,
  localparam int unsigned DepthBits    = $clog2(MaxDepth + 1)
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Frame.
  input  logic                           start_i,
  output logic                           busy_o,
  input  logic signed [PositionBits-1:0] position_i     [3],
  input  logic signed [  CameraBits-1:0] look_i         [3],
  input  logic signed [  CameraBits-1:0] right_i        [3],
  input  logic signed [  CameraBits-1:0] up_i           [3],
  input  logic        [    SizeBits-1:0] width_i,
  input  logic        [    SizeBits-1:0] height_i,
  input  logic        [   DepthBits-1:0] depth_i,             // 1 .. MaxDepth
  // Octree memory, see voxrt_octree_memory.
  input  logic                           access_i,
  input  logic                           access_write_i,
  input  logic        [            31:0] access_address_i,
  input  logic        [            31:0] access_word_i,
  output logic                           access_valid_o,
  output logic        [            31:0] access_word_o,
  // Material table, see voxrt_shader.
  input  logic                           table_write_i,
  input  material_t                      table_material_i,
  input  colour_t                        table_colour_i,
  // Pixels.
  output logic                           out_valid_o,
  input  logic                           out_ready_i,
  output colour_t                        out_colour_o,
  output pixel_t                         out_pixel_o,
  output logic                           out_first_o,
  output logic                           out_line_end_o,
  output logic                           out_last_o,
  // Of this frame, or of the last one when busy_o is low.
  output error_t                         error_o,
  output logic        [            31:0] cycles_o,            // From the start to the last pixel accepted.
  output logic        [            31:0] rays_o,              // Pixels accepted.
  output logic        [            31:0] words_read_o,
  output logic        [            31:0] hits_o,              // Pixels accepted that show a material.
  output logic        [            31:0] stalls_o             // Clocks in which a pixel waited to be accepted.
);
  localparam int unsigned DistanceBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned PayloadBits = payload_bits(BlockBits);
  localparam int unsigned RayFifoDepth = 32;
  localparam int unsigned BufferDepth = 256;
  localparam int unsigned TagBits = $clog2(BufferDepth) + 1;

  // Frame.
  logic                           start_q, busy_q;
  logic signed [DistanceBits-1:0] origin_q[3], mirrored_origin_q[3];
  logic signed [  CameraBits-1:0] look_q  [3], right_q          [3], up_q[3];
  logic        [    SizeBits-1:0] width_q, height_q;
  logic        [   DepthBits-1:0] depth_q;
  logic        [      MaxDepth:0] world_q;  // One-hot: the world's side.
  logic        [   PayloadBits:0] root, root_q;
  logic                           start;

  assign start = start_i && !busy_q;

  always_ff @(posedge clk_i) begin
    start_q <= start && rst_ni;
    if (start) begin
      for (int unsigned a = 0; a < 3; a++) begin
        origin_q[a]          <= DistanceBits'(position_i[a]);
        mirrored_origin_q[a] <= (DistanceBits'(2 ** FractionBits) << depth_i) - DistanceBits'(position_i[a]);
      end
      look_q   <= look_i;
      right_q  <= right_i;
      up_q     <= up_i;
      width_q  <= width_i;
      height_q <= height_i;
      depth_q  <= depth_i;
      world_q  <= (MaxDepth + 1)'(1) << depth_i;
      root_q   <= root;
      busy_q   <= 1'b1;
    end
    if (out_valid_o && out_ready_i && out_last_o) busy_q <= 1'b0;
    if (!rst_ni) busy_q <= 1'b0;
  end

  assign busy_o = busy_q;

  // Ray generator: a ray goes to the lane whose turn it is when that lane's FIFO has a place.
  logic                       corner, direction_valid, issues;
  logic signed [ScanBits-1:0] line_step[3], direction[3];
  logic [Lanes-1:0]           turn_q;  // One-hot.
  logic [Lanes-1:0]           has_credit;
  logic                       unused_first, unused_line_end, unused_last;

  assign issues = direction_valid && (has_credit & turn_q) != '0;

  always_ff @(posedge clk_i) begin
    if (issues) turn_q <= Lanes'({turn_q, turn_q[Lanes-1]});
    if (!rst_ni || start_q) turn_q <= Lanes'(1);
  end

  voxrt_scan u_scan (
    .clk_i,
    .rst_ni,
    .start_i      (start_q),
    .look_i       (look_q),
    .right_i      (right_q),
    .up_i         (up_q),
    .half_width_i (width_q[SizeBits-1:1]),
    .half_height_i(height_q[SizeBits-1:1]),
    .corner_o     (corner),
    .line_step_o  (line_step)
  );

  voxrt_ray_generator u_ray_generator (
    .clk_i,
    .rst_ni,
    .start_i    (start_q),
    .corner_i   (corner),
    .line_step_i(line_step),
    .right_i    (right_q),
    .width_i    (width_q),
    .height_i   (height_q),
    .valid_o    (direction_valid),
    .ready_i    (issues),
    .direction_o(direction),
    .first_o    (unused_first),
    .line_end_o (unused_line_end),
    .last_o     (unused_last)
  );

  typedef struct packed {
    logic                       resolved;
    pixel_t                     pixel;
    logic [2:0]                 mirrored;
    logic [2:0]                 dead;
    logic [2:0]                 octant;
    logic [2:0][WeightBits-1:0] weight;
    logic [key_bits(MaxDepth)-1:0] entry_time;
    face_e                      entry_face;
  } ray_t;

  logic                       ray_valid, overflow;
  logic        [   Lanes-1:0] ray_lane;
  logic        [WeightBits-1:0] ray_weight[3];
  ray_t                       ray;

  voxrt_ray_setup #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Lanes       (Lanes)
  ) u_ray_setup (
    .clk_i,
    .rst_ni,
    .origin_i         (origin_q),
    .mirrored_origin_i(mirrored_origin_q),
    .depth_i          (depth_q),
    .root_leaf_i      (root_q[PayloadBits]),
    .root_material_i  (root_q[8] ? '0 : root_q[7:0]),
    .valid_i          (issues),
    .lane_i           (turn_q),
    .direction_i      (direction),
    .valid_o          (ray_valid),
    .lane_o           (ray_lane),
    .resolved_o       (ray.resolved),
    .pixel_o          (ray.pixel),
    .overflow_o       (overflow),
    .mirrored_o       (ray.mirrored),
    .dead_o           (ray.dead),
    .octant_o         (ray.octant),
    .weight_o         (ray_weight),
    .entry_time_o     (ray.entry_time),
    .entry_face_o     (ray.entry_face)
  );

  assign ray.weight = {ray_weight[2], ray_weight[1], ray_weight[0]};

  // Lanes.
  logic   [    Lanes-1:0] pixel_valid, pixel_ready, read, word_read, bad_pointer, step_limit;
  pixel_t                 pixel [Lanes];
  logic   [BlockBits-1:0] block [Lanes];
  logic   [          2:0] octant[Lanes];
  logic   [PayloadBits:0] word  [Lanes];

  for (genvar i = 0; i < Lanes; i++) begin : gen_lane
    // Places in the FIFO that are not promised to a ray under way.
    localparam int unsigned CreditBits = $clog2(RayFifoDepth) + 1;
    logic [CreditBits-1:0] credit_q;
    logic                  lane_valid, lane_ready, unused_ready;
    ray_t                  lane_ray;
    logic [WeightBits-1:0] lane_weight[3];

    assign has_credit[i] = credit_q != '0;

    always_ff @(posedge clk_i) begin
      credit_q <= credit_q - CreditBits'(issues && turn_q[i]) + CreditBits'(lane_valid && lane_ready);
      if (!rst_ni) credit_q <= CreditBits'(RayFifoDepth);
    end

    voxrt_fifo #(
      .Width($bits(ray_t)),
      .Depth(RayFifoDepth)
    ) u_rays (
      .clk_i,
      .rst_ni,
      .valid_i(ray_valid && ray_lane[i]),
      .ready_o(unused_ready),
      .data_i (ray),
      .valid_o(lane_valid),
      .ready_i(lane_ready),
      .data_o (lane_ray)
    );

    assign lane_weight[0] = lane_ray.weight[0];
    assign lane_weight[1] = lane_ray.weight[1];
    assign lane_weight[2] = lane_ray.weight[2];

    logic                 take, take_ready, fill;
    logic [  TagBits-1:0] take_tag, fill_tag;
    pixel_t               fill_pixel;

    voxrt_lane #(
      .MaxDepth    (MaxDepth),
      .PositionBits(PositionBits),
      .BlockBits   (BlockBits),
      .TagBits     (TagBits),
      .MemoryClocks(memory_clocks(Banked))
    ) u_lane (
      .clk_i,
      .rst_ni,
      .origin_i         (origin_q),
      .mirrored_origin_i(mirrored_origin_q),
      .world_i          (world_q),
      .root_block_i     (root_q[BlockBits-1:0]),
      .ray_valid_i      (lane_valid),
      .ray_ready_o      (lane_ready),
      .ray_resolved_i   (lane_ray.resolved),
      .ray_pixel_i      (lane_ray.pixel),
      .ray_mirrored_i   (lane_ray.mirrored),
      .ray_dead_i       (lane_ray.dead),
      .ray_octant_i     (lane_ray.octant),
      .ray_weight_i     (lane_weight),
      .ray_entry_time_i (lane_ray.entry_time),
      .ray_entry_face_i (lane_ray.entry_face),
      .mem_read_o       (read[i]),
      .mem_block_o      (block[i]),
      .mem_octant_o     (octant[i]),
      .mem_ack_i        (word_read[i]),
      .mem_word_i       (word[i]),
      .take_o           (take),
      .take_ready_i     (take_ready),
      .take_tag_i       (take_tag),
      .fill_o           (fill),
      .fill_tag_o       (fill_tag),
      .fill_pixel_o     (fill_pixel),
      .bad_pointer_o    (bad_pointer[i]),
      .step_limit_o     (step_limit[i])
    );

    voxrt_pixel_buffer #(
      .Depth(BufferDepth)
    ) u_pixels (
      .clk_i,
      .rst_ni,
      .take_i (take),
      .ready_o(take_ready),
      .tag_o  (take_tag),
      .fill_i (fill),
      .tag_i  (fill_tag),
      .pixel_i(fill_pixel),
      .valid_o(pixel_valid[i]),
      .ready_i(pixel_ready[i]),
      .pixel_o(pixel[i])
    );
  end

  voxrt_octree_memory #(
    .Lanes    (Lanes),
    .BlockBits(BlockBits),
    .Banked   (Banked)
  ) u_memory (
    .clk_i,
    .rst_ni,
    .access_i,
    .access_write_i,
    .access_address_i,
    .access_word_i,
    .access_valid_o,
    .access_word_o,
    .root_o  (root),
    .read_i  (read),
    .block_i (block),
    .octant_i(octant),
    .ack_o   (word_read),
    .word_o  (word)
  );

  // Pixels.
  logic   merged_valid, merged_ready;
  pixel_t merged;

  voxrt_merge #(
    .Lanes(Lanes)
  ) u_merge (
    .clk_i,
    .rst_ni,
    .start_i(start_q),
    .valid_i(pixel_valid),
    .ready_o(pixel_ready),
    .pixel_i(pixel),
    .valid_o(merged_valid),
    .ready_i(merged_ready),
    .pixel_o(merged)
  );

  voxrt_shader u_shader (
    .clk_i,
    .rst_ni,
    .start_i    (start_q),
    .corner_i   (corner),
    .line_step_i(line_step),
    .right_i    (right_q),
    .width_i    (width_q),
    .height_i   (height_q),
    .table_write_i,
    .table_material_i,
    .table_colour_i,
    .valid_i   (merged_valid),
    .ready_o   (merged_ready),
    .pixel_i   (merged),
    .valid_o   (out_valid_o),
    .ready_i   (out_ready_i),
    .colour_o  (out_colour_o),
    .pixel_o   (out_pixel_o),
    .first_o   (out_first_o),
    .line_end_o(out_line_end_o),
    .last_o    (out_last_o)
  );

  // Counters and errors.
  logic [31:0] cycles_q, rays_q, words_read_q, hits_q, stalls_q;
  error_t      error_q;

  always_ff @(posedge clk_i) begin
    if (busy_q) cycles_q <= cycles_q + 1'b1;
    if (out_valid_o && out_ready_i) rays_q <= rays_q + 1'b1;
    if (out_valid_o && out_ready_i && out_pixel_o.material != '0) hits_q <= hits_q + 1'b1;
    if (out_valid_o && !out_ready_i) stalls_q <= stalls_q + 1'b1;
    words_read_q <= words_read_q + 32'($countones(word_read));
    if (ray_valid && overflow) error_q.direction_overflow <= 1'b1;
    if (bad_pointer != '0 || (start_q && root_q[PayloadBits] && root_q[8])) error_q.bad_pointer <= 1'b1;
    if (step_limit != '0) error_q.step_limit <= 1'b1;
    if (start) begin
      cycles_q     <= '0;
      rays_q       <= '0;
      words_read_q <= '0;
      hits_q       <= '0;
      stalls_q     <= '0;
      error_q      <= '0;
    end
  end

  assign cycles_o     = cycles_q;
  assign rays_o       = rays_q;
  assign words_read_o = words_read_q;
  assign hits_o       = hits_q;
  assign stalls_o     = stalls_q;
  assign error_o      = error_q;
endmodule
