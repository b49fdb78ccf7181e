// A small design with the pins of a board, for tests of the way through synthesis, place and route: serial line, requests,
// bus, table, a block RAM of the core, a multiplier, distributed memory, DVI pins. The core's registers are not there.
module small_design
  import board_pkg::*;
#(
  parameter string OctreeFile = "",
  parameter string TableFile  = ""
) (
  input  logic       clk,
  input  logic       uart_rx,
  output logic       uart_tx,
  input  logic [2:0] buttons,
  output logic [7:0] leds,
  output logic [0:0] high,
  output logic [3:0] dvi
);
  logic bit_clk, pixel_clk, system_clk, locked;

  board_pll u_pll (
    .clk_i       (clk),
    .bit_clk_o   (bit_clk),
    .pixel_clk_o (pixel_clk),
    .system_clk_o(system_clk),
    .chip_clk_o  (),
    .locked_o    (locked)
  );

  logic rst_n;

  board_reset u_reset (
    .clk_i   (system_clk),
    .locked_i(locked),
    .rst_no  (rst_n)
  );

  logic rx_valid, rx_broken, tx_valid, tx_ready, valid, refused, done_event, bad_event;
  logic [7:0] rx_byte, tx_byte;
  logic [1:0] done;
  logic [31:0] data;
  access_t access;

  board_uart u_uart (
    .clk_i   (system_clk),
    .rst_ni  (rst_n),
    .rx_i    (uart_rx),
    .valid_o (rx_valid),
    .broken_o(rx_broken),
    .byte_o  (rx_byte),
    .valid_i (tx_valid),
    .ready_o (tx_ready),
    .byte_i  (tx_byte),
    .tx_o    (uart_tx)
  );

  board_requests u_requests (
    .clk_i         (system_clk),
    .rst_ni        (rst_n),
    .valid_i       (rx_valid),
    .broken_i      (rx_broken),
    .byte_i        (rx_byte),
    .valid_o       (tx_valid),
    .ready_i       (tx_ready),
    .byte_o        (tx_byte),
    .access_valid_o(valid),
    .access_o      (access),
    .done_i        (done[1]),
    .data_i        (data),
    .refused_i     (refused),
    .request_done_o(done_event),
    .request_bad_o (bad_event)
  );

  logic memory_en, memory_write, register_en, register_write, table_write;
  logic [31:0] memory_address, memory_data, register_data, table_data, table_read, scratch_read;
  logic [12:0] memory_read;
  logic [3:0] register_number;
  logic [TableBits-1:0] table_word;

  board_bus u_bus (
    .clk_i           (system_clk),
    .rst_ni          (rst_n),
    .valid_i         ({valid, 1'b0}),
    .access_i        ({access, access_t'('0)}),
    .done_o          (done),
    .data_o          (data),
    .refused_o       (refused),
    .m_axil_awvalid  (),
    .m_axil_awready  (1'b1),
    .m_axil_awaddr   (),
    .m_axil_wvalid   (),
    .m_axil_wready   (1'b1),
    .m_axil_wdata    (),
    .m_axil_bvalid   (1'b1),
    .m_axil_bresp    (2'd2),
    .m_axil_arvalid  (),
    .m_axil_arready  (1'b1),
    .m_axil_araddr   (),
    .m_axil_rvalid   (1'b0),
    .m_axil_rdata    ('0),
    .m_axil_rresp    ('0),
    .memory_en_o     (memory_en),
    .memory_write_o  (memory_write),
    .memory_address_o(memory_address),
    .memory_data_o   (memory_data),
    .memory_data_i   ({19'd0, memory_read}),
    .register_en_o   (register_en),
    .register_write_o(register_write),
    .register_o      (register_number),
    .register_data_o (register_data),
    .register_data_i (scratch_read),
    .table_write_o   (table_write),
    .table_word_o    (table_word),
    .table_data_o    (table_data),
    .table_data_i    (table_read)
  );

  board_table #(
    .File(TableFile)
  ) u_table (
    .clk_i  (system_clk),
    .write_i(table_write),
    .word_i (table_word),
    .data_i (table_data),
    .data_o (table_read)
  );

  logic [12:0] b_read;

  voxrt_block_ram #(
    .Width(13),
    .Depth(2048),
    .File (OctreeFile)
  ) u_ram (
    .clk_i    (system_clk),
    .a_read_i (memory_en),
    .a_write_i(memory_en && memory_write),
    .a_row_i  (memory_address[12:2]),
    .a_data_i (memory_data[12:0]),
    .a_data_o (memory_read),
    .b_read_i (1'b1),
    .b_row_i  (memory_address[12:2] ^ 11'd1),
    .b_data_o (b_read)
  );

  // Registers: distributed memory; what is read is a product with a counter's. The registers before the product, one
  // with an enable, move into the multiplier.
  logic [31:0] scratch[16];
  logic [17:0] a_q, b_q;
  logic [35:0] product_q;

  always_ff @(posedge system_clk) begin
    if (register_en && register_write) scratch[register_number] <= register_data;
    if (register_en) a_q <= scratch[register_number][17:0];
    b_q          <= {5'd0, b_read};
    product_q    <= a_q * b_q;
    scratch_read <= scratch[register_number] + product_q[31:0];
    if (done_event || bad_event) leds <= leds + 8'(done_event) + {3'd0, bad_event, 4'd0} + 8'(buttons);
    if (!rst_n) leds <= '0;
  end

  assign high = '1;

  board_serializer u_dvi (
    .pixel_clk_i (pixel_clk),
    .pixel_rst_ni(rst_n),
    .bit_clk_i   (bit_clk),
    .words_i     ({10'b0000011111, product_q[29:0]}),
    .pins_o      (dvi)
  );
endmodule
