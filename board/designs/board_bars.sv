// The picture of the self-test: eight colour bars, a ramp per channel, a square per LED, and a white frame around it.
//
// docs/board-selftest.md says what is where.
module board_bars
  import board_pkg::*;
(
  input  logic        clk_i,        // Pixel clock.
  input  logic        row_begin_i,
  input  logic [ 9:0] row_i,        // The row after the present one, with row_begin_i.
  input  logic [ 9:0] column_i,
  input  logic [ 7:0] leds_i,       // Any clock.
  output logic [23:0] pixel_o       // Three clocks after column_i: red, green, blue.
);
  localparam int unsigned BarColumns = 80;
  localparam int unsigned RampRow = 320;
  localparam int unsigned RampRows = 40;
  localparam int unsigned SquareRow = RampRow + 3 * RampRows;
  localparam int unsigned GapColumns = 4;  // Black, left of each square.

  logic [7:0] leds;

  for (genvar i = 0; i < 8; i++) begin : gen_led
    board_synchronizer u_led (
      .clk_i,
      .bit_i(leds_i[i]),
      .bit_o(leds[i])
    );
  end

  // The row, from the beginning of its blanking on.
  logic [9:0] row_q;
  logic edge_row_q, bars_q, squares_q;
  logic [2:0] ramps_q;  // Blue, green, red.

  always_ff @(posedge clk_i) begin
    if (row_begin_i) row_q <= row_i;
    edge_row_q <= row_q == '0 || row_q == 10'(Rows - 1);
    bars_q     <= row_q < 10'(RampRow);
    squares_q  <= row_q >= 10'(SquareRow);
    for (int unsigned i = 0; i < 3; i++) begin
      ramps_q[2-i] <= row_q >= 10'(RampRow + i * RampRows) && row_q < 10'(RampRow + (i + 1) * RampRows);
    end
  end

  // 1: the bar of the column.
  logic [2:0] bar_q;
  logic [6:0] place_q;  // The column in the bar.
  logic [7:0] level_q;
  logic edge_q;

  always_ff @(posedge clk_i) begin
    place_q <= place_q + 1'b1;
    if (place_q == 7'(BarColumns - 1)) begin
      place_q <= '0;
      bar_q   <= bar_q + 1'b1;
    end
    if (column_i == '0) begin
      place_q <= '0;
      bar_q   <= '0;
    end
    level_q <= column_i[9] ? 8'hFF : column_i[8:1];
    edge_q  <= column_i == '0 || column_i == 10'(Columns - 1);
  end

  // 2: its colour. The bars are white, yellow, cyan, green, magenta, red, blue, black: a bit per channel.
  logic [23:0] pixel_q;
  logic [2:0] colour;

  assign colour = {!bar_q[1], !bar_q[2], !bar_q[0]};

  always_ff @(posedge clk_i) begin
    pixel_q <= '0;
    if (bars_q) pixel_q <= {{8{colour[2]}}, {8{colour[1]}}, {8{colour[0]}}};
    for (int unsigned i = 0; i < 3; i++) if (ramps_q[i]) pixel_q[8*i+:8] <= level_q;
    if (squares_q && place_q >= 7'(GapColumns)) pixel_q <= leds[bar_q] ? 24'hFFFFFF : 24'h202020;
    if (edge_row_q || edge_q) pixel_q <= 24'hFFFFFF;
    pixel_o <= pixel_q;
  end
endmodule
