// Directions of a frame's pixels, row by row from the top left. It needs additions alone, because neighbours differ by
// a constant:
//   direction(column, row) = look + right * (column - width/2) + up * (height/2 - row)
//
// raster_i.start starts voxrt_scan too, which gives corner and line_step. Right, width and height must hold while
// valid_o may still rise. Directions come from two clocks after the corner on, one at every clock that ready_i is high.
// With Ahead they come a clock later, from a FIFO: ready_i does not enable the additions.
module voxrt_ray_generator
  import voxrt_pkg::*;
#(
  parameter bit Ahead = 1'b0
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  raster_t                    raster_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output logic signed [ScanBits-1:0] direction_o[3],
  output logic                       first_o,         // First pixel of the frame.
  output logic                       line_end_o,      // Last pixel of its line.
  output logic                       last_o           // Last pixel of the frame.
);
  logic corner_q, valid_q, first_q, line_end_q, last_line_q;
  logic [SizeBits-1:0] column_q, row_q;  // Counted from 1.
  logic signed [ScanBits-1:0] direction_q[3], line_q[3], next[3];
  logic advances, new_line, last;

  assign last = line_end_q && last_line_q;

  if (Ahead) begin : gen_ahead
    typedef struct packed {
      logic [2:0][ScanBits-1:0] direction;
      logic                     first;
      logic                     line_end;
      logic                     last;
    } made_t;

    logic ready;
    made_t made, offered;

    assign advances      = raster_i.corner || (valid_q && ready);
    assign made.first    = first_q;
    assign made.line_end = line_end_q;
    assign made.last     = last;

    always_comb begin
      for (int unsigned a = 0; a < 3; a++) begin
        made.direction[a] = direction_q[a];
        direction_o[a]    = $signed(offered.direction[a]);
      end
    end

    voxrt_fifo #(
      .Width($bits(made_t)),
      .Depth(4)
    ) u_made (
      .clk_i,
      .rst_ni (rst_ni && !raster_i.start),
      .valid_i(valid_q),
      .ready_o(ready),
      .data_i (made),
      .valid_o,
      .ready_i,
      .data_o (offered)
    );

    assign first_o    = offered.first;
    assign line_end_o = offered.line_end;
    assign last_o     = offered.last;
  end else begin : gen_advances
    assign advances = raster_i.corner || (valid_q && ready_i);
  end

  // The first line is a step from 0.
  assign new_line = raster_i.corner || line_end_q;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      next[a] = (new_line ? line_q[a] : direction_q[a]) +
          (new_line ? $signed(raster_i.line_step[a]) : ScanBits'($signed(raster_i.right[a])));
    end
  end

  always_ff @(posedge clk_i) begin
    corner_q <= raster_i.corner && rst_ni;
    if (corner_q) valid_q <= 1'b1;
    if (advances) begin
      first_q     <= raster_i.corner;
      direction_q <= next;
      column_q    <= column_q + 1'b1;
      line_end_q  <= column_q + 1'b1 == raster_i.width;
      if (new_line) begin
        line_q      <= next;
        column_q    <= SizeBits'(1);
        line_end_q  <= raster_i.width == SizeBits'(1);
        row_q       <= row_q + 1'b1;
        last_line_q <= row_q + 1'b1 == raster_i.height;
      end
      if (last) valid_q <= 1'b0;
    end
    if (raster_i.start) begin
      line_q     <= '{default: '0};
      row_q      <= '0;
      line_end_q <= 1'b0;
    end
    if (!rst_ni || raster_i.start) valid_q <= 1'b0;
  end

  if (!Ahead) begin : gen_outputs
    assign valid_o     = valid_q;
    assign direction_o = direction_q;
    assign first_o     = first_q;
    assign line_end_o  = line_end_q;
    assign last_o      = last;
  end
endmodule
