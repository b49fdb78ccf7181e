// Writes the core's video stream (rtl/shading/voxrt_pixel_packer.sv) into one of two frames in the SDRAM, as it comes. A
// row of the picture has 64 lines of 32 bytes, of which 640 pixels take 60. What is beyond is dropped.
module board_frame_writer
  import board_pkg::*;
(
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         frame_i,        // The number of the frame, at its first word.
  input  logic         hold_i,         // No frame begins.
  input  logic         s_axis_tvalid,
  output logic         s_axis_tready,
  input  logic [ 31:0] s_axis_tdata,
  input  logic         s_axis_tuser,
  input  logic         s_axis_tlast,
  // A port of the SDRAM's arbiter.
  output logic         valid_o,
  input  logic         ready_i,
  output logic [ 19:0] line_o,
  output logic [ 15:0] mask_o,
  output logic [255:0] data_o
);
  logic full_q, last_q, frame_q, beyond, accepts;
  logic [6:0] line_q;  // The line of the row; from 64 on it is beyond.
  logic [8:0] row_q;
  logic [2:0] word_q, word;
  logic [15:0] mask_q;
  logic [255:0] data_q;

  assign s_axis_tready = !full_q && !(s_axis_tuser && hold_i);
  assign accepts       = s_axis_tvalid && s_axis_tready;
  assign word          = s_axis_tuser ? 3'd0 : word_q;
  assign beyond        = line_q[6] || row_q >= 9'(Rows);

  assign valid_o       = full_q && !beyond;
  assign line_o        = {4'hF, frame_q, row_q, line_q[5:0]};
  assign mask_o        = mask_q;
  // Ports that do not write bring zeros.
  assign data_o        = full_q ? data_q : '0;

  always_ff @(posedge clk_i) begin
    if (accepts) begin
      data_q[{word, 5'd0}+:32] <= s_axis_tdata;
      mask_q                   <= (word == '0 ? 16'd0 : mask_q) | (16'd3 << {word, 1'b0});
      word_q                   <= word + 1'b1;
      last_q                   <= s_axis_tlast;
      if (s_axis_tuser) begin
        frame_q <= frame_i;
        line_q  <= '0;
        row_q   <= '0;
      end
      full_q <= word == '1 || s_axis_tlast;
    end
    if (full_q && (ready_i || beyond)) begin
      full_q <= 1'b0;
      word_q <= '0;
      if (!line_q[6]) line_q <= line_q + 1'b1;
      if (last_q) begin
        line_q <= '0;
        if (row_q < 9'(Rows)) row_q <= row_q + 1'b1;
      end
    end
    if (!rst_ni) full_q <= 1'b0;
  end
endmodule
