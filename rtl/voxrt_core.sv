// The ray tracer as a core for a block design: AXI4-Lite registers, AXI4-Stream video, and a memory port that an AXI
// BRAM controller drives. One clock, one synchronous reset.
//
// Registers: registers.rdl. Stream: voxrt_pixel_packer.
//
// Memory port: byte addresses, 32-bit words of the report dialect, whole words only (all of bram_we_i or none). What
// is read comes memory_clocks(Banked) clocks after its address: set the controller's read latency so. Write a scene
// while control.hold is set and status.busy clear; writing at other times shows in the frame, and harms nothing else.
module voxrt_core
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes        = 1,
  parameter int unsigned MaxDepth     = 10,
  parameter int unsigned PositionBits = 17,
  parameter int unsigned BlockBits    = 12,
  parameter bit          Banked       = 1'b0,
  parameter bit          Flat         = 1'b0,
  parameter bit          Light        = 1'b0,
  parameter bit          Mirrors      = 1'b0
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
  // Octree memory.
  input  logic        bram_en_i,
  input  logic [ 3:0] bram_we_i,
  input  logic [31:0] bram_addr_i,
  input  logic [31:0] bram_wrdata_i,
  output logic [31:0] bram_rddata_o,
  // Video.
  output logic        m_axis_tvalid,
  input  logic        m_axis_tready,
  output logic [31:0] m_axis_tdata,
  output logic [ 3:0] m_axis_tkeep,
  output logic        m_axis_tuser,
  output logic        m_axis_tlast
);
  localparam int unsigned DepthBits = $clog2(MaxDepth + 1);
  localparam int unsigned LightBits = light_bits(MaxDepth);

  voxrt_registers_pkg::voxrt_registers__in_t  status;
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
  logic   busy, busy_q, start;
  error_t error;

  assign start = (control.control.start.value || control.control.continuous.value) && !control.control.hold.value;

  always_ff @(posedge clk_i) busy_q <= rst_n && busy;

  // Camera and light.
  shading_t                       shading;
  logic signed [   LightBits-1:0] light   [3];
  logic signed [PositionBits-1:0] position[3];
  logic signed [  CameraBits-1:0] look[3], right[3], up[3];

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      position[a] = control.position[a].value.value[PositionBits-1:0];
      look[a]     = control.look[a].value.value;
      right[a]    = control.right[a].value.value;
      up[a]       = control.up[a].value.value;
      light[a]    = control.light[a].value.value[LightBits-1:0];
    end
    shading.flat    = control.shading.flat.value;
    shading.light   = control.shading.light.value;
    shading.ambient = control.shading.ambient.value;
    shading.bounces = control.shading.bounces.value;
  end

  // Illegal sizes and depths count as the next legal ones.
  logic [ SizeBits-1:0] width, height;
  logic [DepthBits-1:0] depth;

  always_comb begin
    width  = control.size.width.value;
    height = control.size.height.value;
    depth  = control.depth.depth.value[DepthBits-1:0];
    if (control.size.width.value == '0) width = SizeBits'(1);
    if (control.size.height.value == '0) height = SizeBits'(1);
    if (control.depth.depth.value == '0) depth = DepthBits'(1);
    if (control.depth.depth.value > 5'(MaxDepth)) depth = DepthBits'(MaxDepth);
  end

  logic        pixel_valid, pixel_ready, pixel_first, pixel_line_end;
  colour_t     pixel_colour;
  logic [31:0] cycles, rays, words_read, hits, stalls;
  logic        unused_access_valid, unused_last;
  pixel_t      unused_pixel;

  voxrt_rtu #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .Banked      (Banked),
    .Flat        (Flat),
    .Light       (Light),
    .Mirrors     (Mirrors)
  ) u_rtu (
    .clk_i,
    .rst_ni          (rst_n),
    .start_i         (start),
    .busy_o          (busy),
    .position_i      (position),
    .look_i          (look),
    .right_i         (right),
    .up_i            (up),
    .width_i         (width),
    .height_i        (height),
    .depth_i         (depth),
    .root_i          (control.root.address.value),
    .shading_i       (shading),
    .light_i         (light),
    .access_i        (bram_en_i),
    .access_write_i  (bram_we_i == '1),
    .access_address_i(bram_addr_i >> 2),
    .access_word_i   (bram_wrdata_i),
    .access_valid_o  (unused_access_valid),
    .access_word_o   (bram_rddata_o),
    .table_write_i   (control.materials.req && control.materials.req_is_wr),
    .table_material_i(control.materials.addr[9:2]),
    .table_row_i     (control.materials.wr_data[24:0]),
    .out_valid_o     (pixel_valid),
    .out_ready_i     (pixel_ready),
    .out_colour_o    (pixel_colour),
    .out_pixel_o     (unused_pixel),
    .out_first_o     (pixel_first),
    .out_line_end_o  (pixel_line_end),
    .out_last_o      (unused_last),
    .error_o         (error),
    .cycles_o        (cycles),
    .rays_o          (rays),
    .words_read_o    (words_read),
    .hits_o          (hits),
    .stalls_o        (stalls)
  );

  voxrt_pixel_packer u_packer (
    .clk_i,
    .rst_ni    (rst_n),
    .valid_i   (pixel_valid),
    .ready_o   (pixel_ready),
    .colour_i  (pixel_colour),
    .first_i   (pixel_first),
    .line_end_i(pixel_line_end),
    .m_axis_tvalid,
    .m_axis_tready,
    .m_axis_tdata,
    .m_axis_tkeep,
    .m_axis_tuser,
    .m_axis_tlast
  );

  always_comb begin
    status                                      = '{default: '0};
    status.configuration.lanes.next             = 8'(Lanes);
    status.configuration.max_depth.next         = 5'(MaxDepth);
    status.configuration.position_bits.next     = 6'(PositionBits);
    status.configuration.block_bits.next        = 5'(BlockBits);
    status.configuration.banked.next            = Banked;
    status.features.flat.next                   = Flat;
    status.features.light.next                  = Light;
    status.features.mirrors.next                = Mirrors;
    status.status.busy.next                     = busy;
    status.status.frame_done.hwset              = busy_q && !busy && rst_n;
    status.status.direction_overflow.hwset      = busy && error.direction_overflow;
    status.status.bad_pointer.hwset             = busy && error.bad_pointer;
    status.status.step_limit.hwset              = busy && error.step_limit;
    status.cycles.value.next                    = cycles;
    status.rays.value.next                      = rays;
    status.words_read.value.next                = words_read;
    status.hits.value.next                      = hits;
    status.stalls.value.next                    = stalls;
    status.materials.rd_ack                     = control.materials.req && !control.materials.req_is_wr;
    status.materials.wr_ack                     = control.materials.req && control.materials.req_is_wr;
  end

endmodule
