// Makes a stream of colours in pixel order of the pixels of the lanes: merge, strip buffer where rays are issued in
// strips, brightness where a feature needs it, shader.
module voxrt_pixels
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes     = 1,
  parameter int unsigned MaxDepth  = 10,
  parameter bit          Light     = 1'b0,
  parameter bit          Mirrors   = 1'b0,
  parameter bit          Strips    = 1'b0,  // See voxrt_rays.
  parameter int unsigned RayClocks = 1
) (
  input  logic                                                             clk_i,
  input  logic                                                             rst_ni,
  // Frame.
  input  raster_t                                                          raster_i,
  input  logic            [                              MaxDepth:0]       side_i,
  input  logic            [                                     2:0][31:0] light_i,
  input  shading_t                                                         shading_i,
  input  material_write_t                                                  material_write_i,
  // From the lanes.
  input  logic            [                               Lanes-1:0]       valid_i,
  output logic            [                               Lanes-1:0]       ready_o,
  input  logic            [                               Lanes-1:0]       lit_i,
  input  logic            [pixel_bits(MaxDepth, Light, Mirrors)-1:0]       pixel_i         [Lanes],
  // Out.
  output logic                                                             pixel_valid_o,
  input  logic                                                             pixel_ready_i,
  output shaded_pixel_t                                                    pixel_o
);
  localparam bit Given = Light || Mirrors;
  localparam int unsigned Width = pixel_bits(MaxDepth, Light, Mirrors);
  localparam int unsigned MergeBits = Width + (Light ? 1 : 0);

  logic [MergeBits-1:0] lane_pixel[Lanes];
  logic [MergeBits-1:0] merged, ordered, registered;
  logic
      merged_valid,
      merged_ready,
      ordered_valid,
      ordered_ready,
      registered_valid,
      registered_ready,
      bright_valid,
      bright_ready;
  pixel_t bright_pixel;
  brightness_t brightness;

  always_comb for (int unsigned i = 0; i < Lanes; i++) lane_pixel[i] = MergeBits'({lit_i[i], pixel_i[i]});

  voxrt_merge #(
    .Lanes(Lanes),
    .Width(MergeBits)
  ) u_merge (
    .clk_i,
    .rst_ni,
    .start_i(raster_i.start),
    .valid_i,
    .ready_o,
    .pixel_i(lane_pixel),
    .valid_o(merged_valid),
    .ready_i(merged_ready),
    .pixel_o(merged)
  );

  if (Strips) begin : gen_strips
    voxrt_strip_buffer #(
      .Lanes(Lanes),
      .Width(MergeBits)
    ) u_strips (
      .clk_i,
      .rst_ni,
      .start_i (raster_i.start),
      .width_i (raster_i.width),
      .height_i(raster_i.height),
      .valid_i (merged_valid),
      .ready_o (merged_ready),
      .pixel_i (merged),
      .valid_o (ordered_valid),
      .ready_i (ordered_ready),
      .pixel_o (ordered)
    );
  end else begin : gen_lines
    assign ordered_valid = merged_valid;
    assign merged_ready  = ordered_ready;
    assign ordered       = merged;
  end

  // With many lanes, the shader's ready is too far from them to reach them in the same clock.
  voxrt_stream_register #(
    .Width    (MergeBits),
    .CutsReady(many_lanes(Lanes))
  ) u_merged (
    .clk_i,
    .rst_ni,
    .valid_i(ordered_valid),
    .ready_o(ordered_ready),
    .data_i (ordered),
    .valid_o(registered_valid),
    .ready_i(registered_ready),
    .data_o (registered)
  );

  if (Given) begin : gen_given
    voxrt_brightness #(
      .MaxDepth(MaxDepth),
      .Light   (Light),
      .Mirrors (Mirrors)
    ) u_brightness (
      .clk_i,
      .rst_ni,
      .side_i,
      .light_i,
      .shading_i,
      .valid_i     (registered_valid),
      .ready_o     (registered_ready),
      .pixel_i     (pixel_t'(registered[$bits(pixel_t)-1:0])),
      .lit_i       (Light && registered[MergeBits-1]),
      .detail_i    (registered[Width-1:$bits(pixel_t)]),
      .valid_o     (bright_valid),
      .ready_i     (bright_ready),
      .pixel_o     (bright_pixel),
      .brightness_o(brightness)
    );
  end else begin : gen_angle
    logic unused_light;
    assign unused_light     = &{side_i, light_i};
    assign bright_pixel     = registered;
    assign bright_valid     = registered_valid;
    assign registered_ready = bright_ready;
    assign brightness       = '0;
  end

  if (RayClocks == 8) begin : gen_serial
    logic unused_brightness;
    assign unused_brightness = ^brightness;

    voxrt_serial_shader u_shader (
      .clk_i,
      .rst_ni,
      .raster_i,
      .shading_i,
      .material_write_i,
      .valid_i(bright_valid),
      .ready_o(bright_ready),
      .pixel_i(bright_pixel),
      .pixel_valid_o,
      .pixel_ready_i,
      .pixel_o
    );
  end else begin : gen_pipeline
    voxrt_shader #(
      .Lanes    (Lanes),
      .Given    (Given),
      .RayClocks(RayClocks)
    ) u_shader (
      .clk_i,
      .rst_ni,
      .raster_i,
      .shading_i,
      .material_write_i,
      .valid_i     (bright_valid),
      .ready_o     (bright_ready),
      .pixel_i     (bright_pixel),
      .brightness_i(brightness),
      .pixel_valid_o,
      .pixel_ready_i,
      .pixel_o
    );
  end
endmodule
