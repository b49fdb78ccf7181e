// The ray tracer as a core for a block design: AXI4-Lite registers, AXI4-Stream video, and a memory port for an AXI
// BRAM controller. One clock, one synchronous reset; a reset of one clock is enough.
//
// Registers: registers.rdl. Stream: voxrt_pixel_packer.
//
// Memory port: byte addresses, 32-bit words of the report dialect or, as the register lod says, of the dialect lod;
// whole words only (all of bram_we_i or none). A word read comes access_clocks(MemoryForm) clocks after its address: set
// the controller's read latency so. Write a scene while control.hold is set and status.busy clear. Writing at other times
// shows in the frame, and slows it down: the port never waits, and lanes keep at least half of their share of the memory.
module voxrt_core
  import voxrt_pkg::*;
#(
  // Lanes: 1 .. 255. A lane reads a word per clock.
  parameter int unsigned Lanes        = 1,
  // Deepest octree, in levels below the root: 2 .. 16.
  parameter int unsigned MaxDepth     = 10,
  // Width of the camera's position, signed, in 1/16 voxel: 6 .. 32 bits.
  parameter int unsigned PositionBits = 17,
  // The octree memory holds 2**BlockBits blocks of eight words, and the root: 5 .. 24 bits.
  parameter int unsigned BlockBits    = 12,
  // The form of the octree memory: 0 = private copies, one per two lanes; 1 = one memory in banks, for all lanes;
  // 2 = an external memory behind caches.
  parameter int unsigned MemoryForm   = 0,
  // Cached: sets of four lines of 32 bytes in each lane's cache (1 or more), and in the cache that lanes share, 2**bits.
  parameter int unsigned L1SetBits    = 5,
  parameter int unsigned L2SetBits    = 9,
  // Features of the shader, 0 = not built in: a point light with shadows, mirrors.
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0,
  // Clocks per ray and per pixel: 1; 4, at which the setup of rays and the shader share their multipliers; or 8, at which
  // they also take one axis after the other. 4 and 8 need a core without Light, Mirrors and Lod.
  parameter int unsigned RayClocks    = 1,
  // Level of detail, 0 = not built in; not with Light or Mirrors.
  parameter bit          Lod          = 1'b0,
  // A soft reset ends the frame on the stream with black, 0 = cuts it: voxrt_frame_end.
  parameter bit          EndsFrames   = 1'b0,
  // What the octree memory holds from the beginning, for $readmemh (voxrt_octree_memory); "": nothing.
  parameter string       OctreeFile   = ""
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  // Registers.
  input  logic        s_axil_awvalid,
  output logic        s_axil_awready,
  input  logic [10:0] s_axil_awaddr,
  input  logic [ 2:0] s_axil_awprot,
  input  logic        s_axil_wvalid,
  output logic        s_axil_wready,
  input  logic [31:0] s_axil_wdata,
  input  logic [ 3:0] s_axil_wstrb,
  output logic        s_axil_bvalid,
  input  logic        s_axil_bready,
  output logic [ 1:0] s_axil_bresp,
  input  logic        s_axil_arvalid,
  output logic        s_axil_arready,
  input  logic [10:0] s_axil_araddr,
  input  logic [ 2:0] s_axil_arprot,
  output logic        s_axil_rvalid,
  input  logic        s_axil_rready,
  output logic [31:0] s_axil_rdata,
  output logic [ 1:0] s_axil_rresp,
  // 1 while a bit of the register status is set that writing 1 clears: a frame has ended, or had an error.
  output logic        interrupt_o,
  // Octree memory.
  input  logic        bram_en_i,
  input  logic [ 3:0] bram_we_i,
  input  logic [31:0] bram_addr_i,
  input  logic [31:0] bram_wrdata_i,
  output logic [31:0] bram_rddata_o,
  // External memory: two AXI4 read ports of 64 bits, of a core whose memory is cached.
  output logic        m_axi0_arvalid,
  input  logic        m_axi0_arready,
  output logic [31:0] m_axi0_araddr,
  output logic [ 7:0] m_axi0_arlen,
  output logic [ 2:0] m_axi0_arsize,
  output logic [ 1:0] m_axi0_arburst,
  output logic [ 3:0] m_axi0_arcache,
  output logic [ 2:0] m_axi0_arprot,
  input  logic        m_axi0_rvalid,
  output logic        m_axi0_rready,
  input  logic [63:0] m_axi0_rdata,
  input  logic [ 1:0] m_axi0_rresp,
  input  logic        m_axi0_rlast,
  output logic        m_axi1_arvalid,
  input  logic        m_axi1_arready,
  output logic [31:0] m_axi1_araddr,
  output logic [ 7:0] m_axi1_arlen,
  output logic [ 2:0] m_axi1_arsize,
  output logic [ 1:0] m_axi1_arburst,
  output logic [ 3:0] m_axi1_arcache,
  output logic [ 2:0] m_axi1_arprot,
  input  logic        m_axi1_rvalid,
  output logic        m_axi1_rready,
  input  logic [63:0] m_axi1_rdata,
  input  logic [ 1:0] m_axi1_rresp,
  input  logic        m_axi1_rlast,
  // Video.
  output logic        m_axis_tvalid,
  input  logic        m_axis_tready,
  output logic [31:0] m_axis_tdata,
  output logic [ 3:0] m_axis_tkeep,
  output logic        m_axis_tuser,
  output logic        m_axis_tlast
);
  if (Lanes < 1 || Lanes > 255) $error("voxrt_core: Lanes must be 1 to 255");
  if (MaxDepth < 2 || MaxDepth > DepthLimit) $error("voxrt_core: MaxDepth must be 2 to 16 levels");
  if (PositionBits < 6 || PositionBits > PositionLimit) $error("voxrt_core: PositionBits must be 6 to 32 bits");
  if (BlockBits < 5 || BlockBits > 24) $error("voxrt_core: BlockBits must be 5 to 24 bits");
  if (RayClocks != 1 && ((RayClocks != 4 && RayClocks != 8) || Light || Mirrors || Lod))
    $error("voxrt_core: RayClocks must be 1, or 4 or 8 without Light, Mirrors and Lod");
  if (MemoryForm > CachedForm) $error("voxrt_core: MemoryForm must be 0, 1 or 2");
  if (MemoryForm == CachedForm && (L1SetBits < 1 || L1SetBits >= BlockBits || L2SetBits < 1 || L2SetBits >= BlockBits))
    $error("voxrt_core: L1SetBits and L2SetBits must be 1 bit or more, and less than BlockBits");

  if (Lod && (Light || Mirrors)) $error("voxrt_core: Lod does not go with Light or Mirrors");

  voxrt_registers_pkg::voxrt_registers__in_t status;
  voxrt_registers_pkg::voxrt_registers__out_t control;

  voxrt_registers u_registers (
    .clk     (clk_i),
    .rst_n   (rst_ni),
    .hwif_in (status),
    .hwif_out(control),
    .s_axil_awvalid,
    .s_axil_awready,
    .s_axil_awaddr,
    .s_axil_awprot,
    .s_axil_wvalid,
    .s_axil_wready,
    .s_axil_wdata,
    .s_axil_wstrb,
    .s_axil_bvalid,
    .s_axil_bready,
    .s_axil_bresp,
    .s_axil_arvalid,
    .s_axil_arready,
    .s_axil_araddr,
    .s_axil_arprot,
    .s_axil_rvalid,
    .s_axil_rready,
    .s_axil_rdata,
    .s_axil_rresp
  );

  // A soft reset reaches all but registers and memories.
  logic rst_n;
  assign rst_n = rst_ni && !control.control.soft_reset.value;

  // Frames. The ray tracer's errors are of a frame, and rise in it at any time; the registers' stick until cleared.
  logic busy, busy_q, start;
  error_t error;

  assign start = (control.control.start.value || control.control.continuous.value) && !control.control.hold.value;

  always_ff @(posedge clk_i) busy_q <= rst_n && busy;

  frame_t frame;

  for (genvar a = 0; a < 3; a++) begin : gen_axis
    assign frame.position[a] = control.position[a].value.value;
    assign frame.look[a]     = control.look[a].value.value;
    assign frame.right[a]    = control.right[a].value.value;
    assign frame.up[a]       = control.up[a].value.value;
    assign frame.light[a]    = control.light[a].value.value;
  end

  assign frame.memory_base = {control.memory_base.address.value, 5'd0};
  assign frame.lod_words = control.lod.words.value;
  assign frame.lod_scale = control.lod.scale.value;
  assign frame.width = control.size.width.value;
  assign frame.height = control.size.height.value;
  assign frame.depth = control.depth.depth.value;
  assign frame.root = control.root.address.value;
  assign frame.shading.flat = control.shading.flat.value;
  assign frame.shading.faces = control.shading.faces.value;
  assign frame.shading.light = control.shading.light.value;
  assign frame.shading.ambient = control.shading.ambient.value;
  assign frame.shading.bounces = control.shading.bounces.value;

  assign frame.shading.brightness[0] = {control.lower_faces.z.value, control.lower_faces.y.value,
                                        control.lower_faces.x.value};
  assign frame.shading.brightness[1] = {control.upper_faces.z.value, control.upper_faces.y.value,
                                        control.upper_faces.x.value};

  material_write_t material_write;

  assign material_write.valid    = control.materials.req && control.materials.req_is_wr;
  assign material_write.material = control.materials.addr[9:2];
  assign material_write.entry    = control.materials.wr_data[24:0];

  logic pixel_valid, pixel_ready, unused_access_valid;
  shaded_pixel_t pixel;
  counters_t counters;

  axi_read_request_t axi_request[BusPorts];
  axi_read_response_t axi_response[BusPorts];

  assign m_axi0_arvalid = axi_request[0].arvalid;
  assign m_axi0_araddr = axi_request[0].araddr;
  assign m_axi0_rready = axi_request[0].rready;
  assign m_axi1_arvalid = axi_request[1].arvalid;
  assign m_axi1_araddr = axi_request[1].araddr;
  assign m_axi1_rready = axi_request[1].rready;
  // 4 beats of 8 bytes, at rising addresses; bufferable and modifiable; data, secure, unprivileged.
  assign {m_axi0_arlen, m_axi0_arsize, m_axi0_arburst, m_axi0_arcache, m_axi0_arprot} = {8'd3, 3'd3, 2'd1, 4'd3, 3'd0};
  assign {m_axi1_arlen, m_axi1_arsize, m_axi1_arburst, m_axi1_arcache, m_axi1_arprot} = {8'd3, 3'd3, 2'd1, 4'd3, 3'd0};
  assign axi_response[0] = '{arready: m_axi0_arready, rvalid: m_axi0_rvalid, rdata: m_axi0_rdata, rresp: m_axi0_rresp};
  assign axi_response[1] = '{arready: m_axi1_arready, rvalid: m_axi1_rvalid, rdata: m_axi1_rdata, rresp: m_axi1_rresp};

  // Beats are counted.
  logic unused_last;
  assign unused_last = m_axi0_rlast && m_axi1_rlast;

  voxrt_rtu #(
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
    .Lod         (Lod),
    .OctreeFile  (OctreeFile)
  ) u_rtu (
    .clk_i,
    .rst_ni          (rst_n),
    .start_i         (start),
    .busy_o          (busy),
    .frame_i         (frame),
    .access_i        (bram_en_i),
    .access_write_i  (bram_we_i == '1),
    .access_address_i(bram_addr_i >> 2),
    .access_word_i   (bram_wrdata_i),
    .access_valid_o  (unused_access_valid),
    .access_word_o   (bram_rddata_o),
    .bus_rst_ni      (rst_ni),
    .flush_i         (control.control.flush.value),
    .axi_o           (axi_request),
    .axi_i           (axi_response),
    .material_write_i(material_write),
    .pixel_valid_o   (pixel_valid),
    .pixel_ready_i   (pixel_ready),
    .pixel_o         (pixel),
    .error_o         (error),
    .counters_o      (counters)
  );

  logic packed_valid, packed_ready, packed_user, packed_last;
  logic [31:0] packed_data;
  logic [3:0] packed_keep;

  voxrt_pixel_packer u_packer (
    .clk_i,
    .rst_ni       (rst_n),
    .valid_i      (pixel_valid),
    .ready_o      (pixel_ready),
    .colour_i     (pixel.colour),
    .first_i      (pixel.first),
    .line_end_i   (pixel.line_end),
    .m_axis_tvalid(packed_valid),
    .m_axis_tready(packed_ready),
    .m_axis_tdata (packed_data),
    .m_axis_tkeep (packed_keep),
    .m_axis_tuser (packed_user),
    .m_axis_tlast (packed_last)
  );

  if (EndsFrames) begin : gen_frame_end
    voxrt_frame_end u_frame_end (
      .clk_i,
      .rst_ni,
      .drop_i       (!rst_n),
      .start_i      (start && !busy),
      .width_i      (frame.width),
      .height_i     (frame.height),
      .s_axis_tvalid(packed_valid),
      .s_axis_tready(packed_ready),
      .s_axis_tdata (packed_data),
      .s_axis_tkeep (packed_keep),
      .s_axis_tuser (packed_user),
      .s_axis_tlast (packed_last),
      .m_axis_tvalid,
      .m_axis_tready,
      .m_axis_tdata,
      .m_axis_tkeep,
      .m_axis_tuser,
      .m_axis_tlast
    );
  end else begin : gen_no_frame_end
    assign m_axis_tvalid = packed_valid;
    assign packed_ready  = m_axis_tready;
    assign m_axis_tdata  = packed_data;
    assign m_axis_tkeep  = packed_keep;
    assign m_axis_tuser  = packed_user;
    assign m_axis_tlast  = packed_last;
  end

  assign interrupt_o = control.status.frame_done.value || control.status.direction_overflow.value ||
      control.status.bad_pointer.value || control.status.step_limit.value || control.status.bus_error.value ||
      control.status.bus_timeout.value;

  assign status.configuration.lanes.next         = 8'(Lanes);
  assign status.configuration.max_depth.next     = 5'(MaxDepth);
  assign status.configuration.ray_clocks.next    = 3'(RayClocks);
  assign status.configuration.position_bits.next = 6'(PositionBits);
  assign status.configuration.block_bits.next    = 5'(BlockBits);
  assign status.configuration.banked.next        = MemoryForm == BankedForm;
  assign status.configuration.cached.next        = MemoryForm == CachedForm;
  assign status.features.light.next              = Light;
  assign status.features.mirrors.next            = Mirrors;
  assign status.features.lod.next                = Lod;
  assign status.status.busy.next                 = busy;
  assign status.status.frame_done.hwset          = busy_q && !busy && rst_n;
  assign status.status.direction_overflow.hwset  = busy && error.direction_overflow;
  assign status.status.bad_pointer.hwset         = busy && error.bad_pointer;
  assign status.status.step_limit.hwset          = busy && error.step_limit;
  assign status.status.bus_error.hwset           = busy && error.bus_error;
  assign status.status.bus_timeout.hwset         = busy && error.bus_timeout;
  assign status.word_requests.value.next         = counters.word_requests;
  assign status.line_requests.value.next         = counters.line_requests;
  assign status.lines_read.value.next            = counters.lines_read;
  assign status.cycles.value.next                = counters.cycles;
  assign status.rays.value.next                  = counters.rays;
  assign status.words_read.value.next            = counters.words_read;
  assign status.hits.value.next                  = counters.hits;
  assign status.stalls.value.next                = counters.stalls;
  assign status.materials.rd_ack                 = control.materials.req && !control.materials.req_is_wr;
  assign status.materials.wr_ack                 = control.materials.req && control.materials.req_is_wr;
  assign status.materials.rd_data                = '0;
endmodule
