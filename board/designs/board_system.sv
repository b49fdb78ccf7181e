// Everything between the clocks and the pins of a board: core, bus, player, serial line, memory, screen.
//
// The memory is on the chip (board_beam shows rows as they come), or with MemoryForm 2 in an SDRAM, behind caches
// (board_sdram_memory shows whole frames).
module board_system
  import board_pkg::*;
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes         = 1,
  parameter int unsigned MaxDepth      = 10,
  parameter int unsigned PositionBits  = 17,
  parameter int unsigned BlockBits     = 12,
  parameter int unsigned MemoryForm    = 0,
  parameter int unsigned L1SetBits     = 5,
  parameter int unsigned L2SetBits     = 9,
  parameter bit          Light         = 1'b0,
  parameter bit          Mirrors       = 1'b0,
  parameter int unsigned RayClocks     = 1,
  parameter int unsigned ClockHz       = 75_000_000,
  parameter int unsigned LineBits      = 4,
  parameter int unsigned ColumnBits    = 10,
  parameter int unsigned BootBlockBits = 12,
  parameter int unsigned PowerOnUs     = 200,
  parameter int unsigned GapBits       = 22,
  parameter bit          ButtonsLow    = 1'b0,
  // What the octree memory (with an SDRAM the boot memory) and the table hold from the beginning, for $readmemh.
  parameter string       OctreeFile    = "",
  parameter string       TableFile     = ""
) (
  // System clock.
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   rx_i,
  output logic                   tx_o,
  input  logic       [ 2:0]      buttons_i,
  output logic       [ 7:0]      leds_o,
  // SDRAM, to board_sdram_pins; 0 without one.
  output sdram_out_t             sdram_o,
  input  logic       [15:0]      sdram_dq_i,
  // Pixel clock.
  input  logic                   pixel_clk_i,
  input  logic                   pixel_rst_ni,
  output logic       [ 2:0][9:0] words_o        // DVI: blue, green, red.
);
  localparam bit Sdram = MemoryForm == CachedForm;
  localparam int unsigned AccessClocks = Sdram ? 2 : access_clocks(MemoryForm);

  // Accesses of serial line and player, and those that go over the bus.
  logic [1:0] master_valid, master_done, master_refused, bus_valid, bus_done;
  access_t [1:0] master_access;
  logic [1:0][31:0] master_data;
  logic [31:0] bus_data;
  logic bus_refused;

  // Core.
  logic awvalid, awready, wvalid, wready, bvalid, arvalid, arready, rvalid;
  logic [10:0] awaddr, araddr;
  logic [31:0] wdata, rdata;
  logic [1:0] bresp, rresp;
  logic memory_en, memory_write;
  logic [31:0] memory_address, memory_data, memory_read;
  logic stream_valid, stream_ready, stream_user, stream_last;
  logic [31:0] stream_data, frame_crc;
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
    .RayClocks   (RayClocks),
    .OctreeFile  (Sdram ? "" : OctreeFile)
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
    .interrupt_o   (),
    .bram_en_i     (memory_en),
    .bram_we_i     ({4{memory_write}}),
    .bram_addr_i   (memory_address),
    .bram_wrdata_i (memory_data),
    .bram_rddata_o (memory_read),
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

  // Control.
  logic register_en, register_write, table_write, row_event, drain, new_frame, flush;
  logic [3:0] register_number;
  logic [31:0] register_data, register_read, table_data, table_read;
  logic [TableBits-1:0] table_word;
  row_event_t row;
  logic [1:0] scale;

  board_control #(
    .ClockHz   (ClockHz),
    .LineBits  (LineBits),
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
    .flush_i         (flush),
    .row_event_i     (row_event),
    .row_i           (row),
    .frame_crc_i     (frame_crc),
    .drain_o         (drain),
    .new_frame_o     (new_frame),
    .scale_o         (scale)
  );

  board_bus #(
    .MemoryClocks(AccessClocks)
  ) u_bus (
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
    .memory_en_o     (memory_en),
    .memory_write_o  (memory_write),
    .memory_address_o(memory_address),
    .memory_data_o   (memory_data),
    .memory_data_i   (memory_read),
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

  board_frame_crc u_frame_crc (
    .clk_i,
    .rst_ni,
    .valid_i(stream_valid && stream_ready),
    .first_i(stream_user),
    .word_i (stream_data),
    .crc_o  (frame_crc)
  );

  // Memory and pixels.
  logic row_begin;
  logic [9:0] beam_row, beam_column;
  logic [23:0] beam_pixel;

  if (Sdram) begin : gen_sdram
    board_sdram_memory #(
      .BootBlockBits(BootBlockBits),
      .ClockHz      (ClockHz),
      .PowerOnUs    (PowerOnUs),
      .OctreeFile   (OctreeFile)
    ) u_memory (
      .clk_i,
      .rst_ni,
      .sdram_o,
      .sdram_dq_i,
      .axi_i        (axi_request),
      .axi_o        (axi_response),
      .valid_i      (master_valid),
      .access_i     (master_access),
      .done_o       (master_done),
      .data_o       (master_data),
      .refused_o    (master_refused),
      .bus_valid_o  (bus_valid),
      .bus_done_i   (bus_done),
      .bus_data_i   (bus_data),
      .bus_refused_i(bus_refused),
      .new_frame_i  (new_frame),
      .scale_i      (scale),
      .flush_o      (flush),
      .s_axis_tvalid(stream_valid),
      .s_axis_tready(stream_ready),
      .s_axis_tdata (stream_data),
      .s_axis_tuser (stream_user),
      .s_axis_tlast (stream_last),
      .row_event_o  (row_event),
      .row_o        (row),
      .pixel_clk_i,
      .pixel_rst_ni,
      .row_begin_i  (row_begin),
      .row_i        (beam_row),
      .column_i     (beam_column),
      .pixel_o      (beam_pixel)
    );
  end else begin : gen_on_chip
    assign bus_valid      = master_valid;
    assign master_done    = bus_done;
    assign master_data    = {2{bus_data}};
    assign master_refused = {2{bus_refused}};
    assign axi_response   = '0;
    assign flush          = 1'b0;
    assign sdram_o        = '0;

    board_beam #(
      .LineBits  (LineBits),
      .ColumnBits(ColumnBits)
    ) u_beam (
      .clk_i,
      .rst_ni,
      .new_frame_i  (new_frame),
      .drain_i      (drain),
      .scale_i      (scale),
      .s_axis_tvalid(stream_valid),
      .s_axis_tready(stream_ready),
      .s_axis_tdata (stream_data),
      .s_axis_tuser (stream_user),
      .s_axis_tlast (stream_last),
      .row_event_o  (row_event),
      .row_o        (row),
      .pixel_clk_i,
      .pixel_rst_ni,
      .row_begin_i  (row_begin),
      .row_i        (beam_row),
      .column_i     (beam_column),
      .pixel_o      (beam_pixel)
    );
  end

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
