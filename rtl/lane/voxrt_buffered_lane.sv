// A lane with the queue of its rays before it and the reorder buffer of its pixels behind it. The ring of a lane never
// stops, and its rays end in another order than they came: these two make it a module with a stream on either side.
//
// Credits: issue_i, only where credit_o was high, reserves a place in the queue for a ray of the camera, which comes
// some clocks later. Shadow rays have a queue of their own, whose places voxrt_light counts.
`include "voxrt_assert.svh"

module voxrt_buffered_lane
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned BlockBits    = 12,
  parameter int unsigned MemoryClocks = 2,     // Clocks from an address to its word (memory_clocks): 2 .. 5.
  parameter int unsigned RowBits      = 5,     // 2**RowBits rays, in slots and waiting: 5, or, as with Light, 6.
  parameter int unsigned RayDepth     = 16,    // Waiting rays, of each kind: a power of two, 2 .. 2**RowBits.
  parameter int unsigned CreditClocks = 1,     // credit_o does not count what was issued so many clocks before: 1 .. 3.
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  parameter bit          Lod          = 1'b0
) (
  input logic clk_i,
  input logic rst_ni,
  // Held during a frame; see voxrt_lane.
  input world_t world_i,
  input logic [payload_bits(BlockBits, Lod):0] root_i,
  input shading_t shading_i,
  input light_planes_t light_planes_i,
  input material_write_t material_write_i,
  // Rays.
  input logic issue_i,
  output logic credit_o,
  input logic ray_valid_i,
  input ray_t ray_i,
  input weights_t weights_i,
  output logic shadow_issued_o,  // A shadow ray has left its queue.
  // Octree memory.
  output logic mem_read_o,
  output logic [BlockBits+2:0] mem_address_o,
  input logic mem_ack_i,
  input logic [payload_bits(BlockBits, Lod):0] mem_word_i,
  // To voxrt_light.
  output logic hit_point_claim_o,
  output logic hit_point_valid_o,
  input logic hit_point_ready_i,
  output hit_point_t hit_point_o,
  // Pixels, in order.
  output logic pixel_valid_o,
  input logic pixel_ready_i,
  output logic lit_o,
  output logic [pixel_bits(MaxDepth, Light, Mirrors)-1:0] pixel_o,
  // Errors, for one clock each.
  output logic bad_pointer_o,
  output logic step_limit_o
);
  if (MemoryClocks < 2 || MemoryClocks > 5) $error("voxrt_buffered_lane: MemoryClocks must be 2 to 5 clocks");
  if (RowBits < 5 || RowBits > RowLimit) $error("voxrt_buffered_lane: RowBits must be 5 or 6 bits");
  if (RayDepth < 2 || RayDepth > 2 ** RowBits || 2 ** $clog2(RayDepth) != RayDepth)
    $error("voxrt_buffered_lane: RayDepth must be a power of two, 2 to 2**RowBits");
  if (CreditClocks < 1 || CreditClocks > 3) $error("voxrt_buffered_lane: CreditClocks must be 1 to 3 clocks");

  localparam int unsigned OriginBits = distance_bits(MaxDepth, PositionBits);
  localparam int unsigned KeyBits = key_bits(MaxDepth, Light);
  localparam int unsigned Width = pixel_bits(MaxDepth, Light, Mirrors);

  // A ray in the queue, no wider than this configuration needs.
  typedef struct packed {
    logic               resolved;
    logic [2:0]         mirrored;
    logic [2:0]         dead;
    logic [2:0]         octant;
    logic [RowBits-1:0] row;
    logic [KeyBits-1:0] entry_time;
    face_e              entry_face;
  } queued_t;

  typedef logic [2:0][OriginBits-1:0] origin_t;

  queued_t arriving, queued;
  origin_t arriving_origin, origin;
  logic ray_valid, ray_ready, shadow, lit;
  logic [TagBits-1:0] tag;
  pixel_t pixel;
  logic [RowBits-1:0] arrival_row;
  row_free_t row_free;
  weights_write_t weights_write;
  ray_t ray;

  always_comb begin
    arriving = '{
        resolved: ray_i.resolved,
        mirrored: ray_i.mirrored,
        dead: ray_i.dead,
        octant: ray_i.octant,
        row: arrival_row,
        entry_time: ray_i.entry_time[KeyBits-1:0],
        entry_face: ray_i.entry_face
    };
    for (int unsigned a = 0; a < 3; a++) arriving_origin[a] = ray_i.origin[a][OriginBits-1:0];
  end

  // The weights of a ray go to the lane when it comes, all else through the queue.
  assign weights_write = '{valid: ray_valid_i, row: RowLimit'(arrival_row), weights: weights_i, reach: ray_i.reach};

  voxrt_free_list #(
    .RowBits(RowBits)
  ) u_free_rows (
    .clk_i,
    .rst_ni,
    .allocate_i(ray_valid_i),
    .row_o     (arrival_row),
    .free_i    (row_free.valid),
    .row_i     (row_free.row[RowBits-1:0])
  );

  // Places in the queue that are not reserved: as many as there are rows for.
  localparam int unsigned Rows = 2 ** RowBits - lane_slots(MemoryClocks) - (Light ? RayDepth : 0);
  localparam int unsigned Credits = Rows < RayDepth ? Rows : RayDepth;
  localparam int unsigned CountBits = $clog2(RayDepth) + 1;
  logic [CountBits-1:0] credits_q;
  logic returned_q, credit_q;

  assign credit_o        = credit_q;
  assign shadow_issued_o = ray_valid && ray_ready && shadow;

  always_ff @(posedge clk_i) begin
    returned_q <= rst_ni && ray_valid && ray_ready && !shadow;
    credits_q  <= credits_q - CountBits'(issue_i) + CountBits'(returned_q);
    // Credits may have been taken since credits_q was compared, so some are kept back.
    credit_q   <= credits_q > CountBits'(CreditClocks) && rst_ni;
    if (!rst_ni) credits_q <= CountBits'(Credits);
  end

  if (Light) begin : gen_two_queues
    voxrt_ray_queue #(
      .Width($bits(queued_t) + $bits(origin_t) + TagBits + 1),
      .Depth(RayDepth)
    ) u_rays (
      .clk_i,
      .rst_ni,
      .valid_i (ray_valid_i),
      .shadow_i(ray_i.shadow),
      .data_i  ({arriving, arriving_origin, ray_i.tag, ray_i.lit}),
      .valid_o (ray_valid),
      .shadow_o(shadow),
      .ready_i (ray_ready),
      .data_o  ({queued, origin, tag, lit})
    );
    assign pixel = '{material: '0, face: FaceNone};
  end else begin : gen_queue
    // Resolved rays have met the root that is a leaf, or nothing; with mirrors, nothing.
    localparam int unsigned ExtraBits = Mirrors ? $bits(origin_t) : $bits(pixel_t);
    logic unused_ready, head_valid, head_ready;
    logic [ExtraBits-1:0] extra_in, extra, head_extra;
    queued_t head;

    voxrt_fifo #(
      .Width($bits(queued_t) + ExtraBits),
      .Depth(RayDepth)
    ) u_rays (
      .clk_i,
      .rst_ni,
      .valid_i(ray_valid_i),
      .ready_o(unused_ready),
      .data_i ({arriving, extra_in}),
      .valid_o(head_valid),
      .ready_i(head_ready),
      .data_o ({head, head_extra})
    );

    // A register: the lane's decision is a long path. (Not with two queues, whose head may change.)
    voxrt_stream_register #(
      .Width($bits(queued_t) + ExtraBits)
    ) u_head (
      .clk_i,
      .rst_ni,
      .valid_i(head_valid),
      .ready_o(head_ready),
      .data_i ({head, head_extra}),
      .valid_o(ray_valid),
      .ready_i(ray_ready),
      .data_o ({queued, extra})
    );

    if (Mirrors) begin : gen_origin
      assign extra_in = arriving_origin;
      assign origin   = extra;
      assign pixel    = '{material: '0, face: FaceNone};
    end else begin : gen_pixel
      logic unused_origin;
      assign unused_origin = ^arriving_origin;
      assign extra_in      = ray_i.pixel;
      assign pixel         = extra;
      assign origin        = '0;
    end
    assign shadow = 1'b0;
    assign lit    = 1'b0;
    assign tag    = '0;
  end

  always_comb begin
    ray.resolved   = queued.resolved;
    ray.pixel      = pixel;
    ray.lit        = lit;
    ray.shadow     = shadow;
    ray.tag        = tag;
    ray.mirrored   = queued.mirrored;
    ray.dead       = queued.dead;
    ray.octant     = queued.octant;
    ray.entry_time = KeyLimit'(queued.entry_time);
    ray.entry_face = queued.entry_face;
    ray.reach      = '0;  // The reach goes with the weights.
    for (int unsigned a = 0; a < 3; a++) ray.origin[a] = DistanceLimit'($signed(origin[a]));
  end

  logic allocate, allocate_ready;
  logic [TagBits-1:0] allocate_tag;
  result_t result;
  logic [Width-1:0] result_pixel;

  voxrt_lane #(
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryClocks(MemoryClocks),
    .RowBits     (RowBits),
    .Light       (Light),
    .Mirrors     (Mirrors),
    .Lod         (Lod)
  ) u_lane (
    .clk_i,
    .rst_ni,
    .world_i,
    .root_i,
    .shading_i,
    .light_planes_i,
    .material_write_i,
    .weights_write_i (weights_write),
    .row_free_o      (row_free),
    .ray_valid_i     (ray_valid),
    .ray_ready_o     (ray_ready),
    .ray_i           (ray),
    .ray_row_i       (queued.row),
    .mem_read_o,
    .mem_address_o,
    .mem_ack_i,
    .mem_word_i,
    .allocate_o      (allocate),
    .allocate_ready_i(allocate_ready),
    .allocate_tag_i  (allocate_tag),
    .result_o        (result),
    .result_pixel_o  (result_pixel),
    .hit_point_claim_o,
    .hit_point_ready_i,
    .hit_point_valid_o,
    .hit_point_o,
    .bad_pointer_o,
    .step_limit_o
  );

  voxrt_pixel_buffer #(
    .Width        (Width),
    .Depth        (PixelDepth),
    .StoresEarlier(Light)
  ) u_pixels (
    .clk_i,
    .rst_ni,
    .allocate_i(allocate),
    .ready_o   (allocate_ready),
    .tag_o     (allocate_tag),
    .complete_i(result.complete),
    .tag_i     (result.tag),
    .lit_i     (result.lit),
    .store_i   (result.store),
    .pixel_i   (result_pixel),
    .valid_o   (pixel_valid_o),
    .ready_i   (pixel_ready_i),
    .lit_o,
    .pixel_o
  );

  `VOXRT_ASSERT(IssuedRayHasCredit, !issue_i || credits_q != '0)
  `VOXRT_ASSERT(CreditsWithinPlaces, credits_q <= CountBits'(Credits))
  if (!Light) begin : gen_check_queue
    `VOXRT_ASSERT(QueueHoldsRay, !ray_valid_i || gen_queue.u_rays.ready_o)
  end
endmodule
