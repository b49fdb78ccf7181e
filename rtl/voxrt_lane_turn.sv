// Who has a slot of voxrt_lane next: stage 9. A ray that finishes is reflected, goes on to its sub-cell, or ends; where one
// ends or asks for a shadow ray, a new ray starts.
//
// Mirrors: a ray that hits one starts anew at the root in its slot, with the key of the hit, the mirror bit of that axis
// flipped and the origin moved by 16 (side - 2 plane), so that the plane's T stays; it stands in the cell that it came
// from. The root's octant needs no compare: that cell and the one hit differ on the one axis alone.
//
// Light: a camera's ray that hits goes on with its descent, by the same compares, to the sub-cell of 1/16 voxel ("sinks").
// The sub-cell leaves for voxrt_light; the slot is free. A shadow ray, in 1/32 voxel, comes back with the tag. Whether what
// it hits is before the light is a compare of cells on the axis of the face: T_hit < T_light there says that the plane
// is before the light's coordinate. Another such compare finds faces that are turned away from the light, whose rays
// need neither sub-cell nor shadow ray.
// A ray whose sub-cell finds voxrt_light's queue full asks again at its next turn, and changes places with a shadow ray if
// one waits: so neither waits for the other for ever.
module voxrt_lane_turn
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth   = 10,
  parameter  int unsigned TagBits    = 8,
  parameter  int unsigned Slots      = 11,
  parameter  bit          Light      = 1'b0,
  parameter  bit          Mirrors    = 1'b0,
  localparam int unsigned SlotBits   = $clog2(Slots),
  localparam int unsigned SubBits    = Light ? FractionBits : 0,
  localparam int unsigned CellBits   = MaxDepth + SubBits,
  localparam int unsigned PlaceBits  = MaxDepth + FractionBits,
  localparam int unsigned DetailBits = detail_bits(MaxDepth, Light, Mirrors),
  localparam int unsigned Width      = pixel_bits(MaxDepth, Light, Mirrors)
) (
  input  logic                       clk_i,
  // As voxrt_lane has them.
  input  logic        [  MaxDepth:0] world_i,
  input  logic                       light_i,
  input  logic        [BounceBits-1:0] bounces_i,
  input  logic        [  MaxDepth:0] before_light_i     [2][3],
  input  logic        [  MaxDepth:0] to_light_i         [2][3],
  input  logic                       table_write_i,
  input  material_t                  table_material_i,
  input  row_t                       table_row_i,
  // Which slots are in the lane's stages, and what their rays are.
  input  logic        [SlotBits-1:0] slot0_i,
  input  logic        [SlotBits-1:0] slot_i             [1:9],
  output logic                       sinks0_o,
  output logic                       shadow1_o,
  output logic                       sinks2_o,
  output logic                       shadow2_o,
  output logic                       sinks3_o,
  // Stages 3 and 8.
  input  material_t                  material3_i,
  input  logic        [CellBits-1:0] corner8_i          [3],
  input  face_e                      key_face8_i,
  // Stage 9: the ray at hand.
  input  logic                       active_i,
  input  logic                       finishes_i,
  input  material_t                  material_i,
  input  face_e                      key_face_i,
  input  logic        [         2:0] mirrored_i,
  input  logic        [CellBits-1:0] corner_i           [3],
  input  logic        [         2:0] set_i,                   // What the corner gets, in the next size.
  input  logic                       smallest_i,              // That is the least size there is.
  // The ray that waits.
  input  logic                       ray_valid_i,
  output logic                       ray_ready_o,
  input  logic                       ray_resolved_i,
  input  pixel_t                     ray_pixel_i,
  input  logic                       ray_shadow_i,
  input  logic        [ TagBits-1:0] ray_tag_i,
  input  logic                       ray_lit_i,
  // What becomes of the slot.
  output logic                       starts_o,                // The ray that waited starts.
  output logic                       reflects_o,              // The ray at hand does, anew.
  output logic                       continues_o,             // The slot keeps its ray.
  output logic                       resolves_o,              // The ray that waited has its answer, and needs no slot.
  output logic signed [MaxDepth+1:0] shift_o,                 // Of a reflected ray: side - 2 plane ...
  output logic        [         2:0] mirrored_o,              // ... and its frame.
  output logic        [         2:0] set_o,                   // Of a reflected ray: the root's octant; else set_i.
  // Pixel buffer and voxrt_light, as voxrt_lane says.
  output logic                       take_o,
  input  logic                       take_ready_i,
  input  logic        [ TagBits-1:0] take_tag_i,
  output logic                       fill_o,
  output logic        [ TagBits-1:0] fill_tag_o,
  output logic                       fill_lit_o,
  output logic                       store_o,
  output logic        [   Width-1:0] store_pixel_o,
  output logic                       request_o,
  input  logic                       request_ready_i,
  output logic        [ TagBits-1:0] request_tag_o,
  output face_e                      request_face_o,
  output logic        [         2:0] request_mirrored_o,
  output logic        [PlaceBits-1:0] request_place_o   [3]
);
  logic [TagBits-1:0] tag_q[Slots];
  face_e              face;  // FaceNone without material.
  logic               finishes, meets_face, reflects_out, shows_mean, is_lightable, sinks, requests, ends;
  logic               sinks9, shadow9, turned_away;
  pixel_t             pixel;
  material_t          sinking_material;
  shade_e             shade;
  mirrors_t           met;

  assign face         = material_i == '0 ? FaceNone : key_face_i;
  assign finishes     = active_i && finishes_i;
  assign meets_face   = finishes && face != FaceNone && !shadow9;
  assign is_lightable = Light && meets_face && light_i && !reflects_o && !reflects_out && !shows_mean;
  assign sinks        = is_lightable && !turned_away;
  assign requests     = Light && active_i && sinks9 && smallest_i &&
      (request_ready_i || (ray_valid_i && ray_shadow_i && !ray_resolved_i));
  assign ends         = finishes && !reflects_o && !sinks;
  assign continues_o  = active_i && !ends && !requests;

  assign starts_o = ray_valid_i && !ray_resolved_i && (ray_shadow_i || take_ready_i) && !continues_o;
  assign resolves_o = ray_valid_i && ray_resolved_i && (ray_shadow_i || take_ready_i) && !finishes && !requests;

  assign ray_ready_o = starts_o || resolves_o;
  assign take_o      = ray_ready_o && !ray_shadow_i;

  always_ff @(posedge clk_i) if (starts_o) tag_q[slot_i[9]] <= ray_shadow_i ? ray_tag_i : take_tag_i;

  // Pixels. A shadow ray has its own stored already.
  assign fill_o     = ends || resolves_o;
  assign fill_tag_o = finishes || requests ? tag_q[slot_i[9]] : ray_shadow_i ? ray_tag_i : take_tag_i;
  assign store_o    = (ends && !shadow9) || (resolves_o && !ray_shadow_i) || requests;

  always_comb begin
    pixel = '{material: material_i, face: face};
    if (reflects_out) pixel = '{material: '0, face: FaceNone};
    if (requests) pixel = '{material: sinking_material, face: key_face_i};
    else if (!finishes) pixel = ray_pixel_i;
    shade = requests || is_lightable ? ShadeLight : shows_mean ? ShadeMean : ShadeAngle;
  end

  if (Light || Mirrors) begin : gen_detail
    logic [DetailBits-3:0] payload;

    always_comb begin
      payload = '0;
      if (Mirrors) payload = (DetailBits - 2)'(met);
      if (Light && requests) begin
        payload = (DetailBits - 2)'({mirrored_i, request_place_o[2], request_place_o[1], request_place_o[0]});
      end
    end

    assign store_pixel_o = {shade, payload, pixel};
  end else begin : gen_no_detail
    logic unused_shade;
    assign unused_shade  = &{shade, met, slot_i[1], slot_i[2], slot_i[3], slot_i[4], slot_i[5], slot_i[6], slot_i[7], slot_i[8]};
    assign store_pixel_o = pixel;
  end

  // The mirror image of a ray.
  if (Mirrors) begin : gen_mirrors
    logic                       reflects_here, outward_q;
    logic signed [MaxDepth+1:0] shift_q;
    logic        [MaxDepth-1:0] plane8;

    always_comb begin
      unique case (key_face8_i)
        FaceX:   plane8 = corner8_i[0][CellBits-1:SubBits];
        FaceY:   plane8 = corner8_i[1][CellBits-1:SubBits];
        default: plane8 = corner8_i[2][CellBits-1:SubBits];
      endcase
    end

    always_ff @(posedge clk_i) begin
      shift_q   <= {1'b0, world_i} - {1'b0, plane8, 1'b0};
      outward_q <= plane8 == '0;  // The world's own side: back where the ray came from there is nothing.
    end

    voxrt_reflect #(
      .Slots(Slots)
    ) u_reflect (
      .clk_i,
      .bounces_i,
      .table_write_i,
      .table_material_i,
      .table_row_i,
      .material_i(material3_i),
      .slot7_i   (slot_i[7]),
      .slot9_i   (slot_i[9]),
      .hit_i     (meets_face),
      .starts_i  (starts_o),
      .reflects_o(reflects_here),
      .ends_o    (shows_mean),
      .met_o     (met)
    );

    assign reflects_o   = reflects_here && !outward_q;
    assign reflects_out = reflects_here && outward_q;
    assign shift_o      = shift_q;

    // The root's octant in which the ray goes on.
    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        mirrored_o[a] = mirrored_i[a] ^ (reflects_o && key_face_i == 2'(a));
        set_o[a]      = set_i[a];
        if (reflects_o) begin
          set_o[a] = (corner_i[a][CellBits-1:SubBits] & world_i[MaxDepth:1]) != '0;
          if (key_face_i == 2'(a)) set_o[a] = !shift_q[MaxDepth+1];
        end
      end
    end
  end else begin : gen_no_mirrors
    logic unused_mirrors;
    assign unused_mirrors = &{table_write_i, table_material_i, table_row_i, bounces_i, met, key_face_i, material3_i,
                              corner8_i[0], corner8_i[1], corner8_i[2], key_face8_i, world_i};
    assign {reflects_o, reflects_out, shows_mean} = '0;
    assign shift_o    = '0;
    assign met        = '0;
    assign mirrored_o = mirrored_i;
    assign set_o      = set_i;
  end

  // Down to the sub-cell, and the answers of shadow rays.
  if (Light) begin : gen_light
    logic              sinks_q   [Slots];
    logic              shadow_q  [Slots];
    material_t         material_q[Slots];  // That a ray has hit.
    logic              in_shadow;

    assign sinks0_o  = sinks_q[slot0_i];
    assign sinks2_o  = sinks_q[slot_i[2]];
    assign sinks3_o  = sinks_q[slot_i[3]];
    assign sinks9    = sinks_q[slot_i[9]];
    assign shadow1_o = shadow_q[slot_i[1]];
    assign shadow2_o = shadow_q[slot_i[2]];
    assign shadow9   = shadow_q[slot_i[9]];

    always_ff @(posedge clk_i) begin
      if (starts_o || sinks) sinks_q[slot_i[9]] <= !starts_o;
      if (starts_o) shadow_q[slot_i[9]] <= ray_shadow_i;
      if (sinks) material_q[slot_i[9]] <= material_i;
    end

    assign sinking_material = material_q[slot_i[9]];

    // Of a shadow ray: what it hits is before the light. Of another: the light is not in front of the face.
    always_comb begin
      in_shadow   = face == FaceNone;
      turned_away = 1'b0;
      for (int unsigned a = 0; a < 3; a++) begin
        if (face == 2'(a)) begin
          in_shadow   = {1'b0, corner_i[a][CellBits-1:SubBits]} < before_light_i[mirrored_i[a]][a];
          turned_away = {1'b0, corner_i[a][CellBits-1:SubBits]} < to_light_i[mirrored_i[a]][a];
        end
        request_place_o[a] = corner_i[a] | CellBits'(set_i[a]);
      end
    end

    assign fill_lit_o         = finishes ? shadow9 && (material_i == '0 || !in_shadow) : ray_lit_i;
    assign request_o          = requests;
    assign request_tag_o      = tag_q[slot_i[9]];
    assign request_face_o     = key_face_i;
    assign request_mirrored_o = mirrored_i;
  end else begin : gen_no_light
    logic unused_light;
    assign unused_light = &{slot0_i, corner_i[0], corner_i[1], corner_i[2], request_ready_i, ray_lit_i, light_i, before_light_i[0][0], before_light_i[0][1],
                            before_light_i[0][2], before_light_i[1][0], before_light_i[1][1], before_light_i[1][2],
                            to_light_i[0][0], to_light_i[0][1], to_light_i[0][2], to_light_i[1][0], to_light_i[1][1],
                            to_light_i[1][2]};
    assign {sinks0_o, sinks2_o, sinks3_o, sinks9, shadow1_o, shadow2_o, shadow9, turned_away} = '0;
    assign sinking_material   = '0;
    assign fill_lit_o         = 1'b0;
    assign request_o          = 1'b0;
    assign request_tag_o      = '0;
    assign request_face_o     = FaceNone;
    assign request_mirrored_o = '0;
    assign request_place_o    = '{default: '0};
  end
endmodule
