// Draws the first frame of a scene in a simulation: plays the writes of boot.hex, and writes what the video stream brings
// to frame.ppm. docs/first_frame.md explains the writes.
//
//   boot.hex     a write per line, ADDRESS_DATA in hex: registers are at their own addresses, word a of the octree memory
//                is at 800000 + 4 a. +boot=FILE names another file.
//   OctreeFile   what the block RAMs hold from the beginning, with private copies; "": boot.hex writes all words.
//   frame.ppm    the picture as text. +frame=FILE names another file.
//
// `voxrt convert --form core` writes octree.hex and a boot.hex that belongs to it. The boot.hex beside this file needs no
// other. Memory in block RAM alone: there is no external memory here.
//
// It is for Verilator with the sources, or Icarus Verilog with the core in plain Verilog, which has no parameters: there,
// define PLAIN_VERILOG.
module first_frame #(
  parameter int Lanes        = 1,
  parameter int MaxDepth     = 10,
  parameter int PositionBits = 17,
  parameter int BlockBits    = 12,
  parameter int MemoryForm   = 0,
  parameter int Light        = 0,
  parameter int Mirrors      = 0,
  parameter     OctreeFile   = "",
  // After so many clocks it gives up.
  parameter int Clocks       = 100000000
);
  localparam logic [10:0] Status = 11'h010;
  localparam logic [10:0] Size = 11'h014;
  localparam int MemoryBit = 23;  // It is set in addresses of the octree memory.

  logic clk, rst_n;
  logic awvalid, wvalid, arvalid, bram_en;
  logic [10:0] awaddr, araddr;
  logic [31:0] wdata, bram_addr;
  wire awready, wready, bvalid, arready, rvalid;
  wire [1:0] bresp, rresp;
  wire [31:0] rdata;
  wire tvalid, tuser, tlast;
  wire [31:0] tdata, unused_read;
  wire [107:0] unused_axi;
  wire [ 3:0] tkeep;

  voxrt_core
