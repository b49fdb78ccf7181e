// Adds to the bus of a board with SDRAM what board_bus does not have: the words of the SDRAM, and two registers. It
// stands between the two masters and board_bus, and passes all other accesses on.
//
// A word of the octree memory takes as long as its line takes. Words beyond the memory are dropped, and read as 0. The
// map has room for 2**21 words: register page says which ones. docs/ecp5_boards.md is the reference.
module board_memory_port
  import board_pkg::*;
#(
  // Lines of the octree memory: word 0 is the last of line 0, and a block has a line. 2 .. 2**20.
  parameter int unsigned Lines = 983_040
) (
  input  logic                  clk_i,
  input  logic                  rst_ni,
  // Masters; see board_bus.
  input  logic    [  1:0]       valid_i,
  input  access_t [  1:0]       access_i,
  output logic    [  1:0]       done_o,
  output logic    [  1:0][31:0] data_o,
  output logic    [  1:0]       refused_o,
  output logic                  written_o,      // A word of the SDRAM was written; for one clock.
  // board_bus.
  output logic    [  1:0]       bus_valid_o,
  input  logic    [  1:0]       bus_done_i,
  input  logic    [ 31:0]       bus_data_i,
  input  logic                  bus_refused_i,
  // A port of the SDRAM's arbiter.
  output logic                  valid_o,
  input  logic                  ready_i,
  output logic                  write_o,
  output logic    [ 19:0]       line_o,
  output logic    [ 15:0]       mask_o,
  output logic    [255:0]       line_data_o,
  input  logic                  done_i,
  input  logic    [255:0]       line_data_i
);
  if (Lines < 2 || Lines > 2 ** 20) $error("board_memory_port: Lines must be 2 to 2**20 lines");

  localparam logic [23:0] Page = 24'h001030;
  localparam logic [23:0] Blocks = 24'h001034;
  localparam int unsigned PageBits = 2;

  typedef enum logic [1:0] {
    Idle,
    Request,
    Wait,
    Done
  } state_e;

  state_e state_q;
  logic master_q, is_word_q;
  logic [1:0] mine, asks, done_q;
  access_t access, access_q;
  logic [PageBits-1:0] page_q;
  logic [23:0] place;  // The place of the word, from the beginning of the SDRAM.
  logic beyond;
  logic [31:0] data_q;

  for (genvar m = 0; m < 2; m++) begin : gen_master
    assign mine[m]        = access_i[m].address[23] || access_i[m].address inside {Page, Blocks};
    assign bus_valid_o[m] = valid_i[m] && !mine[m];
    assign done_o[m]      = bus_done_i[m] || done_q[m];
    assign data_o[m]      = done_q[m] ? data_q : bus_data_i;
    assign refused_o[m]   = !done_q[m] && bus_refused_i;
  end

  // A master lowers valid_i a clock after done_o.
  assign asks        = valid_i & mine & ~done_q;
  assign access      = asks[0] ? access_i[0] : access_i[1];

  assign place       = 24'({page_q, access_q.address[22:2]}) + 24'd7;
  assign beyond      = place >= 24'(8 * Lines);

  assign valid_o     = state_q == Request && !beyond;
  assign write_o     = access_q.write;
  assign line_o      = place[22:3];
  assign mask_o      = 16'd3 << {place[2:0], 1'b0};

  // Ports that do not write bring zeros.
  assign line_data_o = state_q == Request ? {8{access_q.data}} : '0;
  assign written_o   = valid_o && ready_i && write_o;

  always_ff @(posedge clk_i) begin
    done_q <= '0;
    unique case (state_q)
      Idle: begin
        master_q  <= !asks[0];
        access_q  <= access;
        is_word_q <= access.address[23];
        if (asks != '0) state_q <= access.address[23] ? Request : Done;
      end
      Request: if (beyond || ready_i) state_q <= beyond ? Done : Wait;
      Wait: if (done_i) state_q <= Done;
      default: begin
        done_q[master_q] <= 1'b1;
        state_q          <= Idle;
        if (!is_word_q && access_q.write && access_q.address == Page) page_q <= access_q.data[PageBits-1:0];
      end
    endcase

    if (state_q == Idle || state_q == Request) data_q <= '0;
    if (state_q == Wait && done_i) data_q <= line_data_i[{place[2:0], 5'd0}+:32];
    if (state_q == Done && !is_word_q) data_q <= access_q.address == Page ? 32'(page_q) : 32'(Lines - 1);

    if (!rst_ni) begin
      state_q <= Idle;
      done_q  <= '0;
      page_q  <= '0;
    end
  end
endmodule
