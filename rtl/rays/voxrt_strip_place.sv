// Walks the pixels of a frame strip by strip, for cores with caches: pixels that follow each other are then neighbours,
// whose rays read the same lines of the octree. voxrt_strip_generator walks so when it issues rays, voxrt_strip_buffer
// when it puts the pixels back into lines. Strips have 2**strip_line_bits(Lanes, width) lines, the last one what is
// left. The order in a strip is
//
//   ByLines      line by line, each from the left
//   otherwise    column by column, each from the top down. Columns of the right and of the left half of the picture take
//                turns: the first of the right half, the first of the left half, the second of the right half, and so
//                on. The right half has one more where the width is odd. Every second strip goes the opposite way, so
//                that a strip begins below the column in which the strip above it ended.
//
// Both give one pixel one address.
module voxrt_strip_place
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes   = 1,
  parameter bit          ByLines = 1'b0  // The order, see above.
) (
  input  logic                        clk_i,
  input  logic                        start_i,     // To the first pixel. Width and height are held from here on.
  input  logic         [SizeBits-1:0] width_i,
  input  logic         [SizeBits-1:0] height_i,
  input  logic                        advances_i,
  output strip_place_t                place_o
);
  logic [StripLineLimit-1:0] line_q, strip_end;  // Counted in the strip.
  logic [SizeBits-1:0] first_line_q, lines_left;  // The strip's first line in the frame, and the lines from there on.
  logic [SizeBits-2:0] column_q;  // Counted in its half.
  logic right_half_q, leftwards_q;
  logic last_line, last_of_half, last_column, last_strip;
  logic [2:0] line_bits;

  assign line_bits  = strip_line_bits(Lanes, width_i);
  assign strip_end  = StripLineLimit'((1 << line_bits) - 1);
  assign lines_left = height_i - first_line_q;
  assign last_strip = lines_left <= SizeBits'(strip_end) + 1'b1;
  assign last_line  = line_q == (last_strip ? StripLineLimit'(lines_left - 1'b1) : strip_end);

  // The right half has (width + 1) / 2 columns, the left one width / 2.
  always_comb begin
    last_of_half = column_q == (SizeBits - 1)'((right_half_q ? width_i - SizeBits'(1) : width_i - SizeBits'(2)) >> 1);
    if (leftwards_q) last_of_half = column_q == '0;
    last_column = last_of_half && right_half_q == (ByLines || leftwards_q || width_i[0]);
  end

  always_ff @(posedge clk_i) begin
    if (advances_i) begin
      if (ByLines) begin
        column_q <= last_of_half ? '0 : column_q + 1'b1;
        if (last_of_half) right_half_q <= !right_half_q || width_i == SizeBits'(1);
        if (last_column) line_q <= last_line ? '0 : line_q + 1'b1;
      end else begin
        line_q <= last_line ? '0 : line_q + 1'b1;
        if (last_line && last_column) leftwards_q <= !leftwards_q;
        if (last_line && !last_column) begin
          right_half_q <= !right_half_q;
          if (!leftwards_q && !right_half_q) column_q <= column_q + 1'b1;
          if (leftwards_q && right_half_q) column_q <= column_q - 1'b1;
        end
      end
      if (last_line && last_column) first_line_q <= first_line_q + SizeBits'(strip_end) + 1'b1;
    end
    if (start_i) begin
      right_half_q <= !ByLines || width_i == SizeBits'(1);
      leftwards_q  <= 1'b0;
      column_q     <= '0;
      line_q       <= '0;
      first_line_q <= '0;
    end
  end

  assign place_o = '{
          last_line: last_line,
          last_of_half: last_of_half,
          last_column: last_column,
          last_strip: last_strip,
          leftwards: leftwards_q,
          address: (StripLimit'({column_q, right_half_q}) << line_bits) | StripLimit'(line_q)
      };
endmodule
