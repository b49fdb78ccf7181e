// Reads the frame that is shown from the SDRAM, a row ahead of the beam: while a row is shown, the next one comes.
//
// A row has 1846 clocks of 57.7 MHz for 60 lines of at most 22 clocks. Requests are urgent after 512 clocks of it.
module board_frame_reader
  import board_pkg::*;
(
  // System clock.
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               visible_i,     // There is a frame. These three change only while reading_o is low.
  input  logic               frame_i,
  input  logic       [  1:0] scale_i,
  output logic               reading_o,
  output logic               row_event_o,   // See board_line_buffer.
  output row_event_t         row_o,
  // A port of the SDRAM's arbiter.
  output logic               valid_o,
  input  logic               ready_i,
  output logic               urgent_o,
  output logic       [ 19:0] line_o,
  input  logic               done_i,
  input  logic       [255:0] data_i,
  // Pixel clock.
  input  logic               pixel_clk_i,
  input  logic               pixel_rst_ni,
  input  logic               row_begin_i,   // A row begins in a few clocks; for one clock.
  input  logic       [  9:0] row_i,         // The number of that row.
  input  logic       [  9:0] column_i,
  output logic       [ 23:0] pixel_o        // Three clocks after column_i.
);
  localparam int unsigned LinesPerRow = 60;
  localparam int unsigned UrgentBit = 9;

  // The row that comes.
  logic row_event, busy_q, missed_q, reading_q, asks_q, first_q;
  logic [9:0] row, target;
  logic [8:0] row_q, picture_row;
  logic [5:0] asked_q, come_q, lines;
  logic [UrgentBit:0] waited_q;

  assign target = row == 10'(RowsTotal - 1) ? '0 : row + 10'd1;
  assign lines  = 6'(LinesPerRow) >> scale_i;

  board_event #(
    .Width(10)
  ) u_row (
    .from_clk_i (pixel_clk_i),
    .from_rst_ni(pixel_rst_ni),
    .send_i     (row_begin_i),
    .value_i    (row_i),
    .to_clk_i   (clk_i),
    .received_o (row_event),
    .value_o    (row)
  );

  assign row_event_o = row_event;
  assign row_o       = '{row: row, line: '0, underrun: missed_q};
  assign reading_o   = reading_q;
  assign valid_o     = asks_q;
  assign urgent_o    = waited_q[UrgentBit];
  assign line_o      = {4'hF, frame_i, picture_row, asked_q};
  assign picture_row = row_q >> scale_i;

  // A line that has come, word by word.
  logic [255:0] data_q;
  logic [3:0] words_q;
  logic word_ready, word_last, pixel_valid, line_end;
  logic [23:0] pixel;
  logic [9:0] column_q;

  assign word_last = words_q == 4'd1 && come_q == lines;

  board_unpacker u_unpacker (
    .clk_i,
    .rst_ni,
    .s_axis_tvalid(words_q != '0),
    .s_axis_tready(word_ready),
    .s_axis_tdata (data_q[31:0]),
    .s_axis_tuser (first_q),
    .s_axis_tlast (word_last),
    .valid_o      (pixel_valid),
    .ready_i      (1'b1),
    .pixel_o      (pixel),
    .line_end_o   (line_end)
  );

  always_ff @(posedge clk_i) begin
    if (!waited_q[UrgentBit]) waited_q <= waited_q + 1'b1;
    if (asks_q && ready_i) begin
      asked_q <= asked_q + 1'b1;
      asks_q  <= asked_q + 1'b1 != lines;
    end
    if (words_q != '0 && word_ready) begin
      words_q <= words_q - 1'b1;
      data_q  <= data_q >> 32;
      first_q <= 1'b0;
    end
    // Lines come 16 clocks after each other, or later: the one before has gone.
    if (done_i) begin
      words_q <= 4'd8;
      data_q  <= data_i;
      come_q  <= come_q + 1'b1;
    end
    if (pixel_valid) begin
      column_q <= column_q + 1'b1;
      if (line_end) busy_q <= 1'b0;
    end

    if (row_event) begin
      missed_q <= 1'b0;
      if (row == 10'(Rows)) reading_q <= 1'b0;
      if (visible_i && target < 10'(Rows) && (reading_q || target == '0)) begin
        reading_q <= 1'b1;
        if (busy_q) begin
          missed_q <= 1'b1;
        end else begin
          busy_q   <= 1'b1;
          row_q    <= target[8:0];
          asks_q   <= 1'b1;
          first_q  <= 1'b1;
          asked_q  <= '0;
          come_q   <= '0;
          column_q <= '0;
          waited_q <= '0;
        end
      end
    end
    if (!rst_ni) begin
      busy_q    <= 1'b0;
      missed_q  <= 1'b0;
      reading_q <= 1'b0;
      asks_q    <= 1'b0;
      words_q   <= '0;
      waited_q  <= '0;
    end
  end

  // Two rows.
  logic [23:0] rows_q[2 * 1024];
  logic [10:0] read_place_q;
  logic [23:0] read_q;
  logic [1:0] pixel_scale;
  logic pixel_visible, shows_q, shown_half_q;

  always_ff @(posedge clk_i) if (pixel_valid && busy_q) rows_q[{row_q[0], column_q}] <= pixel;

  for (genvar i = 0; i < 2; i++) begin : gen_scale
    board_synchronizer u_scale (
      .clk_i(pixel_clk_i),
      .bit_i(scale_i[i]),
      .bit_o(pixel_scale[i])
    );
  end

  board_synchronizer u_visible (
    .clk_i(pixel_clk_i),
    .bit_i(reading_q),
    .bit_o(pixel_visible)
  );

  always_ff @(posedge pixel_clk_i) begin
    if (row_begin_i) begin
      shows_q      <= pixel_visible && row_i < 10'(Rows);
      shown_half_q <= row_i[0];
    end
    read_place_q <= {shown_half_q, column_i >> pixel_scale};
    read_q       <= rows_q[read_place_q];
    pixel_o      <= shows_q ? read_q : '0;
    if (!pixel_rst_ni) shows_q <= 1'b0;
  end
endmodule
