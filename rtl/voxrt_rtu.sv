// Ray tracing unit: camera and octree memory in, shaded pixels in pixel order out.
//
//   ray generator -> ray setup -> queue, lane, reorder buffer (voxrt_buffered_lane) -> merge -> brightness -> shader
//                        ^                    |
//                        +------- light ------+---- octree memory
//
// What all lanes read, rays and values of the frame, goes from lane to lane, through a register at each but the first:
// with a wire to all lanes at once, the wires would be the longest paths.
//
// start_i, while busy_o is low, latches the whole frame (voxrt_frame): nothing that changes later shows in it, but
// words of the octree that are written. busy_o falls when the last pixel has been accepted. A frame may be started
// before its pixels can be accepted: pixel_ready_i may be low at any time.
//
// Light and Mirrors build the shader's features in: docs/shading.md. Lod builds the level of detail in: docs/lod.md.
module voxrt_rtu
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes        = 1,
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned BlockBits    = 12,
  parameter int unsigned MemoryForm   = PrivateForm,
  parameter int unsigned L1SetBits    = 5,
  parameter int unsigned L2SetBits    = 9,
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  parameter int unsigned RayClocks    = 1,
  parameter bit          Lod          = 1'b0,
  parameter string       OctreeFile   = ""
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  // Frame.
  input  logic                      start_i,
  output logic                      busy_o,
  input  frame_t                    frame_i,
  // Octree memory, see voxrt_octree_memory.
  input  logic                      access_i,
  input  logic                      access_write_i,
  input  logic               [31:0] access_address_i,
  input  logic               [31:0] access_word_i,
  output logic                      access_valid_o,
  output logic               [31:0] access_word_o,
  // External memory, see voxrt_cached_memory.
  input  logic                      bus_rst_ni,
  input  logic                      flush_i,
  output axi_read_request_t         axi_o           [BusPorts],
  input  axi_read_response_t        axi_i           [BusPorts],
  // Material table, see voxrt_shader and voxrt_reflect.
  input  material_write_t           material_write_i,
  // Pixels.
  output logic                      pixel_valid_o,
  input  logic                      pixel_ready_i,
  output shaded_pixel_t             pixel_o,
  // Counts and errors of this frame, or of the last one when busy_o is low. Errors stick until the next frame.
  output error_t                    error_o,
  output counters_t                 counters_o
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned AddressBits = BlockBits + 3;
  localparam int unsigned Width = pixel_bits(MaxDepth, Light, Mirrors);
  // Rays that are neighbours find lines in the caches. A pixel's detail is too wide for a buffer of strips.
  localparam bit Strips = MemoryForm == CachedForm && !Light && !Mirrors;
  // Each ray of a lane has a row of weights. Light has two queues of rays. Behind caches, queues are longer: lanes get rays
  // in turn, and a lane whose rays wait for lines must not keep the next rays from the other lanes.
  localparam int unsigned RowBits = Light || MemoryForm == CachedForm ? 6 : 5;
  localparam int unsigned RayDepth = Light ? 16 : 2 ** RowBits;

  // Frame.
  logic start, busy_q, root_valid;  // root_valid: for one clock, when the root is there.
  frame_t frame;
  world_t world;

  assign start = start_i && !busy_q;

  always_ff @(posedge clk_i) begin
    if (start) busy_q <= 1'b1;
    if (pixel_valid_o && pixel_ready_i && pixel_o.last) busy_q <= 1'b0;
    if (!rst_ni) busy_q <= 1'b0;
  end

  assign busy_o = busy_q;

  voxrt_frame #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Light       (Light),
    .Mirrors     (Mirrors),
    .Lod         (Lod)
  ) u_frame (
    .clk_i,
    .start_i(start),
    .frame_i,
    .frame_o(frame),
    .world_o(world)
  );

  // Octree memory. Lane 0's read port finds the root before the frame's rays start.
  logic [Lanes-1:0] lane_read, memory_read, word_valid;
  logic [AddressBits-1:0] lane_address[Lanes];
  logic [AddressBits:0] memory_address[Lanes], root_address;
  logic memory_ready;
  memory_events_t memory_events;
  logic [PayloadBits:0] word[Lanes], first_word, root;
  logic root_read;

  always_comb begin
    memory_read = lane_read;
    for (int unsigned i = 0; i < Lanes; i++) memory_address[i] = {1'b0, lane_address[i]};
    if (root_read) begin
      memory_read[0]    = 1'b1;
      memory_address[0] = root_address;
    end
  end

  voxrt_octree_memory #(
    .Lanes     (Lanes),
    .BlockBits (BlockBits),
    .MemoryForm(MemoryForm),
    .L1SetBits (L1SetBits),
    .L2SetBits (L2SetBits),
    .Lod       (Lod),
    .File      (OctreeFile)
  ) u_memory (
    .clk_i,
    .rst_ni,
    .access_i,
    .access_write_i,
    .access_address_i,
    .access_word_i,
    .access_valid_o,
    .access_word_o,
    .first_word_o(first_word),
    .read_i      (memory_read),
    .address_i   (memory_address),
    .ack_o       (word_valid),
    .word_o      (word),
    .lod_words_i (MemoryForm == CachedForm ? frame.lod_words : frame_i.lod_words),
    .bus_rst_ni,
    .start_i     (start),
    .ready_o     (memory_ready),
    .flush_i,
    .base_i      (frame.memory_base),
    .axi_o,
    .axi_i,
    .events_o    (memory_events)
  );

  voxrt_root #(
    .BlockBits   (BlockBits),
    .MemoryClocks(memory_clocks(MemoryForm)),
    .Lod         (Lod),
    .ReadsFirst  (MemoryForm == CachedForm)
  ) u_root (
    .clk_i,
    .rst_ni,
    .start_i       (memory_ready),
    .address_i     (MemoryForm == CachedForm ? frame.root : frame_i.root),
    .first_word_i  (first_word),
    .valid_o       (root_valid),
    .root_o        (root),
    .read_o        (root_read),
    .read_address_o(root_address),
    .ack_i         (word_valid[0]),
    .word_i        (word[0])
  );

  // Rays.
  raster_t raster;
  logic corner;
  logic [2:0][ScanBits-1:0] line_step;

  voxrt_scan u_scan (
    .clk_i,
    .rst_ni,
    .start_i      (root_valid),
    .look_i       (frame.look),
    .right_i      (frame.right),
    .up_i         (frame.up),
    .half_width_i (frame.width[SizeBits-1:1]),
    .half_height_i(frame.height[SizeBits-1:1]),
    .corner_o     (corner),
    .line_step_o  (line_step)
  );

  assign raster = '{
          start: root_valid,
          corner: corner,
          line_step: line_step,
          right: frame.right,
          width: frame.width,
          height: frame.height
      };

  logic [Lanes-1:0] credit, issue, ray_lane, shadow_lane;
  logic ray_valid, overflow, shadow_valid;
  ray_t ray;
  weights_t ray_weights;
  shadow_ray_t shadow_ray;

  // With Light or Mirrors the lanes go into a root that is a leaf: its faces are lit and reflect too.
  localparam bit ResolvesRoot = !Light && !Mirrors;
  leaf_t root_leaf;

  assign root_leaf = root[$bits(leaf_t)-1:0];

  voxrt_rays #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .Light       (Light),
    .Lod         (Lod),
    .Strips      (Strips),
    .RayClocks   (RayClocks)
  ) u_rays (
    .clk_i,
    .rst_ni,
    .raster_i       (raster),
    .world_i        (world),
    .root_leaf_i    (ResolvesRoot && root[PayloadBits]),
    .root_material_i(!ResolvesRoot || root_leaf.error ? '0 : root_leaf.material),
    .lod_scale_i    (frame.lod_scale),
    .credit_i       (credit),
    .issue_o        (issue),
    .shadow_valid_i (shadow_valid),
    .shadow_lane_i  (shadow_lane),
    .shadow_ray_i   (shadow_ray),
    .valid_o        (ray_valid),
    .lane_o         (ray_lane),
    .overflow_o     (overflow),
    .ray_o          (ray),
    .weights_o      (ray_weights)
  );

  // Credits: with several lanes, a register on the way to them and one on the way back. With many, the one on the way back
  // is in voxrt_rays, behind the choice of a lane.
  localparam int unsigned CreditClocks = Lanes > 1 ? 3 : 1;
  logic [Lanes-1:0] lane_credit, lane_issue;

  if (many_lanes(Lanes)) begin : gen_issue_register
    assign credit = lane_credit;
    always_ff @(posedge clk_i) lane_issue <= rst_ni ? issue : '0;
  end else if (Lanes > 1) begin : gen_credit_registers
    always_ff @(posedge clk_i) begin
      credit     <= rst_ni ? lane_credit : '0;
      lane_issue <= rst_ni ? issue : '0;
    end
  end else begin : gen_credit
    assign credit     = lane_credit;
    assign lane_issue = issue;
  end

  // Doors: what a lane reads. Lane i gets all i clocks late.
  typedef struct packed {
    world_t               world;
    logic [PayloadBits:0] root;
    shading_t             shading;
  } frame_values_t;

  logic [Lanes-1:0] door_start;
  frame_values_t door_frame[Lanes];
  logic [Lanes-1:0] door_lane[Lanes];  // Whose ray it is; 0: none.
  ray_t door_ray[Lanes];
  weights_t door_weights[Lanes];

  assign door_start[0]   = root_valid;
  assign door_frame[0]   = '{world: world, root: root, shading: frame.shading};
  assign door_lane[0]    = ray_valid ? ray_lane : '0;
  assign door_ray[0]     = ray;
  assign door_weights[0] = ray_weights;

  for (genvar i = 1; i < Lanes; i++) begin : gen_door
    always_ff @(posedge clk_i) begin
      door_start[i] <= rst_ni && door_start[i-1];
      door_lane[i]  <= rst_ni ? door_lane[i-1] : '0;
      if (door_start[i-1]) door_frame[i] <= door_frame[i-1];
      if (door_lane[i-1] != '0) begin
        door_ray[i]     <= door_ray[i-1];
        door_weights[i] <= door_weights[i-1];
      end
    end
  end

  logic unused_door_start;
  assign unused_door_start = door_start[Lanes-1];

  // Lanes.
  light_planes_t light_planes;
  logic [Lanes-1:0] lane_pixel_valid, lane_pixel_ready, lane_pixel_lit;
  logic [Lanes-1:0] hit_point_valid, hit_point_ready, shadow_issued, bad_pointer, step_limit;
  logic [Lanes-1:0] hit_point_claim;
  logic [Width-1:0] lane_pixel[Lanes];
  hit_point_t hit_point[Lanes];

  for (genvar i = 0; i < Lanes; i++) begin : gen_lane
    voxrt_buffered_lane #(
      .MaxDepth    (MaxDepth),
      .PositionBits(PositionBits),
      .BlockBits   (BlockBits),
      .MemoryClocks(memory_clocks(MemoryForm)),
      .RowBits     (RowBits),
      .RayDepth    (RayDepth),
      .CreditClocks(CreditClocks),
      .Light       (Light),
      .Mirrors     (Mirrors),
      .Lod         (Lod)
    ) u_lane (
      .clk_i,
      .rst_ni,
      .world_i          (door_frame[i].world),
      .root_i           (door_frame[i].root),
      .shading_i        (door_frame[i].shading),
      .light_planes_i   (light_planes),
      .material_write_i,
      .issue_i          (lane_issue[i]),
      .credit_o         (lane_credit[i]),
      .ray_valid_i      (door_lane[i][i]),
      .ray_i            (door_ray[i]),
      .weights_i        (door_weights[i]),
      .shadow_issued_o  (shadow_issued[i]),
      .mem_read_o       (lane_read[i]),
      .mem_address_o    (lane_address[i]),
      .mem_ack_i        (word_valid[i]),
      .mem_word_i       (word[i]),
      .hit_point_claim_o(hit_point_claim[i]),
      .hit_point_valid_o(hit_point_valid[i]),
      .hit_point_ready_i(hit_point_ready[i]),
      .hit_point_o      (hit_point[i]),
      .pixel_valid_o    (lane_pixel_valid[i]),
      .pixel_ready_i    (lane_pixel_ready[i]),
      .lit_o            (lane_pixel_lit[i]),
      .pixel_o          (lane_pixel[i]),
      .bad_pointer_o    (bad_pointer[i]),
      .step_limit_o     (step_limit[i])
    );
  end

  if (Light) begin : gen_light
    voxrt_light #(
      .Lanes     (Lanes),
      .MaxDepth  (MaxDepth),
      .QueueDepth(RayDepth)
    ) u_light (
      .clk_i,
      .rst_ni,
      .side_i           (world.side[MaxDepth:0]),
      .light_i          (frame.light),
      .hit_point_claim_i(hit_point_claim),
      .hit_point_valid_i(hit_point_valid),
      .hit_point_ready_o(hit_point_ready),
      .hit_point_i      (hit_point),
      .issued_i         (shadow_issued),
      .valid_o          (shadow_valid),
      .lane_o           (shadow_lane),
      .shadow_ray_o     (shadow_ray),
      .light_planes_o   (light_planes)
    );
  end else begin : gen_no_light
    logic [Lanes-1:0] unused_hit_point;
    always_comb begin
      for (int unsigned i = 0; i < Lanes; i++) begin
        unused_hit_point[i] = &{hit_point_valid[i], hit_point_claim[i], shadow_issued[i], hit_point[i]};
      end
    end
    assign hit_point_ready = '0;
    assign shadow_valid    = 1'b0;
    assign shadow_lane     = '0;
    assign shadow_ray      = '0;
    assign light_planes    = '0;
  end

  // Pixels.
  voxrt_pixels #(
    .Lanes    (Lanes),
    .MaxDepth (MaxDepth),
    .Light    (Light),
    .Mirrors  (Mirrors),
    .Strips   (Strips),
    .RayClocks(RayClocks)
  ) u_pixels (
    .clk_i,
    .rst_ni,
    .raster_i (raster),
    .side_i   (world.side[MaxDepth:0]),
    .light_i  (frame.light),
    .shading_i(frame.shading),
    .material_write_i,
    .valid_i  (lane_pixel_valid),
    .ready_o  (lane_pixel_ready),
    .lit_i    (lane_pixel_lit),
    .pixel_i  (lane_pixel),
    .pixel_valid_o,
    .pixel_ready_i,
    .pixel_o
  );

  voxrt_counters #(
    .Lanes(Lanes)
  ) u_counters (
    .clk_i,
    .start_i             (start),
    .rays_start_i        (root_valid),
    .busy_i              (busy_q),
    .pixel_valid_i       (pixel_valid_o),
    .pixel_ready_i,
    .hit_i               (pixel_o.pixel.material != '0),
    .word_read_i         (word_valid),
    .direction_overflow_i(ray_valid && overflow),
    .bad_pointer_i       (bad_pointer != '0 || (root_valid && root[PayloadBits] && root_leaf.error)),
    .step_limit_i        (step_limit != '0),
    .memory_events_i     (memory_events),
    .error_o,
    .counters_o
  );
endmodule
