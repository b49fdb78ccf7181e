// AXI4-Lite rules of the register block: an answer stays until taken, each request has one, and none comes unasked. A
// word of a register that is plain storage (the up vector's first component) reads back as it was last written,
// whatever else goes on. The material table, which lies outside the block, is taken to answer a clock after it is
// asked.
module voxrt_registers_properties
  import voxrt_registers_pkg::*;
(
  input logic        clk_i,
  input logic        rst_ni,
  input logic        awvalid,
  input logic [10:0] awaddr,
  input logic        wvalid,
  input logic [31:0] wdata,
  input logic [ 3:0] wstrb,
  input logic        bready,
  input logic        arvalid,
  input logic [10:0] araddr,
  input logic        rready,
  input logic [31:0] status_bits,  // What the core says, free.
  input logic [31:0] table_word
);
  // Address of `up`, component x.
  localparam logic [10:0] Storage = 11'h050;

  logic awready, wready, bvalid, arready, rvalid;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;

  voxrt_registers__in_t hwif_in;
  voxrt_registers__out_t hwif_out;

  logic table_reads_q, table_writes_q;
  always_ff @(posedge clk_i) begin
    table_reads_q  <= rst_ni && hwif_out.materials.req && !hwif_out.materials.req_is_wr;
    table_writes_q <= rst_ni && hwif_out.materials.req && hwif_out.materials.req_is_wr;
  end

  always_comb begin
    hwif_in.configuration.lanes.next         = status_bits[7:0];
    hwif_in.configuration.max_depth.next     = status_bits[12:8];
    hwif_in.configuration.position_bits.next = status_bits[18:13];
    hwif_in.configuration.block_bits.next    = status_bits[23:19];
    hwif_in.configuration.banked.next        = status_bits[24];
    hwif_in.status.busy.next                 = status_bits[25];
    hwif_in.status.frame_done.hwset          = status_bits[26];
    hwif_in.status.direction_overflow.hwset  = status_bits[27];
    hwif_in.status.bad_pointer.hwset         = status_bits[28];
    hwif_in.status.step_limit.hwset          = status_bits[29];
    hwif_in.cycles.value.next                = table_word;
    hwif_in.rays.value.next                  = table_word;
    hwif_in.words_read.value.next            = table_word;
    hwif_in.hits.value.next                  = table_word;
    hwif_in.stalls.value.next                = table_word;
    hwif_in.materials.rd_ack                 = table_reads_q;
    hwif_in.materials.rd_data                = table_word;
    hwif_in.materials.wr_ack                 = table_writes_q;
  end

  voxrt_registers dut (
    .clk           (clk_i),
    .rst_n         (rst_ni),
    .s_axil_awready(awready),
    .s_axil_awvalid(awvalid),
    .s_axil_awaddr (awaddr),
    .s_axil_awprot (3'b000),
    .s_axil_wready (wready),
    .s_axil_wvalid (wvalid),
    .s_axil_wdata  (wdata),
    .s_axil_wstrb  (wstrb),
    .s_axil_bready (bready),
    .s_axil_bvalid (bvalid),
    .s_axil_bresp  (bresp),
    .s_axil_arready(arready),
    .s_axil_arvalid(arvalid),
    .s_axil_araddr (araddr),
    .s_axil_arprot (3'b000),
    .s_axil_rready (rready),
    .s_axil_rvalid (rvalid),
    .s_axil_rdata  (rdata),
    .s_axil_rresp  (rresp),
    .hwif_in,
    .hwif_out
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);
  always_comb if (started_q) assume (rst_ni);

  // The other side keeps the rules too: what it offers stays until taken.
  logic awvalid_q, awready_q, wvalid_q, wready_q, arvalid_q, arready_q, bvalid_q, bready_q, rvalid_q, rready_q;
  logic [10:0] awaddr_q, araddr_q;
  logic [31:0] wdata_q, rdata_q;
  logic [3:0] wstrb_q;
  logic [1:0] bresp_q, rresp_q;
  always_ff @(posedge clk_i) begin
    {awvalid_q, awready_q, awaddr_q}       <= {awvalid, awready, awaddr};
    {wvalid_q, wready_q, wdata_q, wstrb_q} <= {wvalid, wready, wdata, wstrb};
    {arvalid_q, arready_q, araddr_q}       <= {arvalid, arready, araddr};
    {bvalid_q, bready_q, bresp_q}          <= {bvalid, bready, bresp};
    {rvalid_q, rready_q, rdata_q, rresp_q} <= {rvalid, rready, rdata, rresp};
    if (!rst_ni) {awvalid_q, wvalid_q, arvalid_q, bvalid_q, rvalid_q} <= '0;
  end

  always_comb begin
    if (awvalid_q && !awready_q) assume (awvalid && awaddr == awaddr_q);
    if (wvalid_q && !wready_q) assume (wvalid && wdata == wdata_q && wstrb == wstrb_q);
    if (arvalid_q && !arready_q) assume (arvalid && araddr == araddr_q);
  end

  // Requests taken and not answered yet.
  logic [2:0] addresses_q, words_q, reads_q;
  always_ff @(posedge clk_i) begin
    addresses_q <= addresses_q + 3'(awvalid && awready) - 3'(bvalid && bready);
    words_q     <= words_q + 3'(wvalid && wready) - 3'(bvalid && bready);
    reads_q     <= reads_q + 3'(arvalid && arready) - 3'(rvalid && rready);
    if (!rst_ni) {addresses_q, words_q, reads_q} <= '0;
  end

  // What storage holds: the last write that was answered for. One write at a time, so that the last is known.
  logic writes_storage_q, reads_storage_q, clean_q;
  logic [15:0] pending_q, stored_q;
  logic [1:0] mask_q;
  always_comb if (addresses_q != '0) assume (!awvalid);
  always_comb if (words_q != '0) assume (!wvalid);
  always_ff @(posedge clk_i) begin
    if (awvalid && awready) writes_storage_q <= {awaddr[10:2], 2'b00} == Storage;
    if (wvalid && wready) {mask_q, pending_q} <= {wstrb[1:0], wdata[15:0]};
    if (bvalid && bready && writes_storage_q) begin
      if (mask_q[0]) stored_q[7:0] <= pending_q[7:0];
      if (mask_q[1]) stored_q[15:8] <= pending_q[15:8];
    end
    // A read taken while no write was under way must give it, if none comes before the answer.
    if (arvalid && arready && reads_q == '0) begin
      reads_storage_q <= {araddr[10:2], 2'b00} == Storage;
      clean_q         <= addresses_q == '0 && words_q == '0 && !awvalid && !wvalid;
    end else begin
      if (awvalid || wvalid || (arvalid && arready)) clean_q <= 1'b0;
    end
    if (!rst_ni) begin
      stored_q <= '0;
      clean_q  <= 1'b0;
    end
  end

  always_comb begin
    if (started_q) begin
      if (bvalid_q && !bready_q) assert (bvalid && bresp == bresp_q);
      if (rvalid_q && !rready_q) assert (rvalid && rdata == rdata_q && rresp == rresp_q);
      if (bvalid) assert (addresses_q != '0 && words_q != '0);
      if (rvalid) assert (reads_q != '0);
      if (bvalid) assert (bresp == 2'b00 || bresp == 2'b10);
      if (rvalid && clean_q && reads_storage_q && reads_q == 3'd1) assert (rdata[15:0] == stored_q && rresp == 2'b00);
    end
  end

  // Each request is answered within six clocks once the other side takes all answers.
  logic [3:0] patience_q;
  always_ff @(posedge clk_i) begin
    patience_q <= (bready && rready && (reads_q != '0 || (addresses_q != '0 && words_q != '0)))
                  && !(bvalid && bready) && !(rvalid && rready) ? patience_q + 4'd1 : '0;
    if (!rst_ni) patience_q <= '0;
  end
  always_comb if (started_q) assert (patience_q < 4'd6);

  always_ff @(posedge clk_i) begin
    cover (started_q && bvalid && bready && writes_storage_q && mask_q == 2'b11);
    cover (started_q && rvalid && clean_q && reads_storage_q && reads_q == 3'd1 && stored_q == 16'h1234);
    cover (started_q && rvalid && reads_q == 3'd2);
  end
endmodule
