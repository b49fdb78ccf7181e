// From the tracks' pixels to colours in pixel order: merge, brightness where a feature needs it, shader.
module voxrt_pixels
  import voxrt_pkg::*;
#(
  parameter  int unsigned Lanes      = 1,
  parameter  int unsigned MaxDepth   = 10,
  parameter  bit          Flat       = 1'b0,
  parameter  bit          Light      = 1'b0,
  parameter  bit          Mirrors    = 1'b0,
  localparam int unsigned Width      = pixel_bits(MaxDepth, Light, Mirrors),
  localparam int unsigned LightBits  = light_bits(MaxDepth)
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  // Frame.
  input  logic                         start_i,
  input  logic                         corner_i,
  input  logic signed [  ScanBits-1:0] line_step_i[3],
  input  logic signed [CameraBits-1:0] right_i   [3],
  input  logic        [  SizeBits-1:0] width_i,
  input  logic        [  SizeBits-1:0] height_i,
  input  logic        [    MaxDepth:0] world_i,
  input  logic signed [ LightBits-1:0] light_i   [3],
  input  logic                         flat_i,
  input  logic        [           7:0] ambient_i,
  // Material table.
  input  logic                         table_write_i,
  input  material_t                    table_material_i,
  input  colour_t                      table_colour_i,
  // From the tracks.
  input  logic        [     Lanes-1:0] valid_i,
  output logic        [     Lanes-1:0] ready_o,
  input  logic        [     Lanes-1:0] lit_i,
  input  logic        [     Width-1:0] pixel_i   [Lanes],
  // Out.
  output logic                         out_valid_o,
  input  logic                         out_ready_i,
  output colour_t                      out_colour_o,
  output pixel_t                       out_pixel_o,
  output logic                         out_first_o,
  output logic                         out_line_end_o,
  output logic                         out_last_o
);
  localparam bit Given = Light || Mirrors;
  localparam int unsigned MergeBits = Width + (Light ? 1 : 0);

  logic    [MergeBits-1:0] tracks[Lanes];
  logic    [MergeBits-1:0] merged;
  logic    [MergeBits-1:0] chosen;
  logic                    chosen_valid, chosen_ready, merged_valid, merged_ready, shaded_valid, shaded_ready;
  pixel_t                  shaded;
  brightness_t             brightness;

  voxrt_merge #(
    .Lanes(Lanes),
    .Width(MergeBits)
  ) u_merge (
    .clk_i,
    .rst_ni,
    .start_i,
    .valid_i,
    .ready_o,
    .pixel_i(tracks),
    .valid_o(chosen_valid),
    .ready_i(chosen_ready),
    .pixel_o(chosen)
  );

  voxrt_stream_register #(
    .Width(MergeBits)
  ) u_merged (
    .clk_i,
    .rst_ni,
    .valid_i(chosen_valid),
    .ready_o(chosen_ready),
    .data_i (chosen),
    .valid_o(merged_valid),
    .ready_i(merged_ready),
    .data_o (merged)
  );

  always_comb for (int unsigned i = 0; i < Lanes; i++) tracks[i] = MergeBits'({lit_i[i], pixel_i[i]});

  if (Given) begin : gen_given
    voxrt_brightness #(
      .MaxDepth(MaxDepth),
      .Light   (Light),
      .Mirrors (Mirrors)
    ) u_brightness (
      .clk_i,
      .rst_ni,
      .world_i,
      .light_i,
      .flat_i      (flat_i),
      .ambient_i   (ambient_i),
      .valid_i     (merged_valid),
      .ready_o     (merged_ready),
      .pixel_i     (pixel_t'(merged[$bits(pixel_t)-1:0])),
      .lit_i       (Light && merged[MergeBits-1]),
      .detail_i    (merged[Width-1:$bits(pixel_t)]),
      .valid_o     (shaded_valid),
      .ready_i     (shaded_ready),
      .pixel_o     (shaded),
      .brightness_o(brightness)
    );
  end else begin : gen_angle
    logic unused_detail;
    assign unused_detail = &{world_i, light_i[0], light_i[1], light_i[2], ambient_i};
    assign shaded       = merged;
    assign shaded_valid = merged_valid;
    assign merged_ready = shaded_ready;
    assign brightness   = '0;
  end

  voxrt_shader #(
    .Flat (Flat),
    .Given(Given)
  ) u_shader (
    .clk_i,
    .rst_ni,
    .start_i,
    .corner_i,
    .line_step_i,
    .right_i,
    .width_i,
    .height_i,
    .table_write_i,
    .table_material_i,
    .table_colour_i,
    .valid_i       (shaded_valid),
    .ready_o       (shaded_ready),
    .pixel_i       (shaded),
    .brightness_i  (brightness),
    .flat_i        (flat_i),
    .valid_o       (out_valid_o),
    .ready_i       (out_ready_i),
    .colour_o      (out_colour_o),
    .pixel_o       (out_pixel_o),
    .first_o       (out_first_o),
    .line_end_o    (out_line_end_o),
    .last_o        (out_last_o)
  );
endmodule
