// Everything between the clocks and the pins of a board: core, bus, player, frames, serial line, line buffer, screen.
module board_system
  import board_pkg::*;
#(
  parameter int unsigned Lanes        = 1,
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned BlockBits    = 12,
  parameter int unsigned MemoryForm   = 0,
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  parameter int unsigned RayClocks    = 1,
  parameter int unsigned ClockHz      = 75_000_000,
  parameter int unsigned LineBits     = 4,
  parameter int unsigned ColumnBits   = 10,
  parameter int unsigned GapBits      = 22,
  parameter bit          ButtonsLow   = 1'b0,
  // What the octree memory and the table hold from the beginning, for $readmemh.
  parameter string       OctreeFile   = "",
  parameter string       TableFile    = ""
) (
  // System clock.
  input  logic            clk_i,
  input  logic            rst_ni,
  input  logic            rx_i,
  output logic            tx_o,
  input  logic [2:0]      buttons_i,
  output logic [7:0]      leds_o,
  // Pixel clock.
  input  logic            pixel_clk_i,
  input  logic            pixel_rst_ni,
  output logic [2:0][9:0] words_o        // DVI: blue, green, red.
);
  localparam int unsigned AccessClocks = voxrt_pkg::access_clocks(MemoryForm);

  logic [1:0] bus_valid, bus_done;
  access_t [1:0] bus_access;
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
  logic [31:0] stream_data;
  logic [3:0] unused_keep;

  voxrt_core #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryForm  (MemoryForm),
    .Light       (Light),
    .Mirrors     (Mirrors),
    .RayClocks   (RayClocks),
    .OctreeFile  (OctreeFile)
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
    .bram_en_i     (memory_en),
    .bram_we_i     ({4{memory_write}}),
    .bram_addr_i   (memory_address),
    .bram_wrdata_i (memory_data),
    .bram_rddata_o (memory_read),
    // No external memory.
    .m_axi0_arvalid(),
    .m_axi0_araddr (),
    .m_axi0_arlen  (),
    .m_axi0_arsize (),
    .m_axi0_arburst(),
    .m_axi0_arcache(),
    .m_axi0_arprot (),
    .m_axi0_rready (),
    .m_axi0_arready(1'b0),
    .m_axi0_rvalid (1'b0),
    .m_axi0_rdata  (64'b0),
    .m_axi0_rresp  (2'b0),
    .m_axi0_rlast  (1'b0),
    .m_axi1_arvalid(),
    .m_axi1_araddr (),
    .m_axi1_arlen  (),
    .m_axi1_arsize (),
    .m_axi1_arburst(),
    .m_axi1_arcache(),
    .m_axi1_arprot (),
    .m_axi1_rready (),
    .m_axi1_arready(1'b0),
    .m_axi1_rvalid (1'b0),
    .m_axi1_rdata  (64'b0),
    .m_axi1_rresp  (2'b0),
    .m_axi1_rlast  (1'b0),
    .m_axis_tvalid (stream_valid),
    .m_axis_tready (stream_ready),
    .m_axis_tdata  (stream_data),
    .m_axis_tkeep  (unused_keep),
    .m_axis_tuser  (stream_user),
    .m_axis_tlast  (stream_last)
  );

  // Control.
  logic register_en, register_write, table_write, row_event, drain, new_frame;
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
    .valid_o         (bus_valid),
    .access_o        (bus_access),
    .done_i          (bus_done),
    .data_i          ({2{bus_data}}),
    .refused_i       ({2{bus_refused}}),
    .register_en_i   (register_en),
    .register_write_i(register_write),
    .register_i      (register_number),
    .register_data_i (register_data),
    .register_data_o (register_read),
    .table_write_i   (table_write),
    .table_word_i    (table_word),
    .table_data_i    (table_data),
    .table_data_o    (table_read),
    .flush_i         (1'b0),
    .row_event_i     (row_event),
    .row_i           (row),
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
    .access_i        (bus_access),
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

  // Pixels.
  logic row_begin;
  logic [1:0] pixel_scale;
  logic [9:0] beam_row, beam_column;
  logic [23:0] pixel, beam_pixel;
  logic pixel_valid, pixel_ready, line_end;

  board_unpacker u_unpacker (
    .clk_i,
    .rst_ni,
    .s_axis_tvalid(stream_valid),
    .s_axis_tready(stream_ready),
    .s_axis_tdata (stream_data),
    .s_axis_tuser (stream_user),
    .s_axis_tlast (stream_last),
    .valid_o      (pixel_valid),
    .ready_i      (pixel_ready),
    .pixel_o      (pixel),
    .line_end_o   (line_end)
  );

  for (genvar i = 0; i < 2; i++) begin : gen_scale
    board_synchronizer u_scale (
      .clk_i(pixel_clk_i),
      .bit_i(scale[i]),
      .bit_o(pixel_scale[i])
    );
  end

  board_line_buffer #(
    .LineBits  (LineBits),
    .ColumnBits(ColumnBits)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .valid_i    (pixel_valid),
    .ready_o    (pixel_ready),
    .pixel_i    (pixel),
    .line_end_i (line_end),
    .drain_i    (drain),
    .new_frame_i(new_frame),
    .row_event_o(row_event),
    .row_o      (row),
    .pixel_clk_i,
    .pixel_rst_ni,
    .scale_i    (pixel_scale),
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
