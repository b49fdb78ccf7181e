// The z1 configuration for a Vivado block design, which takes Verilog modules only. Attributes name the interfaces.
module voxrt_pynq_z1 (
  (* X_INTERFACE_PARAMETER = "ASSOCIATED_BUSIF s_axil:m_axis, ASSOCIATED_RESET rst_ni" *)
  input  wire        clk_i,
  (* X_INTERFACE_PARAMETER = "POLARITY ACTIVE_LOW" *)
  input  wire        rst_ni,
  input  wire        s_axil_awvalid,
  output wire        s_axil_awready,
  input  wire [10:0] s_axil_awaddr,
  input  wire [ 2:0] s_axil_awprot,
  input  wire        s_axil_wvalid,
  output wire        s_axil_wready,
  input  wire [31:0] s_axil_wdata,
  input  wire [ 3:0] s_axil_wstrb,
  output wire        s_axil_bvalid,
  input  wire        s_axil_bready,
  output wire [ 1:0] s_axil_bresp,
  input  wire        s_axil_arvalid,
  output wire        s_axil_arready,
  input  wire [10:0] s_axil_araddr,
  input  wire [ 2:0] s_axil_arprot,
  output wire        s_axil_rvalid,
  input  wire        s_axil_rready,
  output wire [31:0] s_axil_rdata,
  output wire [ 1:0] s_axil_rresp,
  (* X_INTERFACE_INFO = "xilinx.com:signal:interrupt:1.0 interrupt INTERRUPT" *)
  (* X_INTERFACE_PARAMETER = "SENSITIVITY LEVEL_HIGH" *)
  output wire        interrupt_o,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram EN" *)
  (* X_INTERFACE_PARAMETER = "MASTER_TYPE BRAM_CTRL, MEM_SIZE 131072, MEM_WIDTH 32, READ_LATENCY 3" *)
  input  wire        bram_en_i,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram WE" *)
  input  wire [ 3:0] bram_we_i,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram ADDR" *)
  input  wire [31:0] bram_addr_i,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram DIN" *)
  input  wire [31:0] bram_wrdata_i,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram DOUT" *)
  output wire [31:0] bram_rddata_o,
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram CLK" *)
  input  wire        bram_clk_i,  // The same clock as clk_i; there for the interface.
  (* X_INTERFACE_INFO = "xilinx.com:interface:bram:1.0 bram RST" *)
  input  wire        bram_rst_i,
  output wire        m_axis_tvalid,
  input  wire        m_axis_tready,
  output wire [31:0] m_axis_tdata,
  output wire [ 3:0] m_axis_tkeep,
  output wire        m_axis_tuser,
  output wire        m_axis_tlast
);
  voxrt_core #(
    .Lanes       (16),
    .MaxDepth    (10),
    .PositionBits(17),
    .BlockBits   (12),
    .MemoryForm  (0)
  ) u_core (
    .clk_i         (clk_i),
    .rst_ni        (rst_ni),
    .s_axil_awvalid(s_axil_awvalid),
    .s_axil_awready(s_axil_awready),
    .s_axil_awaddr (s_axil_awaddr),
    .s_axil_awprot (s_axil_awprot),
    .s_axil_wvalid (s_axil_wvalid),
    .s_axil_wready (s_axil_wready),
    .s_axil_wdata  (s_axil_wdata),
    .s_axil_wstrb  (s_axil_wstrb),
    .s_axil_bvalid (s_axil_bvalid),
    .s_axil_bready (s_axil_bready),
    .s_axil_bresp  (s_axil_bresp),
    .s_axil_arvalid(s_axil_arvalid),
    .s_axil_arready(s_axil_arready),
    .s_axil_araddr (s_axil_araddr),
    .s_axil_arprot (s_axil_arprot),
    .s_axil_rvalid (s_axil_rvalid),
    .s_axil_rready (s_axil_rready),
    .s_axil_rdata  (s_axil_rdata),
    .s_axil_rresp  (s_axil_rresp),
    .interrupt_o   (interrupt_o),
    .bram_en_i     (bram_en_i),
    .bram_we_i     (bram_we_i),
    .bram_addr_i   (bram_addr_i),
    .bram_wrdata_i (bram_wrdata_i),
    .bram_rddata_o (bram_rddata_o),
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
    .m_axi0_rdata  (64'd0),
    .m_axi0_rresp  (2'd0),
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
    .m_axi1_rdata  (64'd0),
    .m_axi1_rresp  (2'd0),
    .m_axi1_rlast  (1'b0),
    .m_axis_tvalid (m_axis_tvalid),
    .m_axis_tready (m_axis_tready),
    .m_axis_tdata  (m_axis_tdata),
    .m_axis_tkeep  (m_axis_tkeep),
    .m_axis_tuser  (m_axis_tuser),
    .m_axis_tlast  (m_axis_tlast)
  );
endmodule
