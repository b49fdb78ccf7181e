// Issues the rays of a frame to the lanes, one per RayClocks clocks. Rays of the camera go to the lanes in turn, each when
// its lane has a credit; shadow rays (Light) go first, at any clock: their places in the queue are reserved already.
`include "voxrt_assert.svh"

module voxrt_rays
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes        = 1,
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter bit          Light        = 1'b0,
  parameter bit          Lod          = 1'b0,
  parameter bit          Strips       = 1'b0,  // Rays in strips, not line by line.
  parameter int unsigned RayClocks    = 1
) (
  input  logic                           clk_i,
  input  logic                           rst_ni,
  // Frame; see voxrt_ray_generator and voxrt_ray_setup.
  input  raster_t                        raster_i,
  input  world_t                         world_i,
  input  logic                           root_leaf_i,
  input  material_t                      root_material_i,
  input  logic        [LodScaleBits-1:0] lod_scale_i,
  // Lanes that have a credit (with many lanes, in the next clock); the lane that a ray is issued to, which takes one.
  input  logic        [       Lanes-1:0] credit_i,
  output logic        [       Lanes-1:0] issue_o,          // One-hot or 0.
  // Shadow rays, from voxrt_light.
  input  logic                           shadow_valid_i,
  input  logic        [       Lanes-1:0] shadow_lane_i,    // One-hot.
  input  shadow_ray_t                    shadow_ray_i,
  // Rays of voxrt_ray_setup.
  output logic                           valid_o,
  output logic        [       Lanes-1:0] lane_o,
  output logic                           overflow_o,
  output ray_t                           ray_o,
  output weights_t                       weights_o
);
  logic direction_valid, setup_ready, issues;
  logic signed [ScanBits-1:0] direction[3], ray_direction[3];
  logic [Lanes-1:0] next_lane_q;  // One-hot.

  if (many_lanes(Lanes)) begin : gen_lanes
    // Whether the next lane has a credit. It is found a clock earlier, because credits come over long wires.
    logic [Lanes-1:0] lane_after;
    logic granted_q;

    assign lane_after = {next_lane_q[Lanes-2:0], next_lane_q[Lanes-1]};

    always_ff @(posedge clk_i) begin
      granted_q <= rst_ni && (issues ? (credit_i & lane_after) != '0 : (credit_i & next_lane_q) != '0);
    end

    assign issues = direction_valid && setup_ready && granted_q && !shadow_valid_i;
  end else begin : gen_few_lanes
    assign issues = direction_valid && setup_ready && (credit_i & next_lane_q) != '0 && !shadow_valid_i;
  end

  assign issue_o = issues ? next_lane_q : '0;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      ray_direction[a] = shadow_valid_i ? shadow_ray_i.direction[a] : direction[a];
    end
  end

  always_ff @(posedge clk_i) begin
    if (issues) next_lane_q <= Lanes'({next_lane_q, next_lane_q[Lanes-1]});
    if (!rst_ni || raster_i.start) next_lane_q <= Lanes'(1);
  end

  if (Strips) begin : gen_strips
    voxrt_strip_generator #(
      .Lanes(Lanes)
    ) u_ray_generator (
      .clk_i,
      .rst_ni,
      .raster_i,
      .valid_o    (direction_valid),
      .ready_i    (issues),
      .direction_o(direction)
    );
  end else begin : gen_lines
    logic unused_first, unused_line_end, unused_last;

    voxrt_ray_generator u_ray_generator (
      .clk_i,
      .rst_ni,
      .raster_i,
      .valid_o    (direction_valid),
      .ready_i    (issues),
      .direction_o(direction),
      .first_o    (unused_first),
      .line_end_o (unused_line_end),
      .last_o     (unused_last)
    );
  end

  if (RayClocks == 8) begin : gen_serial
    logic unused;
    assign unused = &{lod_scale_i, shadow_lane_i, shadow_ray_i};

    voxrt_serial_ray_setup #(
      .MaxDepth    (MaxDepth),
      .PositionBits(PositionBits),
      .Lanes       (Lanes)
    ) u_ray_setup (
      .clk_i,
      .rst_ni,
      .world_i,
      .root_leaf_i,
      .root_material_i,
      .valid_i    (issues),
      .ready_o    (setup_ready),
      .lane_i     (next_lane_q),
      .direction_i(ray_direction),
      .valid_o,
      .lane_o,
      .overflow_o,
      .ray_o,
      .weights_o
    );
  end else begin : gen_pipeline
    voxrt_ray_setup #(
      .MaxDepth    (MaxDepth),
      .PositionBits(PositionBits),
      .Lanes       (Lanes),
      .Light       (Light),
      .Lod         (Lod),
      .RayClocks   (RayClocks)
    ) u_ray_setup (
      .clk_i,
      .rst_ni,
      .world_i,
      .root_leaf_i,
      .root_material_i,
      .lod_scale_i,
      .valid_i    (issues || shadow_valid_i),
      .ready_o    (setup_ready),
      .lane_i     (shadow_valid_i ? shadow_lane_i : next_lane_q),
      .direction_i(ray_direction),
      .shadow_i   (shadow_valid_i),
      .point_i    (shadow_ray_i.point),
      .tag_i      (shadow_ray_i.tag),
      .valid_o,
      .lane_o,
      .overflow_o,
      .ray_o,
      .weights_o
    );
  end

`ifndef SYNTHESIS
  logic [Lanes-1:0] credit_q, credit;

  assign credit = many_lanes(Lanes) ? credit_q : credit_i;  // What the issue of a ray sees.

  always_ff @(posedge clk_i) credit_q <= rst_ni ? credit_i : '0;
`endif
  `VOXRT_ASSERT(NextLaneIsOneHot, $onehot(next_lane_q))
  `VOXRT_ASSERT(IssuedRayHasCredit, (issue_o & ~credit) == '0)
  `VOXRT_ASSERT(RayIsForOneLane, !valid_o || $onehot(lane_o))
endmodule
