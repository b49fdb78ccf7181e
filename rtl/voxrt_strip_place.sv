// Walks the pixels of a frame strip by strip: in columns from the top down (by_lines_i low), or line by line. Strips have
// 2**strip_line_bits(Lanes, width) lines, the last one what is left.
module voxrt_strip_place
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes = 1
) (
  input  logic                clk_i,
  input  logic                start_i,    // To the first pixel. Width and height are held from here on.
  input  logic [SizeBits-1:0] width_i,
  input  logic [SizeBits-1:0] height_i,
  input  logic                advances_i,
  input  logic                by_lines_i, // Held.
  output strip_place_t        place_o
);
  logic [StripLineLimit-1:0] line_q;                // In the strip.
  logic [     SizeBits-1:0] column_q, first_line_q; // From 0 on; of the strip, in the frame.
  logic [StripLineLimit-1:0] strip_end;
  logic [     SizeBits-1:0] lines_left;
  logic                     last_line, last_column, last_strip;

  logic [2:0] line_bits;
  assign line_bits   = strip_line_bits(Lanes, width_i);
  assign strip_end   = StripLineLimit'((1 << line_bits) - 1);
  assign lines_left  = height_i - first_line_q;
  assign last_strip  = lines_left <= SizeBits'(strip_end) + 1'b1;
  assign last_line   = line_q == (last_strip ? StripLineLimit'(lines_left - 1'b1) : strip_end);
  assign last_column = column_q == width_i - 1'b1;

  always_ff @(posedge clk_i) begin
    if (advances_i) begin
      if (by_lines_i) begin
        column_q <= last_column ? '0 : column_q + 1'b1;
        if (last_column) line_q <= last_line ? '0 : line_q + 1'b1;
      end else begin
        line_q <= last_line ? '0 : line_q + 1'b1;
        if (last_line) column_q <= last_column ? '0 : column_q + 1'b1;
      end
      if (last_line && last_column) first_line_q <= first_line_q + SizeBits'(strip_end) + 1'b1;
    end
    if (start_i) begin
      line_q       <= '0;
      column_q     <= '0;
      first_line_q <= '0;
    end
  end

  assign place_o = '{
      last_line: last_line,
      first_column: column_q == '0,
      last_column: last_column,
      last_strip: last_strip,
      address: (StripLimit'(column_q) << line_bits) | StripLimit'(line_q)
  };
endmodule
