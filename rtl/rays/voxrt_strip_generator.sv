// Directions of a frame's pixels in strips, by additions alone, in the order of voxrt_strip_place: strips of 16 lines or
// fewer (voxrt_pkg::strip_line_bits), in columns, of which those of the right and of the left half take turns. Columns
// that come after each other in a half are neighbours in the picture, and read the same parts of the octree. Halves take
// turns because what is shown stands in the middle: while the columns of one half cross it, those of the other cross
// what is beside it, which takes less time. So lanes and external memory have work all the time.
//
// It is used as voxrt_ray_generator is, but the first direction comes width / 2 clocks later.
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
  logic valid_q, advances;
  logic signed [ScanBits-1:0] direction_q[3], top_q[3], right[3], down[3], beside[3];
  logic signed [ScanBits-1:0] other_q[3];  // The top of the other half's next column.
  strip_place_t place;

  assign advances = valid_q && ready_i;

  voxrt_strip_place #(
    .Lanes(Lanes)
  ) u_place (
    .clk_i,
    .start_i   (raster_i.start),
    .width_i   (raster_i.width),
    .height_i  (raster_i.height),
    .advances_i(advances),
    .place_o   (place)
  );

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      right[a]  = ScanBits'($signed(raster_i.right[a]));
      down[a]   = direction_q[a] + $signed(raster_i.line_step[a]);
      beside[a] = place.leftwards ? top_q[a] - right[a] : top_q[a] + right[a];
    end
  end

  // The right half begins so many columns beside the corner.
  logic walks_q;
  logic [SizeBits-2:0] columns_q;

  always_ff @(posedge clk_i) begin
    if (walks_q) begin
      top_q     <= columns_q == '0 ? top_q : beside;
      columns_q <= columns_q - 1'b1;
      if (columns_q == '0) begin
        direction_q <= top_q;
        valid_q     <= 1'b1;
        walks_q     <= 1'b0;
      end
    end
    if (advances) begin
      direction_q <= down;
      if (place.last_line) begin
        if (place.last_column) begin
          // The next strip begins below.
          top_q <= down;
          if (place.last_strip) valid_q <= 1'b0;
        end else begin
          direction_q <= other_q;
          top_q       <= other_q;
          other_q     <= place.last_of_half ? down : beside;
        end
      end
    end
    if (raster_i.corner) begin
      // Line_step is the corner's direction, and the step of lines from two clocks later on.
      for (int unsigned a = 0; a < 3; a++) begin
        top_q[a]   <= $signed(raster_i.line_step[a]);
        other_q[a] <= $signed(raster_i.line_step[a]);
      end
      columns_q <= raster_i.width[SizeBits-1:1];
      walks_q   <= 1'b1;
    end
    if (!rst_ni || raster_i.start) begin
      walks_q <= 1'b0;
      valid_q <= 1'b0;
    end
  end

  assign valid_o     = valid_q;
  assign direction_o = direction_q;
endmodule
