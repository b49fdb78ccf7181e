// The part of a board with SDRAM that writes registers: bus, table, player, serial line, frames. board_system has the same
// inside, without the words of an SDRAM.
module board_control
  import board_pkg::*;
#(
  parameter int unsigned ClockHz    = 75_000_000,
  parameter int unsigned GapBits    = 22,
  parameter bit          ButtonsLow = 1'b0,
  parameter string       TableFile  = ""
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         rx_i,
  output logic         tx_o,
  input  logic [  2:0] buttons_i,
  output logic [  7:0] leds_o,
  // The core's registers.
  output logic         m_axil_awvalid,
  input  logic         m_axil_awready,
  output logic [ 10:0] m_axil_awaddr,
  output logic         m_axil_wvalid,
  input  logic         m_axil_wready,
  output logic [ 31:0] m_axil_wdata,
  input  logic         m_axil_bvalid,
  input  logic [  1:0] m_axil_bresp,
  output logic         m_axil_arvalid,
  input  logic         m_axil_arready,
  output logic [ 10:0] m_axil_araddr,
  input  logic         m_axil_rvalid,
  input  logic [ 31:0] m_axil_rdata,
  input  logic [  1:0] m_axil_rresp,
  // A port of the SDRAM's arbiter: the words of the host and of lists.
  output logic         line_valid_o,
  input  logic         line_ready_i,
  output logic         line_write_o,
  output logic [ 19:0] line_o,
  output logic [ 15:0] line_mask_o,
  output logic [255:0] line_data_o,
  input  logic         line_done_i,
  input  logic [255:0] line_data_i,
  // Frames.
  input  logic         row_event_i,
  input  row_event_t   row_i,
  output logic         new_frame_o,    // A frame starts; for one clock.
  output logic [  1:0] scale_o         // Of it.
);
  // Bit flush of the core's register control, which board_frames writes to start a frame.
  localparam int unsigned FlushBit = 4;

  // Master 0 is the player, and between lists the frames; master 1 the serial line.
  logic    [1:0]       valid, done, refused, bus_valid, bus_done;
  access_t [1:0]       access;
  logic    [1:0][31:0] data;
  logic    [31:0]      bus_data;
  logic                bus_refused;

  logic player_valid, frames_valid, playing, play, play_camera, written, written_q, unused_drain;
  access_t player_access, frames_access;
  logic [TableBits-1:0] play_word;
  count_events_t events;

  assign valid[0] = playing ? player_valid : frames_valid;

  // What was written since the last frame started may be in the core's caches as it was before.
  always_comb begin
    access[0] = playing ? player_access : frames_access;
    if (!playing && frames_access.write) access[0].data[FlushBit] = written_q;
  end

  always_ff @(posedge clk_i) begin
    if (new_frame_o) written_q <= 1'b0;
    if (written) written_q <= 1'b1;
    if (!rst_ni) written_q <= 1'b0;
  end

  board_memory_port u_memory (
    .clk_i,
    .rst_ni,
    .valid_i      (valid),
    .access_i     (access),
    .done_o       (done),
    .data_o       (data),
    .refused_o    (refused),
    .written_o    (written),
    .bus_valid_o  (bus_valid),
    .bus_done_i   (bus_done),
    .bus_data_i   (bus_data),
    .bus_refused_i(bus_refused),
    .valid_o      (line_valid_o),
    .ready_i      (line_ready_i),
    .write_o      (line_write_o),
    .line_o,
    .mask_o       (line_mask_o),
    .line_data_o,
    .done_i       (line_done_i),
    .line_data_i
  );

  logic                 register_en, register_write, table_write;
  logic [          3:0] register_number;
  logic [         31:0] register_data, register_read, table_data, table_read;
  logic [TableBits-1:0] table_word;

  board_bus u_bus (
    .clk_i,
    .rst_ni,
    .valid_i         (bus_valid),
    .access_i        (access),
    .done_o          (bus_done),
    .data_o          (bus_data),
    .refused_o       (bus_refused),
    .m_axil_awvalid,
    .m_axil_awready,
    .m_axil_awaddr,
    .m_axil_wvalid,
    .m_axil_wready,
    .m_axil_wdata,
    .m_axil_bvalid,
    .m_axil_bresp,
    .m_axil_arvalid,
    .m_axil_arready,
    .m_axil_araddr,
    .m_axil_rvalid,
    .m_axil_rdata,
    .m_axil_rresp,
    // board_memory_port has it.
    .memory_en_o     (),
    .memory_write_o  (),
    .memory_address_o(),
    .memory_data_o   (),
    .memory_data_i   ('0),
    .register_en_o   (register_en),
    .register_write_o(register_write),
    .register_o      (register_number),
    .register_data_o (register_data),
    .register_data_i (register_read),
    .table_write_o   (table_write),
    .table_word_o    (table_word),
    .table_data_o    (table_data),
    .table_data_i    (table_read)
  );

  board_table #(
    .File(TableFile)
  ) u_table (
    .clk_i,
    .write_i(table_write),
    .word_i (table_word),
    .data_i (table_data),
    .data_o (table_read)
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
    .done_i   (done[0] && playing),
    .data_i   (data[0]),
    .refused_i(refused[0])
  );

  board_frames #(
    .ClockHz   (ClockHz),
    .ButtonsLow(ButtonsLow)
  ) u_frames (
    .clk_i,
    .rst_ni,
    .register_en_i   (register_en),
    .register_write_i(register_write),
    .register_i      (register_number),
    .register_data_i (register_data),
    .register_data_o (register_read),
    .play_o          (play),
    .play_word_o     (play_word),
    .play_camera_o   (play_camera),
    .playing_i       (playing),
    .valid_o         (frames_valid),
    .access_o        (frames_access),
    .done_i          (done[0] && !playing),
    .data_i          (data[0]),
    .row_event_i,
    .row_i,
    .drain_o         (unused_drain),
    .new_frame_o,
    .scale_o,
    .events_i        (events),
    .buttons_i,
    .leds_o
  );

  // Serial line.
  logic       rx_valid, rx_broken, tx_valid, tx_ready;
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
    .access_valid_o(valid[1]),
    .access_o      (access[1]),
    .done_i        (done[1]),
    .data_i        (data[1]),
    .refused_i     (refused[1]),
    .request_done_o(events.request_done),
    .request_bad_o (events.request_bad)
  );
endmodule
