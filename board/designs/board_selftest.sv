// The self-test of a board: clocks, picture, buttons, LEDs, serial line and SDRAM, each with a result of its own.
//
// docs/board-selftest.md is the reference of its registers, which the serial line reads by the protocol of the other
// designs.
module board_selftest
  import board_pkg::*;
#(
  parameter int unsigned ClockHz    = 75_000_000,
  parameter int unsigned PixelHz    = 25_000_000,  // 1 or more.
  parameter bit          HasSdram   = 1'b0,
  parameter int unsigned GapBits    = 22,
  parameter int unsigned WindowBits = 20,
  parameter int unsigned Buttons    = 3,           // 1 .. 3.
  parameter bit          ButtonsLow = 1'b0
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    bit_clk_i,     // Five times the pixel clock; counted alone.
  input  logic                    pixel_clk_i,
  input  logic                    pixel_rst_ni,
  input  logic                    locked_i,      // All PLLs are locked.
  input  logic                    rx_i,
  output logic                    tx_o,
  input  logic [Buttons-1:0]      buttons_i,     // Pause, reverse, step.
  output logic [        7:0]      leds_o,
  output logic [        2:0][9:0] words_o,       // TMDS: blue, green, red.
  // What board_sdram_test found; 0 where there is no SDRAM.
  input  logic [        1:0]      stage_i,
  input  logic [       31:0]      lines_i,
  input  logic [       31:0]      wrong_i,
  input  logic [       15:0]      bits_i,
  input  logic [       19:0]      first_i
);
  if (PixelHz < 1) $error("board_selftest: PixelHz must be 1 or more");
  if (Buttons < 1 || Buttons > 3) $error("board_selftest: Buttons must be 1 to 3");

  localparam logic [21:0] FirstRegister = 22'h000400;  // At address 0x1000.
  localparam logic [21:0] Registers = 18;

  logic locked_here;

  board_synchronizer u_locked (
    .clk_i,
    .bit_i(locked_i),
    .bit_o(locked_here)
  );

  // Picture.
  logic row_begin, frame;
  logic [9:0] row, column;
  logic [23:0] pixel;

  board_bars u_bars (
    .clk_i      (pixel_clk_i),
    .row_begin_i(row_begin),
    .row_i      (row),
    .column_i   (column),
    .leds_i     (leds_o),
    .pixel_o    (pixel)
  );

  board_screen u_screen (
    .clk_i      (pixel_clk_i),
    .rst_ni     (pixel_rst_ni),
    .row_begin_o(row_begin),
    .row_o      (row),
    .column_o   (column),
    .pixel_i    (pixel),
    .words_o
  );

  logic unused_frame;

  board_event #(
    .Width(1)
  ) u_frame (
    .from_clk_i (pixel_clk_i),
    .from_rst_ni(pixel_rst_ni),
    .send_i     (row_begin && row == '0),
    .value_i    (1'b0),
    .to_clk_i   (clk_i),
    .received_o (frame),
    .value_o    (unused_frame)
  );

  // The other clocks.
  logic [31:0] bit_clocks, pixel_clocks;

  board_clock_meter #(
    .WindowBits(WindowBits)
  ) u_bit_meter (
    .clk_i,
    .other_clk_i(bit_clk_i),
    .clocks_o   (bit_clocks)
  );

  board_clock_meter #(
    .WindowBits(WindowBits)
  ) u_pixel_meter (
    .clk_i,
    .other_clk_i(pixel_clk_i),
    .clocks_o   (pixel_clocks)
  );

  // Buttons.
  logic [Buttons-1:0] pins, pressed, pressed_q, released_q;

  for (genvar i = 0; i < Buttons; i++) begin : gen_button
    board_synchronizer u_button (
      .clk_i,
      .bit_i(buttons_i[i]),
      .bit_o(pins[i])
    );
  end

  assign pressed = pins ^ {Buttons{ButtonsLow}};

  // Serial line.
  logic rx_valid, rx_broken, tx_valid, tx_ready, valid, done_q, request_done, request_bad;
  logic [7:0] rx_byte, tx_byte;
  access_t access;

  board_uart #(
    .ClockHz(ClockHz)
  ) u_uart (
    .clk_i,
    .rst_ni  (rst_ni),
    .rx_i,
    .valid_o (rx_valid),
    .broken_o(rx_broken),
    .byte_o  (rx_byte),
    .valid_i (tx_valid),
    .ready_o (tx_ready),
    .byte_i  (tx_byte),
    .tx_o
  );

  logic [31:0] data_q;
  logic refused;

  board_requests #(
    .GapBits(GapBits)
  ) u_requests (
    .clk_i,
    .rst_ni        (rst_ni),
    .valid_i       (rx_valid),
    .broken_i      (rx_broken),
    .byte_i        (rx_byte),
    .valid_o       (tx_valid),
    .ready_i       (tx_ready),
    .byte_o        (tx_byte),
    .access_valid_o(valid),
    .access_o      (access),
    .done_i        (done_q),
    .data_i        (data_q),
    .refused_i     (refused),
    .request_done_o(request_done),
    .request_bad_o (request_bad)
  );

  // Registers.
  logic [31:0] echo_q, frames_q, done_count_q, bad_count_q;
  logic [23:0] losses_q, time_q;
  logic locked_q;

  assign refused = access.address[23:2] < FirstRegister || access.address[23:2] >= FirstRegister + Registers;

  always_ff @(posedge clk_i) begin
    done_q <= valid && !done_q;
    if (valid && access.write && !refused && access.address[6:2] == 5'd3) echo_q <= access.data;
    unique case (access.address[6:2])
      5'd0:    data_q <= 32'h56585354;
      5'd1:    data_q <= 32'h00000101;
      5'd2:    data_q <= 32'(ClockHz);
      5'd3:    data_q <= echo_q;
      5'd4:    data_q <= {losses_q, 7'd0, locked_here};
      5'd5:    data_q <= bit_clocks;
      5'd6:    data_q <= pixel_clocks;
      5'd7:    data_q <= frames_q;
      5'd8:    data_q <= {8'd0, 8'(released_q), 8'(pressed_q), 8'(pressed)};
      5'd9:    data_q <= done_count_q;
      5'd10:   data_q <= bad_count_q;
      5'd11:   data_q <= {22'd0, stage_i, 7'd0, HasSdram};
      5'd12:   data_q <= lines_i;
      5'd13:   data_q <= wrong_i;
      5'd14:   data_q <= {16'd0, bits_i};
      5'd15:   data_q <= {12'd0, first_i};
      5'd16:   data_q <= 32'(PixelHz);
      default: data_q <= 32'(Buttons);
    endcase
    if (refused) data_q <= '0;

    locked_q <= locked_here;
    if (locked_q && !locked_here) losses_q <= losses_q + 1'b1;
    if (frame) frames_q <= frames_q + 1'b1;
    if (request_done) done_count_q <= done_count_q + 1'b1;
    if (request_bad) bad_count_q <= bad_count_q + 1'b1;
    pressed_q  <= pressed_q | pressed;
    released_q <= released_q | ~pressed;
    time_q     <= time_q + 1'b1;
    if (!rst_ni) begin
      done_q     <= 1'b0;
      pressed_q  <= '0;
      released_q <= '0;
    end
  end

  // LED 0 shows the PLL itself: it needs no clock.
  assign leds_o[0] = locked_i;

  always_ff @(posedge clk_i) begin
    leds_o[1] <= time_q[23] && rst_ni;
    leds_o[2] <= frames_q[4];
    leds_o[3] <= |pressed && rst_ni;
    leds_o[4] <= done_count_q[0];
    leds_o[5] <= bad_count_q != '0;
    leds_o[6] <= wrong_i != '0;
    leds_o[7] <= stage_i == 2'd3 && wrong_i == '0;
  end
endmodule
