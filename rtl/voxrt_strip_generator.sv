// Directions of a frame's pixels in strips, by additions alone: strips of 16 lines or fewer (voxrt_pkg::strip_line_bits)
// from the top; in each, columns from the left, from the top down. The last strip may have fewer lines. Neighbours in
// this order are neighbours in the picture, and read the same parts of the octree.
//
// It is used as voxrt_ray_generator is.
module voxrt_strip_generator
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes = 1
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  raster_t                    raster_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output logic signed [ScanBits-1:0] direction_o[3]
);
  logic                       corner_q, valid_q, advances, column_end, last_column;
  logic signed [ScanBits-1:0] direction_q[3], top_q[3], strip_q[3], down[3], beside[3];
  logic                       new_column, new_strip, last;
  strip_place_t               place;

  voxrt_strip_place #(
    .Lanes(Lanes)
  ) u_place (
    .clk_i,
    .start_i     (raster_i.start),
    .width_i     (raster_i.width),
    .height_i    (raster_i.height),
    .advances_i  (valid_q && ready_i),
    .by_lines_i  (1'b0),
    .place_o     (place)
  );

  assign advances    = valid_q && ready_i;
  assign column_end  = place.last_line;
  assign last_column = place.last_column;
  assign new_strip   = column_end && last_column;
  assign new_column  = column_end && !last_column;
  assign last        = new_strip && place.last_strip;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      down[a]   = direction_q[a] + $signed(raster_i.line_step[a]);
      beside[a] = top_q[a] + ScanBits'($signed(raster_i.right[a]));
    end
  end

  always_ff @(posedge clk_i) begin
    if (advances) begin
      direction_q <= new_strip ? (place.first_column ? down : strip_q) : new_column ? beside : down;
      if (new_strip) top_q <= place.first_column ? down : strip_q;
      if (new_column) top_q <= beside;
      // Below the first column begins the next strip.
      if (place.first_column) strip_q <= down;
      if (last) valid_q <= 1'b0;
    end
    if (raster_i.corner) begin
      // The first direction is line_step.
      for (int unsigned a = 0; a < 3; a++) begin
        direction_q[a] <= $signed(raster_i.line_step[a]);
        top_q[a]       <= $signed(raster_i.line_step[a]);
      end
    end
    // Line_step is the step of lines from here on.
    corner_q <= raster_i.corner && rst_ni;
    if (corner_q) valid_q <= 1'b1;
    if (!rst_ni || raster_i.start) valid_q <= 1'b0;
  end

  assign valid_o     = valid_q;
  assign direction_o = direction_q;
endmodule
