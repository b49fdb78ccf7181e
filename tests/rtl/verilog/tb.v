// Test bench of the core in plain Verilog. It does what commands.hex says and writes down what comes of it:
//
//   commands.hex  a command per line, {operation, address, data} of 4 + 32 + 32 bits; operations are below
//   stream.txt    a line per transfer of the video stream: tuser, tlast, tkeep and tdata in hex
//   reads.txt     a line per register read: address and data in hex
//
// The stream's sink is not ready at a third of the clocks, by a shift register: the same ones in every run.
`timescale 1ns / 1ns
module tb;
  parameter COMMANDS = 1;           // How many commands.hex has.
  parameter CLOCKS   = 1000000;     // The bench gives up after so many.
  parameter MEMORY_CLOCKS = 3;      // Clocks from an address of the memory port to its word.

  localparam WRITE_MEMORY   = 4'h0;
  localparam WRITE_REGISTER = 4'h1;
  localparam READ_REGISTER  = 4'h2;
  localparam WAIT_REGISTER  = 4'h3; // Read until all bits of data are set.
  localparam CHECK_MEMORY   = 4'h4; // Read a word: it must be data.

  reg         clk, rst_n;
  reg         awvalid, wvalid, bready, arvalid, rready;
  reg  [10:0] awaddr, araddr;
  reg  [31:0] wdata;
  wire        awready, wready, bvalid, arready, rvalid;
  wire [ 1:0] bresp, rresp;
  wire [31:0] rdata;
  reg         bram_en;
  reg  [ 3:0] bram_we;
  reg  [31:0] bram_addr, bram_wrdata;
  wire [31:0] bram_rddata;
  wire        tvalid, tuser, tlast;
  reg         tready;
  wire [31:0] tdata;
  wire [ 3:0] tkeep;

  voxrt_core dut (
    .clk_i(clk),
    .rst_ni(rst_n),
    .s_axil_awvalid(awvalid),
    .s_axil_awready(awready),
    .s_axil_awaddr(awaddr),
    .s_axil_awprot(3'b000),
    .s_axil_wvalid(wvalid),
    .s_axil_wready(wready),
    .s_axil_wdata(wdata),
    .s_axil_wstrb(4'hF),
    .s_axil_bvalid(bvalid),
    .s_axil_bready(bready),
    .s_axil_bresp(bresp),
    .s_axil_arvalid(arvalid),
    .s_axil_arready(arready),
    .s_axil_araddr(araddr),
    .s_axil_arprot(3'b000),
    .s_axil_rvalid(rvalid),
    .s_axil_rready(rready),
    .s_axil_rdata(rdata),
    .s_axil_rresp(rresp),
    .interrupt_o(),
    .bram_en_i(bram_en),
    .bram_we_i(bram_we),
    .bram_addr_i(bram_addr),
    .bram_wrdata_i(bram_wrdata),
    .bram_rddata_o(bram_rddata),
    // This configuration has no external memory.
    .m_axi0_arready(1'b0),
    .m_axi0_rvalid(1'b0),
    .m_axi0_rdata(64'b0),
    .m_axi0_rresp(2'b0),
    .m_axi0_rlast(1'b0),
    .m_axi1_arready(1'b0),
    .m_axi1_rvalid(1'b0),
    .m_axi1_rdata(64'b0),
    .m_axi1_rresp(2'b0),
    .m_axi1_rlast(1'b0),
    .m_axis_tvalid(tvalid),
    .m_axis_tready(tready),
    .m_axis_tdata(tdata),
    .m_axis_tkeep(tkeep),
    .m_axis_tuser(tuser),
    .m_axis_tlast(tlast)
  );

  reg [67:0] commands [0:COMMANDS-1];
  reg [67:0] command;
  reg [31:0] value;
  reg [15:0] shift;
  integer    number, clocks, stream, reads;

  initial clk = 1'b0;
  always #5 clk = !clk;

  // All signals to the core change at falling edges.
  always @(negedge clk) begin
    shift  <= {shift[14:0], shift[15] ^ shift[13] ^ shift[12] ^ shift[10]};
    tready <= shift[1:0] != 2'b00;
  end

  always @(posedge clk) begin
    if (rst_n && tvalid !== 1'b0 && tready) $fdisplay(stream, "%b %b %h %h", tuser, tlast, tkeep, tdata);
    clocks <= clocks + 1;
    if (clocks == CLOCKS) fail("the frame does not end");
  end

  task fail(input [8*40-1:0] problem);
    begin
      $display("command %0d: %0s", number, problem);
      $finish;
    end
  endtask

  task write_register(input [10:0] address, input [31:0] data);
    begin
      awvalid = 1'b1;
      awaddr  = address;
      wvalid  = 1'b1;
      wdata   = data;
      while (awvalid || wvalid) begin
        @(posedge clk);
        value[0] = awready;
        value[1] = wready;
        @(negedge clk);
        if (value[0]) awvalid = 1'b0;
        if (value[1]) wvalid = 1'b0;
      end
      while (!bvalid) @(negedge clk);
      if (bresp !== 2'b00) fail("a register is not written");
      @(negedge clk);
    end
  endtask

  task read_register(input [10:0] address);
    begin
      arvalid = 1'b1;
      araddr  = address;
      while (arvalid) begin
        @(posedge clk);
        value[0] = arready;
        @(negedge clk);
        if (value[0]) arvalid = 1'b0;
      end
      while (!rvalid) @(negedge clk);
      if (rresp !== 2'b00) fail("a register is not read");
      value = rdata;
      @(negedge clk);
    end
  endtask

  task memory_access(input write, input [31:0] address, input [31:0] data);
    begin
      bram_en     = 1'b1;
      bram_we     = {4{write}};
      bram_addr   = address;
      bram_wrdata = data;
      @(negedge clk);
      bram_en = 1'b0;
      bram_we = 4'h0;
    end
  endtask

  initial begin
    $readmemh("commands.hex", commands);
    stream      = $fopen("stream.txt", "w");
    reads       = $fopen("reads.txt", "w");
    clocks      = 0;
    number      = 0;
    shift       = 16'hACE1;
    tready      = 1'b0;
    awvalid     = 1'b0;
    awaddr      = 11'h0;
    wvalid      = 1'b0;
    wdata       = 32'h0;
    bready      = 1'b1;
    arvalid     = 1'b0;
    araddr      = 11'h0;
    rready      = 1'b1;
    bram_en     = 1'b0;
    bram_we     = 4'h0;
    bram_addr   = 32'h0;
    bram_wrdata = 32'h0;
    rst_n       = 1'b0;
    repeat (8) @(negedge clk);
    rst_n = 1'b1;
    @(negedge clk);
    for (number = 0; number < COMMANDS; number = number + 1) begin
      command = commands[number];
      case (command[67:64])
        WRITE_MEMORY: memory_access(1'b1, command[63:32], command[31:0]);
        WRITE_REGISTER: write_register(command[42:32], command[31:0]);
        READ_REGISTER: begin
          read_register(command[42:32]);
          $fdisplay(reads, "%h %h", command[63:32], value);
        end
        WAIT_REGISTER: begin
          read_register(command[42:32]);
          while ((value & command[31:0]) !== command[31:0]) read_register(command[42:32]);
        end
        CHECK_MEMORY: begin
          memory_access(1'b0, command[63:32], 32'h0);
          repeat (MEMORY_CLOCKS - 1) @(negedge clk);
          if (bram_rddata !== command[31:0]) fail("the memory holds another word");
        end
        default: fail("no such operation");
      endcase
    end
    $display("done in %0d clocks", clocks);
    $finish;
  end
endmodule
