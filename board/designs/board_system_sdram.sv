// Everything between the clocks and the pins of a board whose octree and frames are in SDRAM: core, control, SDRAM,
// frames, screen. The screen shows whole frames at its own rate, whatever a scene costs.
//
// Lines of 32 bytes in the SDRAM: up to 0xEFFFF the octree, word 0 at the end of line 0; from 0xF0000 on two frames, each
// of 480 rows of 64 lines.
module board_system_sdram
  import board_pkg::*;
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes         = 2,
  parameter int unsigned MaxDepth      = 12,
  parameter int unsigned PositionBits  = 19,
  parameter int unsigned BlockBits     = 20,
  parameter int unsigned MemoryForm    = 2,
  parameter int unsigned L1SetBits     = 5,
  parameter int unsigned L2SetBits     = 9,
  parameter bit          Light         = 1'b0,
  parameter bit          Mirrors       = 1'b0,
  parameter int unsigned RayClocks     = 1,
  parameter int unsigned BootBlockBits = 12,
  parameter int unsigned ClockHz       = 57_692_307,
  parameter int unsigned PowerOnUs     = 200,
  parameter int unsigned GapBits       = 22,
  parameter bit          ButtonsLow    = 1'b0,
  // What boot memory and table hold from the beginning, for $readmemh.
  parameter string       OctreeFile    = "",
  parameter string       TableFile     = ""
) (
  // System clock.
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             rx_i,
  output logic             tx_o,
  input  logic [ 2:0]      buttons_i,
  output logic [ 7:0]      leds_o,
  // SDRAM, to board_sdram_pins.
  output logic             sdram_cke_o,
  output logic             sdram_cs_no,
  output logic             sdram_ras_no,
  output logic             sdram_cas_no,
  output logic             sdram_we_no,
  output logic [ 1:0]      sdram_ba_o,
  output logic [12:0]      sdram_a_o,
  output logic [ 1:0]      sdram_dqm_o,
  output logic             sdram_dq_oe_o,
  output logic [15:0]      sdram_dq_o,
  input  logic [15:0]      sdram_dq_i,
  // Pixel clock.
  input  logic             pixel_clk_i,
  input  logic             pixel_rst_ni,
  output logic [ 2:0][9:0] words_o         // DVI: blue, green, red.
);
  if (MemoryForm != CachedForm) $error("board_system_sdram: MemoryForm must be 2, behind caches");

  // Ports of the arbiter: the screen, the core's two, words of the host and of lists, the boot scene, the core's pixels.
  localparam int unsigned Screen = 0;
  localparam int unsigned Core = 1;
  localparam int unsigned Words = 3;
  localparam int unsigned Boot = 4;
  localparam int unsigned Pixels = 5;
  localparam int unsigned Ports = 6;

  logic [Ports-1:0] valid, ready, writes, done;
  logic [Ports-1:0][19:0] lines;
  logic [Ports-1:0][15:0] masks;
  logic [Ports-1:0][255:0] data;
  logic urgent, request_valid, request_ready, request_write, request_done;
  logic [19:0] request_line;
  logic [15:0] request_mask;
  logic [255:0] request_data, read_data;

  // Core.
  logic awvalid, awready, wvalid, wready, bvalid, arvalid, arready, rvalid;
  logic [10:0] awaddr, araddr;
  logic [31:0] wdata, rdata;
  logic [1:0] bresp, rresp;
  logic stream_valid, stream_ready, stream_user, stream_last;
  logic [31:0] stream_data, unused_memory_read;
  logic [3:0] unused_keep;
  axi_read_request_t [1:0] axi_request;
  axi_read_response_t [1:0] axi_response;

  voxrt_core #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryForm  (MemoryForm),
    .L1SetBits   (L1SetBits),
    .L2SetBits   (L2SetBits),
    .Light       (Light),
    .Mirrors     (Mirrors),
    .RayClocks   (RayClocks)
  ) u_core (
    .clk_i,
    .rst_ni,
    .s_axil_awvalid(awvalid),
    .s_axil_awready(awready),
    .s_axil_awaddr (awaddr),
    .s_axil_awprot (3'd0),
    .s_axil_wvalid (wvalid),
    .s_axil_wready (wready),
    .s_axil_wdata  (wdata),
    .s_axil_wstrb  (4'hF),
    .s_axil_bvalid (bvalid),
    .s_axil_bready (1'b1),
    .s_axil_bresp  (bresp),
    .s_axil_arvalid(arvalid),
    .s_axil_arready(arready),
    .s_axil_araddr (araddr),
    .s_axil_arprot (3'd0),
    .s_axil_rvalid (rvalid),
    .s_axil_rready (1'b1),
    .s_axil_rdata  (rdata),
    .s_axil_rresp  (rresp),
    // No octree memory of its own.
    .bram_en_i     (1'b0),
    .bram_we_i     (4'd0),
    .bram_addr_i   ('0),
    .bram_wrdata_i ('0),
    .bram_rddata_o (unused_memory_read),
    // Bursts are always the same.
    .m_axi0_arvalid(axi_request[0].arvalid),
    .m_axi0_araddr (axi_request[0].araddr),
    .m_axi0_arlen  (),
    .m_axi0_arsize (),
    .m_axi0_arburst(),
    .m_axi0_arcache(),
    .m_axi0_arprot (),
    .m_axi0_rready (axi_request[0].rready),
    .m_axi0_arready(axi_response[0].arready),
    .m_axi0_rvalid (axi_response[0].rvalid),
    .m_axi0_rdata  (axi_response[0].rdata),
    .m_axi0_rresp  (axi_response[0].rresp),
    .m_axi0_rlast  (1'b0),
    .m_axi1_arvalid(axi_request[1].arvalid),
    .m_axi1_araddr (axi_request[1].araddr),
    .m_axi1_arlen  (),
    .m_axi1_arsize (),
    .m_axi1_arburst(),
    .m_axi1_arcache(),
    .m_axi1_arprot (),
    .m_axi1_rready (axi_request[1].rready),
    .m_axi1_arready(axi_response[1].arready),
    .m_axi1_rvalid (axi_response[1].rvalid),
    .m_axi1_rdata  (axi_response[1].rdata),
    .m_axi1_rresp  (axi_response[1].rresp),
    .m_axi1_rlast  (1'b0),
    .m_axis_tvalid (stream_valid),
    .m_axis_tready (stream_ready),
    .m_axis_tdata  (stream_data),
    .m_axis_tkeep  (unused_keep),
    .m_axis_tuser  (stream_user),
    .m_axis_tlast  (stream_last)
  );

  for (genvar i = 0; i < 2; i++) begin : gen_axi
    board_sdram_axi u_axi (
      .clk_i,
      .rst_ni,
      .axi_i  (axi_request[i]),
      .axi_o  (axi_response[i]),
      .valid_o(valid[Core+i]),
      .ready_i(ready[Core+i]),
      .line_o (lines[Core+i]),
      .done_i (done[Core+i]),
      .data_i (read_data)
    );
  end

  // Control. No frame starts before the boot scene is in the SDRAM.
  logic register_en, register_write, table_write, row_event, new_frame, booting, written, written_q;
  logic unused_drain;
  logic [3:0] register_number;
  logic [31:0] register_data, register_read, table_data, table_read;
  logic [TableBits-1:0] table_word;
  row_event_t row;
  logic [1:0] scale;

  logic [1:0] master_valid, master_done, master_refused, bus_valid, bus_done;
  access_t [1:0] master_access;
  logic [1:0][31:0] master_data;
  logic [31:0] bus_data;
  logic bus_refused;

  board_control #(
    .ClockHz   (ClockHz),
    .GapBits   (GapBits),
    .ButtonsLow(ButtonsLow),
    .TableFile (TableFile)
  ) u_control (
    .clk_i,
    .rst_ni,
    .rx_i,
    .tx_o,
    .buttons_i,
    .leds_o,
    .valid_o         (master_valid),
    .access_o        (master_access),
    .done_i          (master_done),
    .data_i          (master_data),
    .refused_i       (master_refused),
    .register_en_i   (register_en),
    .register_write_i(register_write),
    .register_i      (register_number),
    .register_data_i (register_data),
    .register_data_o (register_read),
    .table_write_i   (table_write),
    .table_word_i    (table_word),
    .table_data_i    (table_data),
    .table_data_o    (table_read),
    .flush_i         (written_q),
    .row_event_i     (row_event && !booting),
    .row_i           (row),
    .drain_o         (unused_drain),
    .new_frame_o     (new_frame),
    .scale_o         (scale)
  );

  // What was written since the last frame started may be in the core's caches as it was before.
  always_ff @(posedge clk_i) begin
    if (new_frame) written_q <= 1'b0;
    if (written) written_q <= 1'b1;
    if (!rst_ni) written_q <= 1'b0;
  end

  board_memory_port u_memory (
    .clk_i,
    .rst_ni,
    .valid_i      (master_valid),
    .access_i     (master_access),
    .done_o       (master_done),
    .data_o       (master_data),
    .refused_o    (master_refused),
    .written_o    (written),
    .bus_valid_o  (bus_valid),
    .bus_done_i   (bus_done),
    .bus_data_i   (bus_data),
    .bus_refused_i(bus_refused),
    .valid_o      (valid[Words]),
    .ready_i      (ready[Words]),
    .write_o      (writes[Words]),
    .line_o       (lines[Words]),
    .mask_o       (masks[Words]),
    .line_data_o  (data[Words]),
    .done_i       (done[Words]),
    .line_data_i  (read_data)
  );

  board_bus u_bus (
    .clk_i,
    .rst_ni,
    .valid_i         (bus_valid),
    .access_i        (master_access),
    .done_o          (bus_done),
    .data_o          (bus_data),
    .refused_o       (bus_refused),
    .m_axil_awvalid  (awvalid),
    .m_axil_awready  (awready),
    .m_axil_awaddr   (awaddr),
    .m_axil_wvalid   (wvalid),
    .m_axil_wready   (wready),
    .m_axil_wdata    (wdata),
    .m_axil_bvalid   (bvalid),
    .m_axil_bresp    (bresp),
    .m_axil_arvalid  (arvalid),
    .m_axil_arready  (arready),
    .m_axil_araddr   (araddr),
    .m_axil_rvalid   (rvalid),
    .m_axil_rdata    (rdata),
    .m_axil_rresp    (rresp),
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

  board_boot_copy #(
    .BlockBits(BootBlockBits),
    .File     (OctreeFile)
  ) u_boot (
    .clk_i,
    .rst_ni,
    .busy_o (booting),
    .valid_o(valid[Boot]),
    .ready_i(ready[Boot]),
    .line_o (lines[Boot]),
    .data_o (data[Boot]),
    .done_i (done[Boot])
  );

  // SDRAM. Screen and core do not write.
  for (genvar i = 0; i < Words; i++) begin : gen_read_only
    assign writes[i] = 1'b0;
    assign masks[i]  = '0;
    assign data[i]   = '0;
  end

  assign writes[Boot]   = 1'b1;
  assign masks[Boot]    = '1;
  assign writes[Pixels] = 1'b1;

  board_sdram_arbiter #(
    .Ports(Ports)
  ) u_arbiter (
    .clk_i,
    .rst_ni,
    .urgent_i       (urgent),
    .valid_i        (valid),
    .ready_o        (ready),
    .write_i        (writes),
    .line_i         (lines),
    .mask_i         (masks),
    .data_i         (data),
    .done_o         (done),
    .request_valid_o(request_valid),
    .request_ready_i(request_ready),
    .request_write_o(request_write),
    .request_line_o (request_line),
    .request_mask_o (request_mask),
    .request_data_o (request_data),
    .done_i         (request_done)
  );

  board_sdram #(
    .ClockHz  (ClockHz),
    .PowerOnUs(PowerOnUs)
  ) u_sdram (
    .clk_i,
    .rst_ni,
    .request_valid_i(request_valid),
    .request_ready_o(request_ready),
    .request_write_i(request_write),
    .request_line_i (request_line),
    .request_mask_i (request_mask),
    .request_data_i (request_data),
    .done_o         (request_done),
    .line_o         (read_data),
    .sdram_cke_o,
    .sdram_cs_no,
    .sdram_ras_no,
    .sdram_cas_no,
    .sdram_we_no,
    .sdram_ba_o,
    .sdram_a_o,
    .sdram_dqm_o,
    .sdram_dq_oe_o,
    .sdram_dq_o,
    .sdram_dq_i
  );

  // Frames.
  logic hold, drawn, shown, visible, reading;
  logic [1:0] shown_scale;
  logic row_begin;
  logic [9:0] beam_row, beam_column;
  logic [23:0] beam_pixel;

  board_frame_swap u_swap (
    .clk_i,
    .rst_ni,
    .new_frame_i  (new_frame),
    .scale_i      (scale),
    .reading_i    (reading),
    .hold_o       (hold),
    .drawn_o      (drawn),
    .shown_o      (shown),
    .shown_scale_o(shown_scale),
    .visible_o    (visible)
  );

  board_frame_writer u_writer (
    .clk_i,
    .rst_ni,
    .frame_i      (drawn),
    .hold_i       (hold),
    .s_axis_tvalid(stream_valid),
    .s_axis_tready(stream_ready),
    .s_axis_tdata (stream_data),
    .s_axis_tuser (stream_user),
    .s_axis_tlast (stream_last),
    .valid_o      (valid[Pixels]),
    .ready_i      (ready[Pixels]),
    .line_o       (lines[Pixels]),
    .mask_o       (masks[Pixels]),
    .data_o       (data[Pixels])
  );

  board_frame_reader u_reader (
    .clk_i,
    .rst_ni,
    .visible_i  (visible),
    .frame_i    (shown),
    .scale_i    (shown_scale),
    .reading_o  (reading),
    .row_event_o(row_event),
    .row_o      (row),
    .valid_o    (valid[Screen]),
    .ready_i    (ready[Screen]),
    .urgent_o   (urgent),
    .line_o     (lines[Screen]),
    .done_i     (done[Screen]),
    .data_i     (read_data),
    .pixel_clk_i,
    .pixel_rst_ni,
    .row_begin_i(row_begin),
    .row_i      (beam_row),
    .column_i   (beam_column),
    .pixel_o    (beam_pixel)
  );

  board_screen u_screen (
    .clk_i      (pixel_clk_i),
    .rst_ni     (pixel_rst_ni),
    .row_begin_o(row_begin),
    .row_o      (beam_row),
    .column_o   (beam_column),
    .pixel_i    (beam_pixel),
    .words_o
  );
endmodule
