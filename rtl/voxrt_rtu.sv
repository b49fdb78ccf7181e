// Ray tracing unit: camera and octree memory in, shaded pixels in pixel order out.
//
//   ray generator -> ray setup -> queue, lane, pixel buffer (a track each) -> merge -> brightness -> shader
//                        ^                    |
//                        +------- light ------+---- octree memory
//
// start_i, while busy_o is low, latches the whole frame: camera, shading, size, depth and root; nothing that changes later
// shows in it, but words of the octree that are written. busy_o falls when the last pixel has been accepted. A frame may be started with its first pixel not
// wanted yet: out_ready_i may be low at any time.
//
// Flat, Light and Mirrors build the shader's features in (docs/shading.md says what they are); what is not built in is off,
// whatever shading_i says.
module voxrt_rtu
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes        = 1,
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned BlockBits    = 12,
  parameter  bit          Banked       = 1'b0,
  parameter  bit          Flat         = 1'b0,
  parameter  bit          Light        = 1'b0,
  parameter  bit          Mirrors      = 1'b0,
  localparam int unsigned DepthBits    = $clog2(MaxDepth + 1),
  localparam int unsigned LightBits    = light_bits(MaxDepth)
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
  input  logic        [            31:0] root_i,              // Word address of the root.
  input  shading_t                       shading_i,
  input  logic signed [   LightBits-1:0] light_i        [3],  // 1/16 voxel
  // Octree memory, see voxrt_octree_memory.
  input  logic                           access_i,
  input  logic                           access_write_i,
  input  logic        [            31:0] access_address_i,
  input  logic        [            31:0] access_word_i,
  output logic                           access_valid_o,
  output logic        [            31:0] access_word_o,
  // Material table, see voxrt_shader and voxrt_reflect.
  input  logic                           table_write_i,
  input  material_t                      table_material_i,
  input  row_t                           table_row_i,
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
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);
  localparam int unsigned PayloadBits = payload_bits(BlockBits);
  localparam int unsigned PlaceBits = MaxDepth + FractionBits;
  localparam int unsigned LitBits = MaxDepth + LitFractionBits + 2;
  localparam int unsigned Width = pixel_bits(MaxDepth, Light, Mirrors);
  localparam int unsigned RayDepth = Light ? 16 : 32;  // 32 rows of memory, in one queue or in two.
  localparam int unsigned PixelDepth = 256;
  localparam int unsigned TagBits = $clog2(PixelDepth) + 1;

  // Frame.
  logic                           start_q, busy_q;  // start_q: the root is there too.
  logic signed [DistanceBits-1:0] origin_q[3], mirrored_origin_q[3];
  logic signed [  CameraBits-1:0] look_q  [3], right_q          [3], up_q[3];
  logic        [    SizeBits-1:0] width_q, height_q;
  logic        [   DepthBits-1:0] depth_q;
  logic        [      MaxDepth:0] world_q;   // One-hot: the world's side.
  logic        [    MaxDepth-1:0] beyond_q;  // The bits above the world's places.
  logic        [   PayloadBits:0] first_word, root;
  shading_t                       shading_q;
  logic signed [   LightBits-1:0] light_q [3];
  logic                           start;

  assign start = start_i && !busy_q;

  always_ff @(posedge clk_i) begin
    if (start) begin
      for (int unsigned a = 0; a < 3; a++) begin
        origin_q[a]          <= DistanceBits'(position_i[a]);
        mirrored_origin_q[a] <= (DistanceBits'(2 ** FractionBits) << depth_i) - DistanceBits'(position_i[a]);
      end
      look_q    <= look_i;
      right_q   <= right_i;
      up_q      <= up_i;
      width_q   <= width_i;
      height_q  <= height_i;
      depth_q   <= depth_i;
      world_q   <= (MaxDepth + 1)'(1) << depth_i;
      beyond_q  <= '1 << depth_i;
      shading_q <= '{
          flat: Flat && shading_i.flat,
          light: Light && shading_i.light,
          ambient: Light ? shading_i.ambient : '0,
          bounces: Mirrors ? shading_i.bounces : '0
      };
      light_q   <= light_i;
      busy_q    <= 1'b1;
    end
    if (out_valid_o && out_ready_i && out_last_o) busy_q <= 1'b0;
    if (!rst_ni) busy_q <= 1'b0;
  end

  assign busy_o = busy_q;

  logic   [    Lanes-1:0] read, memory_read, word_read;
  logic   [BlockBits-1:0] block[Lanes], memory_block[Lanes], root_block;
  logic   [          2:0] octant[Lanes], memory_octant[Lanes], root_octant;
  logic   [PayloadBits:0] word[Lanes];
  logic                   reads_root;

  voxrt_root #(
    .BlockBits   (BlockBits),
    .MemoryClocks(memory_clocks(Banked))
  ) u_root (
    .clk_i,
    .rst_ni,
    .start_i  (start),
    .address_i(root_i),
    .first_i  (first_word),
    .done_o   (start_q),
    .root_o   (root),
    .reads_o  (reads_root),
    .block_o  (root_block),
    .octant_o (root_octant),
    .ack_i    (word_read[0]),
    .word_i   (word[0])
  );

  always_comb begin
    memory_read   = read;
    memory_block  = block;
    memory_octant = octant;
    if (reads_root) begin
      memory_read[0]   = 1'b1;
      memory_block[0]  = root_block;
      memory_octant[0] = root_octant;
    end
  end

  logic                         corner;
  logic signed [  ScanBits-1:0] line_step[3], way[3];
  logic        [     Lanes-1:0] has_place, promise;
  logic                         shadow_valid;
  logic        [     Lanes-1:0] shadow_lane;
  logic        [   TagBits-1:0] shadow_tag;
  logic signed [   LitBits-1:0] lit_point[3];

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

  logic                           ray_valid, overflow, ray_resolved, ray_shadow, ray_lit;
  logic        [       Lanes-1:0] ray_lane;
  pixel_t                         ray_pixel;
  logic        [             2:0] ray_mirrored, ray_dead, ray_octant;
  logic        [  WeightBits-1:0] ray_weight[3];
  logic        [    KeyBits-1:0] ray_entry_time;
  face_e                          ray_entry_face;
  logic signed [DistanceBits-1:0] ray_origin[3];
  logic        [     TagBits-1:0] ray_tag;

  // With Light or Mirrors the lanes go into a root that is a leaf: its faces are lit and reflect too.
  localparam bit ResolvesRoot = !Light && !Mirrors;

  voxrt_rays #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .TagBits     (TagBits),
    .Light       (Light)
  ) u_rays (
    .clk_i,
    .rst_ni,
    .start_i          (start_q),
    .corner_i         (corner),
    .line_step_i      (line_step),
    .right_i          (right_q),
    .width_i          (width_q),
    .height_i         (height_q),
    .origin_i         (origin_q),
    .mirrored_origin_i(mirrored_origin_q),
    .depth_i          (depth_q),
    .world_i          (world_q),
    .root_leaf_i      (ResolvesRoot && root[PayloadBits]),
    .root_material_i  (!ResolvesRoot || root[8] ? '0 : root[7:0]),
    .has_place_i      (has_place),
    .promise_o        (promise),
    .shadow_valid_i   (shadow_valid),
    .shadow_lane_i    (shadow_lane),
    .shadow_tag_i     (shadow_tag),
    .lit_point_i      (lit_point),
    .way_i            (way),
    .valid_o          (ray_valid),
    .lane_o           (ray_lane),
    .resolved_o       (ray_resolved),
    .pixel_o          (ray_pixel),
    .overflow_o       (overflow),
    .mirrored_o       (ray_mirrored),
    .dead_o           (ray_dead),
    .octant_o         (ray_octant),
    .weight_o         (ray_weight),
    .entry_time_o     (ray_entry_time),
    .entry_face_o     (ray_entry_face),
    .origin_o         (ray_origin),
    .shadow_o         (ray_shadow),
    .lit_o            (ray_lit),
    .tag_o            (ray_tag)
  );

  logic [MaxDepth:0] before_light[2][3], to_light[2][3];

  // Tracks.
  logic   [    Lanes-1:0] pixel_valid, pixel_ready, pixel_lit, bad_pointer, step_limit;
  logic   [    Lanes-1:0] request, request_ready, shadow_started;
  logic   [    Width-1:0] pixel            [Lanes];
  logic   [  TagBits-1:0] request_tag      [Lanes];
  face_e                  request_face     [Lanes];
  logic   [          2:0] request_mirrored [Lanes];
  logic   [PlaceBits-1:0] request_place    [Lanes][3];

  for (genvar i = 0; i < Lanes; i++) begin : gen_track
    voxrt_track #(
      .MaxDepth    (MaxDepth),
      .PositionBits(PositionBits),
      .BlockBits   (BlockBits),
      .MemoryClocks(memory_clocks(Banked)),
      .RayDepth    (RayDepth),
      .PixelDepth  (PixelDepth),
      .Light       (Light),
      .Mirrors     (Mirrors)
    ) u_track (
      .clk_i,
      .rst_ni,
      .origin_i              (origin_q),
      .mirrored_origin_i     (mirrored_origin_q),
      .world_i               (world_q),
      .beyond_i              (beyond_q),
      .root_i                (root),
      .light_i               (shading_q.light),
      .bounces_i             (shading_q.bounces),
      .before_light_i        (before_light),
      .to_light_i            (to_light),
      .table_write_i,
      .table_material_i,
      .table_row_i,
      .promise_i             (promise[i]),
      .has_place_o           (has_place[i]),
      .ray_valid_i           (ray_valid && ray_lane[i]),
      .ray_resolved_i        (ray_resolved),
      .ray_pixel_i           (ray_pixel),
      .ray_mirrored_i        (ray_mirrored),
      .ray_dead_i            (ray_dead),
      .ray_octant_i          (ray_octant),
      .ray_weight_i          (ray_weight),
      .ray_entry_time_i      (ray_entry_time),
      .ray_entry_face_i      (ray_entry_face),
      .ray_origin_i          (ray_origin),
      .ray_shadow_i          (ray_shadow),
      .ray_lit_i             (ray_lit),
      .ray_tag_i             (ray_tag),
      .shadow_started_o      (shadow_started[i]),
      .mem_read_o            (read[i]),
      .mem_block_o           (block[i]),
      .mem_octant_o          (octant[i]),
      .mem_ack_i             (word_read[i]),
      .mem_word_i            (word[i]),
      .request_o             (request[i]),
      .request_ready_i       (request_ready[i]),
      .request_tag_o         (request_tag[i]),
      .request_face_o        (request_face[i]),
      .request_mirrored_o    (request_mirrored[i]),
      .request_place_o       (request_place[i]),
      .pixel_valid_o         (pixel_valid[i]),
      .pixel_ready_i         (pixel_ready[i]),
      .pixel_o               (pixel[i]),
      .lit_o                 (pixel_lit[i]),
      .bad_pointer_o         (bad_pointer[i]),
      .step_limit_o          (step_limit[i])
    );
  end

  if (Light) begin : gen_light
    voxrt_light #(
      .Lanes     (Lanes),
      .MaxDepth  (MaxDepth),
      .TagBits   (TagBits),
      .QueueDepth(RayDepth)
    ) u_light (
      .clk_i,
      .rst_ni,
      .world_i   (world_q),
      .light_i   (light_q),
      .request_i (request),
      .ready_o   (request_ready),
      .tag_i     (request_tag),
      .face_i    (request_face),
      .mirrored_i(request_mirrored),
      .place_i   (request_place),
      .started_i (shadow_started),
      .valid_o   (shadow_valid),
      .lane_o    (shadow_lane),
      .tag_o     (shadow_tag),
      .lit_o     (lit_point),
      .way_o     (way),
      .before_light_o(before_light),
      .to_light_o    (to_light)
    );
  end else begin : gen_no_light
    logic [Lanes-1:0] unused_request;
    always_comb begin
      for (int unsigned i = 0; i < Lanes; i++) begin
        unused_request[i] = &{request[i], shadow_started[i], request_tag[i], request_face[i], request_mirrored[i],
                              request_place[i][0], request_place[i][1], request_place[i][2]};
      end
    end
    assign request_ready = '0;
    assign {shadow_valid, shadow_lane, shadow_tag} = '0;
    assign lit_point     = '{default: '0};
    assign way           = '{default: '0};
    assign before_light  = '{default: '0};
    assign to_light      = '{default: '0};
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
    .root_o  (first_word),
    .read_i  (memory_read),
    .block_i (memory_block),
    .octant_i(memory_octant),
    .ack_o   (word_read),
    .word_o  (word)
  );

  // Pixels.
  voxrt_pixels #(
    .Lanes   (Lanes),
    .MaxDepth(MaxDepth),
    .Flat    (Flat),
    .Light   (Light),
    .Mirrors (Mirrors)
  ) u_pixels (
    .clk_i,
    .rst_ni,
    .start_i       (start_q),
    .corner_i      (corner),
    .line_step_i   (line_step),
    .right_i       (right_q),
    .width_i       (width_q),
    .height_i      (height_q),
    .world_i       (world_q),
    .light_i       (light_q),
    .flat_i        (shading_q.flat),
    .ambient_i     (shading_q.ambient),
    .table_write_i,
    .table_material_i,
    .table_colour_i(table_row_i.colour),
    .valid_i       (pixel_valid),
    .ready_o       (pixel_ready),
    .lit_i         (pixel_lit),
    .pixel_i       (pixel),
    .out_valid_o,
    .out_ready_i,
    .out_colour_o,
    .out_pixel_o,
    .out_first_o,
    .out_line_end_o,
    .out_last_o
  );

  voxrt_counters #(
    .Lanes(Lanes)
  ) u_counters (
    .clk_i,
    .start_i             (start),
    .rays_start_i        (start_q),
    .busy_i              (busy_q),
    .pixel_valid_i       (out_valid_o),
    .pixel_ready_i       (out_ready_i),
    .hit_i               (out_pixel_o.material != '0),
    .word_read_i         (word_read),
    .direction_overflow_i(ray_valid && overflow),
    .bad_pointer_i       (bad_pointer != '0 || (start_q && root[PayloadBits] && root[8])),
    .step_limit_i        (step_limit != '0),
    .error_o,
    .cycles_o,
    .rays_o,
    .words_read_o,
    .hits_o,
    .stalls_o
  );
endmodule
