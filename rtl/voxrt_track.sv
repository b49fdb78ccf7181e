// A lane with what stands before and behind it: the queue of its rays and the buffer that puts its pixels in order.
module voxrt_track
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth     = 10,
  parameter  int unsigned PositionBits = 17,
  parameter  int unsigned BlockBits    = 12,
  parameter  int unsigned MemoryClocks = 2,
  parameter  int unsigned RayDepth     = 16,   // Rays that wait, of the camera and shadow rays each.
  parameter  int unsigned PixelDepth   = 256,  // Pixels between start and merge.
  parameter  bit          Light        = 1'b0,
  parameter  bit          Mirrors      = 1'b0,
  localparam int unsigned TagBits      = $clog2(PixelDepth) + 1,
  localparam int unsigned OriginBits   = distance_bits(MaxDepth, PositionBits),
  localparam int unsigned KeyBits      = key_bits(MaxDepth, Light),
  localparam int unsigned PayloadBits  = payload_bits(BlockBits),
  localparam int unsigned PlaceBits    = MaxDepth + FractionBits,
  localparam int unsigned Width        = pixel_bits(MaxDepth, Light, Mirrors)
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  // Held during a frame; see voxrt_lane.
  input  logic signed [OriginBits-1:0] origin_i                [3],
  input  logic signed [OriginBits-1:0] mirrored_origin_i       [3],
  input  logic        [    MaxDepth:0] world_i,
  input  logic        [  MaxDepth-1:0] beyond_i,
  input  logic        [ PayloadBits:0] root_i,
  input  logic                         light_i,
  input  logic        [BounceBits-1:0] bounces_i,
  input  logic        [    MaxDepth:0] before_light_i          [2][3],
  input  logic        [    MaxDepth:0] to_light_i              [2][3],
  input  logic                         table_write_i,
  input  material_t                    table_material_i,
  input  row_t                         table_row_i,
  // A ray of the camera will come: promise_i only while has_place_o.
  input  logic                         promise_i,
  output logic                         has_place_o,
  // Rays; see voxrt_ray_setup.
  input  logic                         ray_valid_i,
  input  logic                         ray_resolved_i,
  input  pixel_t                       ray_pixel_i,
  input  logic        [           2:0] ray_mirrored_i,
  input  logic        [           2:0] ray_dead_i,
  input  logic        [           2:0] ray_octant_i,
  input  logic        [WeightBits-1:0] ray_weight_i            [3],
  input  logic        [  KeyBits-1:0] ray_entry_time_i,
  input  face_e                        ray_entry_face_i,
  input  logic signed [OriginBits-1:0] ray_origin_i            [3],
  input  logic                         ray_shadow_i,
  input  logic                         ray_lit_i,
  input  logic        [   TagBits-1:0] ray_tag_i,
  output logic                         shadow_started_o,
  // Octree memory.
  output logic                         mem_read_o,
  output logic        [ BlockBits-1:0] mem_block_o,
  output logic        [           2:0] mem_octant_o,
  input  logic                         mem_ack_i,
  input  logic        [ PayloadBits:0] mem_word_i,
  // To voxrt_light.
  output logic                         request_o,
  input  logic                         request_ready_i,
  output logic        [   TagBits-1:0] request_tag_o,
  output face_e                        request_face_o,
  output logic        [           2:0] request_mirrored_o,
  output logic        [ PlaceBits-1:0] request_place_o         [3],
  // Pixels.
  output logic                         pixel_valid_o,
  input  logic                         pixel_ready_i,
  output logic                         lit_o,
  output logic        [     Width-1:0] pixel_o,
  // Sticky errors.
  output logic                         bad_pointer_o,
  output logic                         step_limit_o
);
  localparam int unsigned RowBits = row_bits(Light);

  typedef struct packed {
    logic                       resolved;
    logic [2:0]                 mirrored;
    logic [2:0]                 dead;
    logic [2:0]                 octant;
    logic [RowBits-1:0]         row;
    logic [KeyBits-1:0]         entry_time;
    face_e                      entry_face;
  } ray_t;

  ray_t                         ray_in, ray;
  logic                         ray_valid, ray_ready;
  pixel_t                       ray_pixel;
  logic                         ray_shadow, ray_lit;
  logic        [   TagBits-1:0] ray_tag;
  logic signed [OriginBits-1:0] ray_origin[3];
  logic        [   RowBits-1:0] arrival_row, released_row;
  logic                         releases;

  assign ray_in = '{
      resolved: ray_resolved_i,
      mirrored: ray_mirrored_i,
      dead: ray_dead_i,
      octant: ray_octant_i,
      row: arrival_row,
      entry_time: ray_entry_time_i,
      entry_face: ray_entry_face_i
  };

  // The weights of a ray go to the lane when it comes, all else by way of the queue.
  voxrt_free_rows #(
    .RowBits(RowBits)
  ) u_free_rows (
    .clk_i,
    .rst_ni,
    .take_i(ray_valid_i),
    .row_o (arrival_row),
    .give_i(releases),
    .row_i (released_row)
  );

  // Places in the queue that are not promised to a ray of the camera under way: as many as there are rows for.
  localparam int unsigned Rows = 2 ** RowBits - lane_slots(MemoryClocks) - (Light ? RayDepth : 0);
  localparam int unsigned Places = Rows < RayDepth ? Rows : RayDepth;
  localparam int unsigned CountBits = $clog2(RayDepth) + 1;
  logic [CountBits-1:0] places_q;
  logic                 returned_q, has_place_q;

  assign has_place_o      = has_place_q;
  assign shadow_started_o = ray_valid && ray_ready && ray_shadow;

  always_ff @(posedge clk_i) begin
    returned_q  <= rst_ni && ray_valid && ray_ready && !ray_shadow;
    places_q    <= places_q - CountBits'(promise_i) + CountBits'(returned_q);
    // A clock late, in which a place may have been promised.
    has_place_q <= places_q > CountBits'(1) && rst_ni;
    if (!rst_ni) places_q <= CountBits'(Places);
  end

  if (Light) begin : gen_two_queues
    voxrt_ray_queue #(
      .Width($bits(ray_t) + 3 * OriginBits + TagBits + 1),
      .Depth(RayDepth)
    ) u_rays (
      .clk_i,
      .rst_ni,
      .valid_i (ray_valid_i),
      .shadow_i(ray_shadow_i),
      .data_i  ({ray_in, ray_origin_i[0], ray_origin_i[1], ray_origin_i[2], ray_tag_i, ray_lit_i}),
      .valid_o (ray_valid),
      .shadow_o(ray_shadow),
      .ready_i (ray_ready),
      .data_o  ({ray, ray_origin[0], ray_origin[1], ray_origin[2], ray_tag, ray_lit})
    );
    logic unused_pixel;
    assign unused_pixel = &ray_pixel_i;
    assign ray_pixel    = '{material: '0, face: FaceNone};
  end else begin : gen_queue
    // Resolved rays have met the root that is a leaf, or nothing; with mirrors, nothing.
    localparam int unsigned ExtraBits = Mirrors ? 3 * OriginBits : $bits(pixel_t);
    logic                 unused_ready, head_valid, head_ready;
    logic [ExtraBits-1:0] extra_in, extra, head_extra;
    ray_t                 head;

    voxrt_fifo #(
      .Width($bits(ray_t) + ExtraBits),
      .Depth(RayDepth)
    ) u_rays (
      .clk_i,
      .rst_ni,
      .valid_i(ray_valid_i),
      .ready_o(unused_ready),
      .data_i ({ray_in, extra_in}),
      .valid_o(head_valid),
      .ready_i(head_ready),
      .data_o ({head, head_extra})
    );

    // The lane decides at once: no memory in the way. (Of two queues, the head may change.)
    voxrt_stream_register #(
      .Width($bits(ray_t) + ExtraBits)
    ) u_head (
      .clk_i,
      .rst_ni,
      .valid_i(head_valid),
      .ready_o(head_ready),
      .data_i ({head, head_extra}),
      .valid_o(ray_valid),
      .ready_i(ray_ready),
      .data_o ({ray, extra})
    );

    logic unused_shadow;
    assign unused_shadow = &{ray_shadow_i, ray_lit_i, ray_tag_i};

    if (Mirrors) begin : gen_origin
      logic unused_pixel;
      assign unused_pixel = &ray_pixel_i;
      assign extra_in  = {ray_origin_i[0], ray_origin_i[1], ray_origin_i[2]};
      assign {ray_origin[0], ray_origin[1], ray_origin[2]} = extra;
      assign ray_pixel = '{material: '0, face: FaceNone};
    end else begin : gen_pixel
      logic unused_origin;
      assign unused_origin = &{ray_origin_i[0], ray_origin_i[1], ray_origin_i[2]};
      assign extra_in   = ray_pixel_i;
      assign ray_pixel  = extra;
      assign ray_origin = '{default: '0};
    end
    assign ray_shadow = 1'b0;
    assign ray_lit    = 1'b0;
    assign ray_tag    = '0;
  end

  logic                    take, take_ready, fill, lit, store;
  logic   [   TagBits-1:0] take_tag, tag;
  logic   [     Width-1:0] pixel;

  voxrt_lane #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .TagBits     (TagBits),
    .MemoryClocks(MemoryClocks),
    .RowBits     (RowBits),
    .Light       (Light),
    .Mirrors     (Mirrors)
  ) u_lane (
    .clk_i,
    .rst_ni,
    .origin_i,
    .mirrored_origin_i,
    .world_i,
    .beyond_i,
    .root_i,
    .light_i,
    .bounces_i,
    .before_light_i,
    .to_light_i,
    .table_write_i,
    .table_material_i,
    .table_row_i,
    .arrives_i         (ray_valid_i),
    .arrival_row_i     (arrival_row),
    .arrival_weight_i  (ray_weight_i),
    .releases_o        (releases),
    .released_row_o    (released_row),
    .ray_valid_i       (ray_valid),
    .ray_ready_o       (ray_ready),
    .ray_resolved_i    (ray.resolved),
    .ray_pixel_i       (ray_pixel),
    .ray_mirrored_i    (ray.mirrored),
    .ray_dead_i        (ray.dead),
    .ray_octant_i      (ray.octant),
    .ray_row_i         (ray.row),
    .ray_entry_time_i  (ray.entry_time),
    .ray_entry_face_i  (ray.entry_face),
    .ray_origin_i      (ray_origin),
    .ray_shadow_i      (ray_shadow),
    .ray_tag_i         (ray_tag),
    .ray_lit_i         (ray_lit),
    .mem_read_o,
    .mem_block_o,
    .mem_octant_o,
    .mem_ack_i,
    .mem_word_i,
    .take_o            (take),
    .take_ready_i      (take_ready),
    .take_tag_i        (take_tag),
    .fill_o            (fill),
    .fill_tag_o        (tag),
    .fill_lit_o        (lit),
    .store_o           (store),
    .store_pixel_o     (pixel),
    .request_o,
    .request_ready_i,
    .request_tag_o,
    .request_face_o,
    .request_mirrored_o,
    .request_place_o,
    .bad_pointer_o,
    .step_limit_o
  );

  voxrt_pixel_buffer #(
    .Width      (Width),
    .Depth      (PixelDepth),
    .StoresFirst(Light)
  ) u_pixels (
    .clk_i,
    .rst_ni,
    .take_i (take),
    .ready_o(take_ready),
    .tag_o  (take_tag),
    .fill_i (fill),
    .tag_i  (tag),
    .lit_i  (lit),
    .store_i(store),
    .pixel_i(pixel),
    .valid_o(pixel_valid_o),
    .ready_i(pixel_ready_i),
    .lit_o,
    .pixel_o
  );
endmodule
