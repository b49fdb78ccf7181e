// 640 x 480 pixels at 59.5 Hz: the beam, and what it shows as the ten bit words of DVI's channels.
module board_screen
  import board_pkg::*;
(
  input  logic             clk_i,        // Pixel clock.
  input  logic             rst_ni,
  // The line buffer.
  output logic             row_begin_o,
  output logic [ 9:0]      row_o,
  output logic [ 9:0]      column_o,
  input  logic [23:0]      pixel_i,      // Three clocks after column_o.
  // Blue, green, red.
  output logic [ 2:0][9:0] words_o
);
  localparam int unsigned Clocks = 3;  // Clocks from a column to its pixel.

  logic [9:0] column_q, row_q;
  logic last_column;
  logic [Clocks-1:0] visible_q, hsync_q, vsync_q;  // Syncs are low while they pulse.

  assign last_column = column_q == 10'(ColumnsTotal - 1);

  always_ff @(posedge clk_i) begin
    column_q <= last_column ? '0 : column_q + 1'b1;
    if (last_column) row_q <= row_q == 10'(RowsTotal - 1) ? '0 : row_q + 1'b1;
    if (!rst_ni) begin
      column_q <= '0;
      row_q    <= 10'(Rows);
    end
    visible_q   <= {visible_q[Clocks-2:0], column_q < 10'(Columns) && row_q < 10'(Rows)};
    hsync_q     <= {hsync_q[Clocks-2:0], !(column_q >= 10'(ColumnSyncBegin) && column_q < 10'(ColumnSyncEnd))};
    vsync_q     <= {vsync_q[Clocks-2:0], !(row_q >= 10'(RowSyncBegin) && row_q < 10'(RowSyncEnd))};
    // The next row is announced behind the visible part of this one.
    row_begin_o <= rst_ni && column_q == 10'(ColumnSyncEnd);
    row_o       <= row_q == 10'(RowsTotal - 1) ? '0 : row_q + 1'b1;
  end

  assign column_o = column_q;

  for (genvar c = 0; c < 3; c++) begin : gen_channel
    board_tmds u_tmds (
      .clk_i,
      .rst_ni,
      .visible_i(visible_q[Clocks-1]),
      .data_i   (pixel_i[8*c+:8]),
      .control_i(c == 0 ? {vsync_q[Clocks-1], hsync_q[Clocks-1]} : 2'b00),
      .word_o   (words_o[c])
    );
  end
endmodule
