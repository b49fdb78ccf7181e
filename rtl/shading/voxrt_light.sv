// Makes shadow rays of the hit points of the camera's rays, for all lanes, and finds where the light is among the
// planes.
//
// Lanes are served in turn: once per Lanes clocks is enough for a lane, whose rays read a dozen words between two hit
// points. A lane has at most QueueDepth shadow rays under way, from its claim until it issues the ray (issued_i): it may
// claim while hit_point_ready_o is high, and at a clock in which it issues a shadow ray. Some clocks later it gives the
// hit point.
`include "voxrt_assert.svh"

module voxrt_light
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes      = 1,
  parameter int unsigned MaxDepth   = 10,
  parameter int unsigned QueueDepth = 16   // Shadow rays per lane: a power of two, 2 or more.
) (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  // Held during a frame.
  input  logic          [MaxDepth:0]       side_i,                    // Side of the world in voxels, one-hot.
  input  logic          [       2:0][31:0] light_i,                   // 1/16 voxel, signed.
  // Hit points of voxrt_lane.
  input  logic          [ Lanes-1:0]       hit_point_claim_i,
  output logic          [ Lanes-1:0]       hit_point_ready_o,
  input  logic          [ Lanes-1:0]       hit_point_valid_i,
  input  hit_point_t                       hit_point_i      [Lanes],
  input  logic          [ Lanes-1:0]       issued_i,
  // To voxrt_ray_setup, which always takes them.
  output logic                             valid_o,
  output logic          [ Lanes-1:0]       lane_o,                    // One-hot.
  output shadow_ray_t                      shadow_ray_o,
  output light_planes_t                    light_planes_o
);
  if (QueueDepth < 2 || 2 ** $clog2(QueueDepth) != QueueDepth)
    $error("voxrt_light: QueueDepth must be a power of two, 2 or more");

  localparam int unsigned CountBits = $clog2(QueueDepth) + 1;
  localparam int unsigned HitBits = MaxDepth + FractionBits;
  localparam int unsigned LightBits = light_bits(MaxDepth);

  // A hit point in the queue, no wider than this configuration needs.
  typedef struct packed {
    logic [TagBits-1:0]      tag;
    face_e                   face;
    logic [2:0]              mirrored;
    logic [2:0][HitBits-1:0] point;
  } queued_t;

  logic [Lanes-1:0] waiting, grant_q;  // One-hot.
  queued_t queued[Lanes];
  queued_t granted;

  always_ff @(posedge clk_i) begin
    grant_q <= Lanes'({grant_q, grant_q[Lanes-1]});
    if (!rst_ni) grant_q <= Lanes'(1);
  end

  for (genvar i = 0; i < Lanes; i++) begin : gen_lane
    logic [CountBits-1:0] credits_q;  // Shadow rays that the lane may still claim.
    logic ready;
    queued_t arriving;

    always_comb begin
      arriving.tag      = hit_point_i[i].tag;
      arriving.face     = hit_point_i[i].face;
      arriving.mirrored = hit_point_i[i].mirrored;
      for (int unsigned a = 0; a < 3; a++) arriving.point[a] = hit_point_i[i].point[a][HitBits-1:0];
    end

    assign hit_point_ready_o[i] = credits_q != '0;

    always_ff @(posedge clk_i) begin
      credits_q <= credits_q - CountBits'(hit_point_claim_i[i]) + CountBits'(issued_i[i]);
      if (!rst_ni) credits_q <= CountBits'(QueueDepth);
    end

    voxrt_fifo #(
      .Width($bits(queued_t)),
      .Depth(QueueDepth)
    ) u_hit_points (
      .clk_i,
      .rst_ni,
      .valid_i(hit_point_valid_i[i]),
      .ready_o(ready),
      .data_i (arriving),
      .valid_o(waiting[i]),
      .ready_i(grant_q[i]),
      .data_o (queued[i])
    );

    `VOXRT_ASSERT(ClaimHasCredit, !hit_point_claim_i[i] || hit_point_ready_o[i] || issued_i[i])
    `VOXRT_ASSERT(QueueHoldsHitPoint, !hit_point_valid_i[i] || ready)
    `VOXRT_ASSERT(CreditsWithinPlaces, credits_q <= CountBits'(QueueDepth))
  end

  always_comb begin
    granted = '0;
    for (int unsigned i = 0; i < Lanes; i++) if (grant_q[i]) granted |= queued[i];
  end

  // The hit point, then the point that is lit, then the direction.
  logic [2:0] valid_q;
  logic [Lanes-1:0] lane_q[3];
  logic [TagBits-1:0] tag_q[1:2];
  queued_t queued_q;
  hit_point_t hit_point;
  logic signed [LightBits+1:0] direction[3];
  logic signed [MaxDepth+FractionBits+2:0] point[3];

  always_ff @(posedge clk_i) begin
    valid_q     <= rst_ni ? {valid_q[1:0], (waiting & grant_q) != '0} : '0;
    lane_q[0]   <= grant_q;
    queued_q    <= granted;
    lane_q[1:2] <= lane_q[0:1];
    tag_q       <= '{queued_q.tag, tag_q[1]};
  end

  always_comb begin
    hit_point.tag      = queued_q.tag;
    hit_point.face     = queued_q.face;
    hit_point.mirrored = queued_q.mirrored;
    for (int unsigned a = 0; a < 3; a++) hit_point.point[a] = PointLimit'(queued_q.point[a]);
  end

  voxrt_light_direction #(
    .MaxDepth(MaxDepth)
  ) u_direction (
    .clk_i,
    .enable_i   (1'b1),
    .side_i,
    .light_i,
    .hit_point_i(hit_point),
    .point_o    (point),
    .direction_o(direction)
  );

  assign valid_o = valid_q[2];
  assign lane_o  = lane_q[2];

  always_comb begin
    shadow_ray_o.tag = tag_q[2];
    for (int unsigned a = 0; a < 3; a++) begin
      shadow_ray_o.point[a]     = ShadowPointLimit'(point[a]);
      shadow_ray_o.direction[a] = ScanBits'(direction[a]);
    end
  end

  // The light among the planes.
  localparam int unsigned Voxel = 2 ** FractionBits;
  logic signed [LightBits-1:0] light[2][3];
  logic [MaxDepth:0] occluder_q[2][3], backface_q[2][3];

  function automatic logic [MaxDepth:0] plane_at(logic signed [LightBits-1:0] height, logic [MaxDepth:0] side);
    logic signed [LightBits-1:0] plane = height >>> FractionBits;
    if (plane < 0) return '0;
    return plane > LightBits'(side) ? side : plane[MaxDepth:0];
  endfunction

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      light[0][a] = light_i[a][LightBits-1:0];
      light[1][a] = LightBits'({side_i, FractionBits'(0)}) - light[0][a];
    end
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned m = 0; m < 2; m++) begin
      for (int unsigned a = 0; a < 3; a++) begin
        occluder_q[m][a] <= plane_at(light[m][a] + LightBits'(Voxel - 1), side_i);
        backface_q[m][a] <= plane_at(light[m][a] + LightBits'(Voxel), side_i);
      end
    end
  end

  always_comb begin
    for (int unsigned m = 0; m < 2; m++) begin
      for (int unsigned a = 0; a < 3; a++) begin
        light_planes_o.occluder[m][a] = (DepthLimit + 1)'(occluder_q[m][a]);
        light_planes_o.backface[m][a] = (DepthLimit + 1)'(backface_q[m][a]);
      end
    end
  end
endmodule
