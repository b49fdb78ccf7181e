// Rows of a frame on their way to the screen, through a line buffer: for boards whose octree is on the chip.
module board_beam
  import board_pkg::*;
#(
  parameter int unsigned LineBits   = 4,
  parameter int unsigned ColumnBits = 10
) (
  // System clock.
  input  logic              clk_i,
  input  logic              rst_ni,
  input  logic              new_frame_i,
  input  logic              drain_i,
  input  logic       [ 1:0] scale_i,
  input  logic              s_axis_tvalid,
  output logic              s_axis_tready,
  input  logic       [31:0] s_axis_tdata,
  input  logic              s_axis_tuser,
  input  logic              s_axis_tlast,
  output logic              row_event_o,
  output row_event_t        row_o,
  // Pixel clock.
  input  logic              pixel_clk_i,
  input  logic              pixel_rst_ni,
  input  logic              row_begin_i,
  input  logic       [ 9:0] row_i,
  input  logic       [ 9:0] column_i,
  output logic       [23:0] pixel_o
);
  logic [1:0] pixel_scale;
  logic [23:0] pixel;
  logic pixel_valid, pixel_ready, line_end;

  board_unpacker u_unpacker (
    .clk_i,
    .rst_ni,
    .s_axis_tvalid,
    .s_axis_tready,
    .s_axis_tdata,
    .s_axis_tuser,
    .s_axis_tlast,
    .valid_o   (pixel_valid),
    .ready_i   (pixel_ready),
    .pixel_o   (pixel),
    .line_end_o(line_end)
  );

  for (genvar i = 0; i < 2; i++) begin : gen_scale
    board_synchronizer u_scale (
      .clk_i(pixel_clk_i),
      .bit_i(scale_i[i]),
      .bit_o(pixel_scale[i])
    );
  end

  board_line_buffer #(
    .LineBits  (LineBits),
    .ColumnBits(ColumnBits)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .valid_i   (pixel_valid),
    .ready_o   (pixel_ready),
    .pixel_i   (pixel),
    .line_end_i(line_end),
    .drain_i,
    .new_frame_i,
    .row_event_o,
    .row_o,
    .pixel_clk_i,
    .pixel_rst_ni,
    .scale_i   (pixel_scale),
    .row_begin_i,
    .row_i,
    .column_i,
    .pixel_o
  );
endmodule
