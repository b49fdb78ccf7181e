// The part of a board that decides: player, frames, serial line, and the table that they play from. It is two masters of
// board_bus, and has the registers and the table that the bus reaches.
module board_control
  import board_pkg::*;
#(
  parameter int unsigned ClockHz    = 75_000_000,
  parameter int unsigned LineBits   = 4,
  parameter int unsigned GapBits    = 22,
  parameter bit          ButtonsLow = 1'b0,
  // What the table holds from the beginning, for $readmemh.
  parameter string       TableFile  = ""
) (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             rx_i,
  output logic                             tx_o,
  input  logic       [          2:0]       buttons_i,
  output logic       [          7:0]       leds_o,
  // Master 0 is the player, and between lists the frames; master 1 the serial line.
  output logic       [          1:0]       valid_o,
  output access_t    [          1:0]       access_o,
  input  logic       [          1:0]       done_i,
  input  logic       [          1:0][31:0] data_i,
  input  logic       [          1:0]       refused_i,
  // The board's registers and the table, from the bus.
  input  logic                             register_en_i,
  input  logic                             register_write_i,
  input  logic       [          3:0]       register_i,
  input  logic       [         31:0]       register_data_i,
  output logic       [         31:0]       register_data_o,
  input  logic                             table_write_i,
  input  logic       [TableBits-1:0]       table_word_i,
  input  logic       [         31:0]       table_data_i,
  output logic       [         31:0]       table_data_o,
  // Frames.
  input  logic                             flush_i,           // A frame that starts empties the core's caches.
  input  logic                             row_event_i,
  input  row_event_t                       row_i,
  input  logic       [         31:0]       frame_crc_i,
  output logic                             drain_o,
  output logic                             new_frame_o,       // A frame starts; for one clock.
  output logic       [          1:0]       scale_o            // The scale of the new frame.
);
  // Bit flush of the core's register control, which board_frames writes to start a frame.
  localparam int unsigned FlushBit = 4;

  logic player_valid, frames_valid, playing, play, play_camera;
  access_t player_access, frames_access;
  logic [TableBits-1:0] play_word;
  count_events_t events;

  assign valid_o[0] = playing ? player_valid : frames_valid;

  always_comb begin
    access_o[0] = playing ? player_access : frames_access;
    if (!playing && frames_access.write) access_o[0].data[FlushBit] = flush_i;
  end

  board_table #(
    .File(TableFile)
  ) u_table (
    .clk_i,
    .write_i(table_write_i),
    .word_i (table_word_i),
    .data_i (table_data_i),
    .data_o (table_data_o)
  );

  board_player u_player (
    .clk_i,
    .rst_ni,
    .start_i  (play),
    .word_i   (play_word),
    .camera_i (play_camera),
    .busy_o   (playing),
    .refused_o(events.write_refused),
    .valid_o  (player_valid),
    .access_o (player_access),
    .done_i   (done_i[0] && playing),
    .data_i   (data_i[0]),
    .refused_i(refused_i[0])
  );

  // Serial line.
  logic rx_valid, rx_broken, tx_valid, tx_ready;
  logic [7:0] rx_byte, tx_byte;

  board_uart #(
    .ClockHz(ClockHz)
  ) u_uart (
    .clk_i,
    .rst_ni,
    .rx_i,
    .valid_o (rx_valid),
    .broken_o(rx_broken),
    .byte_o  (rx_byte),
    .valid_i (tx_valid),
    .ready_o (tx_ready),
    .byte_i  (tx_byte),
    .tx_o
  );

  board_requests #(
    .GapBits(GapBits)
  ) u_requests (
    .clk_i,
    .rst_ni,
    .valid_i       (rx_valid),
    .broken_i      (rx_broken),
    .byte_i        (rx_byte),
    .valid_o       (tx_valid),
    .ready_i       (tx_ready),
    .byte_o        (tx_byte),
    .access_valid_o(valid_o[1]),
    .access_o      (access_o[1]),
    .done_i        (done_i[1]),
    .data_i        (data_i[1]),
    .refused_i     (refused_i[1]),
    .request_done_o(events.request_done),
    .request_bad_o (events.request_bad)
  );

  board_frames #(
    .ClockHz   (ClockHz),
    .LineBits  (LineBits),
    .ButtonsLow(ButtonsLow)
  ) u_frames (
    .clk_i,
    .rst_ni,
    .register_en_i,
    .register_write_i,
    .register_i,
    .register_data_i,
    .register_data_o,
    .play_o       (play),
    .play_word_o  (play_word),
    .play_camera_o(play_camera),
    .playing_i    (playing),
    .valid_o      (frames_valid),
    .access_o     (frames_access),
    .done_i       (done_i[0] && !playing),
    .data_i       (data_i[0]),
    .row_event_i,
    .row_i,
    .frame_crc_i,
    .drain_o,
    .new_frame_o,
    .scale_o,
    .events_i     (events),
    .buttons_i,
    .leds_o
  );
endmodule