`ifndef PLAIN_VERILOG
  #(
    .Lanes       (Lanes),
    .MaxDepth    (MaxDepth),
    .PositionBits(PositionBits),
    .BlockBits   (BlockBits),
    .MemoryForm  (MemoryForm),
    .Light       (Light[0]),
    .Mirrors     (Mirrors[0]),
    .OctreeFile  (OctreeFile)
  )
`endif
  dut (
    .clk_i         (clk),
    .rst_ni        (rst_n),
    .s_axil_awvalid(awvalid),
    .s_axil_awready(awready),
    .s_axil_awaddr (awaddr),
    .s_axil_awprot (3'b000),
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
    .s_axil_arprot (3'b000),
    .s_axil_rvalid (rvalid),
    .s_axil_rready (1'b1),
    .s_axil_rdata  (rdata),
    .s_axil_rresp  (rresp),
    .interrupt_o   (),
    .bram_en_i     (bram_en),
    .bram_we_i     ({4{bram_en}}),
    .bram_addr_i   (bram_addr),
    .bram_wrdata_i (wdata),
    .bram_rddata_o (unused_read),
    .m_axi0_arvalid(unused_axi[0]),
    .m_axi0_arready(1'b0),
    .m_axi0_araddr (unused_axi[32:1]),
    .m_axi0_arlen  (unused_axi[40:33]),
    .m_axi0_arsize (unused_axi[43:41]),
    .m_axi0_arburst(unused_axi[45:44]),
    .m_axi0_arcache(unused_axi[49:46]),
    .m_axi0_arprot (unused_axi[52:50]),
    .m_axi0_rvalid (1'b0),
    .m_axi0_rready (unused_axi[53]),
    .m_axi0_rdata  (64'b0),
    .m_axi0_rresp  (2'b00),
    .m_axi0_rlast  (1'b0),
    .m_axi1_arvalid(unused_axi[54]),
    .m_axi1_arready(1'b0),
    .m_axi1_araddr (unused_axi[86:55]),
    .m_axi1_arlen  (unused_axi[94:87]),
    .m_axi1_arsize (unused_axi[97:95]),
    .m_axi1_arburst(unused_axi[99:98]),
    .m_axi1_arcache(unused_axi[103:100]),
    .m_axi1_arprot (unused_axi[106:104]),
    .m_axi1_rvalid (1'b0),
    .m_axi1_rready (unused_axi[107]),
    .m_axi1_rdata  (64'b0),
    .m_axi1_rresp  (2'b00),
    .m_axi1_rlast  (1'b0),
    .m_axis_tvalid (tvalid),
    .m_axis_tready (1'b1),
    .m_axis_tdata  (tdata),
    .m_axis_tkeep  (tkeep),
    .m_axis_tuser  (tuser),
    .m_axis_tlast  (tlast)
  );

  initial clk = 1'b0;
  always #5 clk = !clk;

  task automatic stop(input string problem);
    begin
      $display("first_frame: %0s", problem);
      $fatal(1);
    end
  endtask

  // All that the bench drives changes at falling edges.
  task automatic write_register(input logic [10:0] address, input logic [31:0] data);
    begin
      awaddr  = address;
      wdata   = data;
      awvalid = 1'b1;
      wvalid  = 1'b1;
      while (awvalid || wvalid) begin
        logic taken_address, taken_data;
        @(posedge clk);
        taken_address = awready;
        taken_data    = wready;
        @(negedge clk);
        if (taken_address) awvalid = 1'b0;
        if (taken_data) wvalid = 1'b0;
      end
      while (!bvalid) @(negedge clk);
      if (bresp != 2'b00) stop("a write of boot.hex is refused: there is no such register");
      @(negedge clk);
    end
  endtask

  task automatic read_register(input logic [10:0] address, output logic [31:0] data);
    begin
      araddr  = address;
      arvalid = 1'b1;
      while (arvalid) begin
        logic taken;
        @(posedge clk);
        taken = arready;
        @(negedge clk);
        if (taken) arvalid = 1'b0;
      end
      while (!rvalid) @(negedge clk);
      if (rresp != 2'b00) stop("a read is refused");
      data = rdata;
      @(negedge clk);
    end
  endtask

  // The picture: bytes are green, blue, red; each line begins with a new word.
  integer frame, clocks, width, height, line, place;
  logic [7:0] green, blue;

  // What is offered at a falling edge is taken at the next rising one.
  initial begin
    clocks = 0;
    line   = 0;
    place  = 0;
    while (clocks < Clocks) begin
      @(negedge clk);
      clocks = clocks + 1;
      if (rst_n && tvalid) begin
        if (tuser) $fdisplay(frame, "P3 %0d %0d 255", width, height);
        for (integer i = 0; i < 4; i = i + 1) begin
          if (tkeep[i]) begin
            if (place == 0) green = tdata[8*i+:8];
            else if (place == 1) blue = tdata[8*i+:8];
            else $fdisplay(frame, "%0d %0d %0d", tdata[8*i+:8], green, blue);
            place = place == 2 ? 0 : place + 1;
          end
        end
        if (tlast) line = line + 1;
      end
    end
    stop("the frame does not end");
  end

  initial begin
    integer boot;
    string boot_name, frame_name;
    logic [63:0] write;
    logic [31:0] status;
    width      = 640;
    height     = 480;
    awvalid    = 1'b0;
    wvalid     = 1'b0;
    arvalid    = 1'b0;
    bram_en    = 1'b0;
    awaddr     = '0;
    araddr     = '0;
    wdata      = '0;
    bram_addr  = '0;
    boot_name  = "boot.hex";
    frame_name = "frame.ppm";
    if ($value$plusargs("boot=%s", boot_name)) $display("first_frame: writes of %0s", boot_name);
    if ($value$plusargs("frame=%s", frame_name)) $display("first_frame: picture to %0s", frame_name);
    boot = $fopen(boot_name, "r");
    if (boot == 0) stop("there is no boot.hex here: voxrt convert SCENE . --form core");
    frame = $fopen(frame_name, "w");
    if (frame == 0) stop("the picture cannot be written");

    // One clock is enough; unknown values of a simulator take some to leave the pipelines.
    rst_n = 1'b0;
    repeat (16) @(negedge clk);
    rst_n = 1'b1;
    while ($fscanf(boot, "%h\n", write) == 1) begin
      if (write[32+MemoryBit]) begin
        bram_en   = 1'b1;
        bram_addr = {9'b0, write[32+:MemoryBit]};
        wdata     = write[31:0];
        @(negedge clk);
        bram_en = 1'b0;
      end else begin
        write_register(write[42:32], write[31:0]);
        if (write[42:32] == Size) begin
          width  = {20'b0, write[11:0]};
          height = {20'b0, write[27:16]};
        end
      end
    end
    while (line != height) @(negedge clk);
    status = 32'h1;
    while (status[0]) read_register(Status, status);
    $fclose(frame);
    $display("first_frame: %0d x %0d pixels, status %h, %0d clocks", width, height, status, clocks);
    if (status != 32'h2) stop("the status register reports a problem");
    $finish;
  end
endmodule
