// Schedules the slots of voxrt_lane at stage 9. A ray that is done is reflected, goes to voxrt_hit_point, or retires.
// When a ray goes or retires, a new one is issued to its slot.
//
// Mirrors: a ray that hits one starts again at the root in its slot, with the key of the hit, the mirror bit of that
// axis flipped and the origin moved by 16 (side - 2 plane), so that the plane's T stays; it is in the cell that it
// came from. The root's octant needs no compare: that cell and the one hit differ on the one axis alone.
//
// Light: a camera's ray that hits is taken by voxrt_hit_point, and the slot is free. Its pixel is stored when its hit
// point is known, which goes to voxrt_light; a shadow ray, in 1/32 voxel, comes back with the tag. Whether what it hits
// is before the light is a compare of cells on the axis of the face: T_hit < T_light there says that the plane is before
// the light's coordinate. Another such compare finds back faces, which need neither hit point nor shadow ray.
//
// A ray that voxrt_hit_point has no place for, or that finds voxrt_light without a credit, waits: it goes round without
// reading words, and hits again. It needs no credit where a shadow ray waits for its slot, which gives one back: so
// neither waits for the other for ever.
`include "voxrt_assert.svh"

module voxrt_slot_scheduler
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10,
  parameter int unsigned Slots    = 12,    // Rays in the ring of the lane (lane_slots): 12 .. 15.
  parameter bit          Light    = 1'b0,
  parameter bit          Mirrors  = 1'b0
) (
  input  logic                                                       clk_i,
  input  logic                                                       rst_ni,
  // See voxrt_lane.
  input  logic            [                              MaxDepth:0] side_i,
  input  shading_t                                                   shading_i,
  input  light_planes_t                                              light_planes_i,
  input  material_write_t                                            material_write_i,
  // Which slots are in the stages of the lane, and what their rays are.
  input  logic            [                       $clog2(Slots)-1:0] slot0_i,
  input  logic            [                       $clog2(Slots)-1:0] slot_i           [1:9],
  output ray_modes_t                                                 modes_o,
  // Stages 3 and 8.
  input  material_t                                                  material3_i,
  input  logic            [                            MaxDepth-1:0] corner8_i        [  3],
  input  face_e                                                      key_face8_i,
  // Stage 9: the ray of the slot, the ray that waits, and what becomes of them.
  input  step_t                                                      step_i,
  input  logic                                                       ray_valid_i,
  output logic                                                       ray_ready_o,
  input  ray_t                                                       ray_i,
  output decision_t                                                  decision_o,
  // Reorder buffer, as voxrt_lane says.
  output logic                                                       allocate_o,
  input  logic                                                       allocate_ready_i,
  input  logic            [                             TagBits-1:0] allocate_tag_i,
  output result_t                                                    result_o,
  output logic            [pixel_bits(MaxDepth, Light, Mirrors)-1:0] result_pixel_o,
  // voxrt_hit_point: whether it has a place for the ray at stage 9; the ray is taken. Hit points; voxrt_light's credit.
  input  logic                                                       holds_i,
  output logic                                                       takes_o,
  output hit_point_t                                                 hit_o,
  input  logic                                                       point_valid_i,
  output logic                                                       point_ready_o,
  input  hit_point_t                                                 point_i,
  input  material_t                                                  point_material_i,
  input  logic                                                       hit_point_ready_i
);
  if (Slots < 12 || Slots > 15) $error("voxrt_slot_scheduler: Slots must be 12 to 15");

  localparam int unsigned PointBits = MaxDepth + FractionBits;
  localparam int unsigned DetailBits = detail_bits(MaxDepth, Light, Mirrors);

  logic [TagBits-1:0] tag_q[Slots];
  face_e face;  // FaceNone without material.
  logic hits_face, reflects, escapes, shows_mean, is_lightable, asks, takes, retires;
  logic shadow9, backface, stores_point;
  logic keeps, issues, bypasses, allocatable;
  logic [2:0] set;
  pixel_t pixel;
  shade_e shade;
  mirrors_t mirrors;

  assign face = step_i.material == '0 ? FaceNone : step_i.key_face;
  assign hits_face = step_i.done && face != FaceNone && !shadow9;
  assign is_lightable = Light && hits_face && shading_i.light && !reflects && !escapes && !shows_mean;
  assign asks = is_lightable && !backface;
  assign takes = asks && holds_i && (hit_point_ready_i || (ray_valid_i && ray_i.shadow && !ray_i.resolved));
  assign retires = step_i.done && !reflects && !asks;
  assign keeps = (step_i.continues || (step_i.done && (reflects || asks))) && !takes;

  // A shadow ray has an entry in the reorder buffer already.
  assign allocatable = ray_i.shadow || allocate_ready_i;
  assign issues = ray_valid_i && !ray_i.resolved && allocatable && !keeps;
  assign bypasses = ray_valid_i && ray_i.resolved && allocatable && !step_i.done && !stores_point;
  assign ray_ready_o = issues || bypasses;
  assign allocate_o = ray_ready_o && !ray_i.shadow;

  assign decision_o.issues = issues;
  assign decision_o.bypasses = bypasses;
  assign decision_o.reflects = reflects;
  assign decision_o.keeps = keeps;
  assign decision_o.set = set;

  always_ff @(posedge clk_i) if (issues) tag_q[slot_i[9]] <= ray_i.shadow ? ray_i.tag : allocate_tag_i;

  // A hit point waits for the port of the reorder buffer while rays retire.
  assign point_ready_o     = Light && !retires;
  assign stores_point      = Light && point_valid_i && !retires;

  // Pixels. That of a shadow ray is stored already.
  assign result_o.complete = retires || bypasses;
  assign result_o.store    = (retires && !shadow9) || (bypasses && !ray_i.shadow) || stores_point;

  always_comb begin
    result_o.tag = step_i.done ? tag_q[slot_i[9]] : ray_i.shadow ? ray_i.tag : allocate_tag_i;
    if (stores_point) result_o.tag = point_i.tag;
  end

  always_comb begin
    pixel = '{material: step_i.material, face: face};
    if (escapes) pixel = '{material: '0, face: FaceNone};
    if (!step_i.done) pixel = ray_i.pixel;
    if (stores_point) pixel = '{material: point_material_i, face: point_i.face};
    shade = stores_point || is_lightable ? ShadeLight : shows_mean ? ShadeMean : ShadeAngle;
  end

  if (Light || Mirrors) begin : gen_detail
    logic [DetailBits-3:0] payload;

    always_comb begin
      payload = (DetailBits - 2)'(step_i.mirrored);
      if (Light) begin
        payload = (DetailBits - 2)'({
          stores_point ? point_i.mirrored : step_i.mirrored,
          point_i.point[2][PointBits-1:0],
          point_i.point[1][PointBits-1:0],
          point_i.point[0][PointBits-1:0]
        });
      end
      if (Mirrors && shows_mean && !stores_point) payload = (DetailBits - 2)'(mirrors);
    end

    assign result_pixel_o = {shade, payload, pixel};
  end else begin : gen_no_detail
    logic unused_shade;
    assign unused_shade   = &{shade, mirrors};
    assign result_pixel_o = pixel;
  end

  // The mirror image of a ray.
  if (Mirrors) begin : gen_mirrors
    logic reflects_here, outermost_q;
    logic signed [MaxDepth+1:0] shift_q;
    logic [MaxDepth-1:0] plane8;
    logic unused_slots;

    assign unused_slots = &{slot_i[1], slot_i[2], slot_i[3], slot_i[4], slot_i[5], slot_i[6], slot_i[8]};

    always_comb begin
      unique case (key_face8_i)
        FaceX:   plane8 = corner8_i[0];
        FaceY:   plane8 = corner8_i[1];
        default: plane8 = corner8_i[2];
      endcase
    end

    always_ff @(posedge clk_i) begin
      shift_q     <= {1'b0, side_i} - {1'b0, plane8, 1'b0};
      outermost_q <= plane8 == '0;  // A side of the world: where the ray came from there is nothing.
    end

    voxrt_reflect #(
      .Slots(Slots)
    ) u_reflect (
      .clk_i,
      .bounces_i (shading_i.bounces),
      .material_write_i,
      .material_i(material3_i),
      .slot7_i   (slot_i[7]),
      .slot9_i   (slot_i[9]),
      .hit_i     (hits_face),
      .issues_i  (issues),
      .reflects_o(reflects_here),
      .ends_o    (shows_mean),
      .mirrors_o (mirrors)
    );

    assign reflects         = reflects_here && !outermost_q;
    assign escapes          = reflects_here && outermost_q;
    assign decision_o.shift = (DepthLimit + 2)'(shift_q);

    // The root's octant in which the ray starts again.
    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        decision_o.mirrored[a] = step_i.mirrored[a] ^ (reflects && step_i.key_face == 2'(a));
        set[a]                 = step_i.set[a];
        if (reflects) begin
          set[a] = (step_i.corner[a][MaxDepth-1:0] & side_i[MaxDepth:1]) != '0;
          if (step_i.key_face == 2'(a)) set[a] = !shift_q[MaxDepth+1];
        end
      end
    end
  end else begin : gen_no_mirrors
    logic unused_mirrors;
    assign unused_mirrors = &{material_write_i, mirrors, material3_i, corner8_i[0], corner8_i[1], corner8_i[2],
                              key_face8_i, side_i, slot_i[1], slot_i[2], slot_i[3], slot_i[4], slot_i[5], slot_i[6],
                              slot_i[7], slot_i[8]};
    assign {reflects, escapes, shows_mean} = '0;
    assign decision_o.shift = '0;
    assign decision_o.mirrored = step_i.mirrored;
    assign mirrors = '0;
    assign set = step_i.set;
  end

  // Hit points, and the results of shadow rays.
  if (Light) begin : gen_light
    logic waits_q[Slots];
    logic shadow_q[Slots];
    material_t material_q[Slots];  // What a ray that waits has hit.
    logic shadow3_q, occluded;

    assign modes_o.waits0    = waits_q[slot0_i];
    assign modes_o.waits2    = waits_q[slot_i[2]];
    assign modes_o.material2 = material_q[slot_i[2]];
    assign modes_o.shadow1   = shadow_q[slot_i[1]];
    assign modes_o.shadow2   = shadow_q[slot_i[2]];
    assign modes_o.shadow3   = shadow3_q;
    assign shadow9           = shadow_q[slot_i[9]];

    always_ff @(posedge clk_i) begin
      if (issues || asks) waits_q[slot_i[9]] <= !issues;
      if (issues) shadow_q[slot_i[9]] <= ray_i.shadow;
      if (asks) material_q[slot_i[9]] <= step_i.material;
      shadow3_q <= modes_o.shadow2;
    end

    // The compare says of a shadow ray that its hit is before the light, and of another ray that it hit a back face.
    always_comb begin
      occluded = face == FaceNone;
      backface = 1'b0;
      for (int unsigned a = 0; a < 3; a++) begin
        if (face == 2'(a)) begin
          occluded = {1'b0, step_i.corner[a][MaxDepth-1:0]} <
              light_planes_i.occluder[step_i.mirrored[a]][a][MaxDepth:0];
          backface = {1'b0, step_i.corner[a][MaxDepth-1:0]} <
              light_planes_i.backface[step_i.mirrored[a]][a][MaxDepth:0];
        end
        hit_o.point[a] = PointLimit'(step_i.corner[a]) << FractionBits;
      end
    end

    assign result_o.lit   = step_i.done ? shadow9 && (step_i.material == '0 || !occluded) : ray_i.lit;
    assign takes_o        = takes;
    assign hit_o.tag      = tag_q[slot_i[9]];
    assign hit_o.face     = step_i.key_face;
    assign hit_o.mirrored = step_i.mirrored;
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light = &{slot0_i, takes, holds_i, point_valid_i, point_i, point_material_i, hit_point_ready_i,
                            light_planes_i, step_i.corner};
    assign {modes_o, shadow9, backface} = '0;
    assign result_o.lit = 1'b0;
    assign takes_o = 1'b0;
    assign hit_o = '0;
  end

  `VOXRT_ASSERT(RayIsDoneOrContinues, !(step_i.done && step_i.continues))
  `VOXRT_ASSERT(RayIsIssuedOrBypasses, !(issues && bypasses))
  `VOXRT_ASSERT(SlotHasOneRay, !(issues && keeps))
  `VOXRT_ASSERT(AllocatedEntryWasFree, !allocate_o || allocate_ready_i)
endmodule
