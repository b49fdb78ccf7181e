// A core with its octree in the processor's memory, for a Vivado block design, which takes Verilog modules only.
// Attributes name the interfaces. The parameters are those of cached16; cached1 to cached8 have other Lanes.
module voxrt_zynq_cached #(
  parameter integer Lanes        = 16,
  parameter integer MaxDepth     = 12,
  parameter integer PositionBits = 19,
  parameter integer BlockBits    = 24,
  parameter integer L1SetBits    = 5,
  parameter integer L2SetBits    = 9,
  parameter integer Lod          = 1
) (
  (* X_INTERFACE_PARAMETER = "ASSOCIATED_BUSIF s_axil:m_axi0:m_axi1:m_axis, ASSOCIATED_RESET rst_ni" *)
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
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARVALID" *)
  (* X_INTERFACE_PARAMETER = "READ_WRITE_MODE READ_ONLY, MAX_BURST_LENGTH 4, NUM_READ_OUTSTANDING 8" *)
  output wire        m_axi0_arvalid,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARREADY" *)
  input  wire        m_axi0_arready,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARADDR" *)
  output wire [31:0] m_axi0_araddr,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARLEN" *)
  output wire [ 7:0] m_axi0_arlen,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARSIZE" *)
  output wire [ 2:0] m_axi0_arsize,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARBURST" *)
  output wire [ 1:0] m_axi0_arburst,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARCACHE" *)
  output wire [ 3:0] m_axi0_arcache,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 ARPROT" *)
  output wire [ 2:0] m_axi0_arprot,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 RVALID" *)
  input  wire        m_axi0_rvalid,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 RREADY" *)
  output wire        m_axi0_rready,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 RDATA" *)
  input  wire [63:0] m_axi0_rdata,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 RRESP" *)
  input  wire [ 1:0] m_axi0_rresp,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi0 RLAST" *)
  input  wire        m_axi0_rlast,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARVALID" *)
  (* X_INTERFACE_PARAMETER = "READ_WRITE_MODE READ_ONLY, MAX_BURST_LENGTH 4, NUM_READ_OUTSTANDING 8" *)
  output wire        m_axi1_arvalid,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARREADY" *)
  input  wire        m_axi1_arready,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARADDR" *)
  output wire [31:0] m_axi1_araddr,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARLEN" *)
  output wire [ 7:0] m_axi1_arlen,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARSIZE" *)
  output wire [ 2:0] m_axi1_arsize,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARBURST" *)
  output wire [ 1:0] m_axi1_arburst,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARCACHE" *)
  output wire [ 3:0] m_axi1_arcache,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 ARPROT" *)
  output wire [ 2:0] m_axi1_arprot,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 RVALID" *)
  input  wire        m_axi1_rvalid,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 RREADY" *)
  output wire        m_axi1_rready,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 RDATA" *)
  input  wire [63:0] m_axi1_rdata,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 RRESP" *)
  input  wire [ 1:0] m_axi1_rresp,
  (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 m_axi1 RLAST" *)
  input  wire        m_axi1_rlast,
  output wire        m_axis_tvalid,
  input  wire        m_axis_tready,
  output wire [31:0] m_axis_tdata,
  output wire [ 3:0] m_axis_tkeep,
  output wire        m_axis_tuser,
  output wire        m_axis_tlast
);
  voxrt_core #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryForm  (2),
    .L1SetBits   (L1SetBits),
    .L2SetBits   (L2SetBits),
    .Lod         (Lod)
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
    .bram_en_i     (1'b0),
    .bram_we_i     (4'd0),
    .bram_addr_i   (32'd0),
    .bram_wrdata_i (32'd0),
    .bram_rddata_o (),
    .m_axi0_arvalid(m_axi0_arvalid),
    .m_axi0_arready(m_axi0_arready),
    .m_axi0_araddr (m_axi0_araddr),
    .m_axi0_arlen  (m_axi0_arlen),
    .m_axi0_arsize (m_axi0_arsize),
    .m_axi0_arburst(m_axi0_arburst),
    .m_axi0_arcache(m_axi0_arcache),
    .m_axi0_arprot (m_axi0_arprot),
    .m_axi0_rvalid (m_axi0_rvalid),
    .m_axi0_rready (m_axi0_rready),
    .m_axi0_rdata  (m_axi0_rdata),
    .m_axi0_rresp  (m_axi0_rresp),
    .m_axi0_rlast  (m_axi0_rlast),
    .m_axi1_arvalid(m_axi1_arvalid),
    .m_axi1_arready(m_axi1_arready),
    .m_axi1_araddr (m_axi1_araddr),
    .m_axi1_arlen  (m_axi1_arlen),
    .m_axi1_arsize (m_axi1_arsize),
    .m_axi1_arburst(m_axi1_arburst),
    .m_axi1_arcache(m_axi1_arcache),
    .m_axi1_arprot (m_axi1_arprot),
    .m_axi1_rvalid (m_axi1_rvalid),
    .m_axi1_rready (m_axi1_rready),
    .m_axi1_rdata  (m_axi1_rdata),
    .m_axi1_rresp  (m_axi1_rresp),
    .m_axi1_rlast  (m_axi1_rlast),
    .m_axis_tvalid (m_axis_tvalid),
    .m_axis_tready (m_axis_tready),
    .m_axis_tdata  (m_axis_tdata),
    .m_axis_tkeep  (m_axis_tkeep),
    .m_axis_tuser  (m_axis_tuser),
    .m_axis_tlast  (m_axis_tlast)
  );
endmodule
