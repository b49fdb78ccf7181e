// Puts a lane's pixels back in order: a place is taken when a ray starts, filled when it ends, emptied in order.
//
// Places are in block RAM, read ahead of time, in order, two clocks long. A place holds a pixel of the reader's lap
// when its lap bit says so; else it was read too early, and reading starts again from there. Nothing but the lap bits
// needs a reset, which takes Depth clocks.
module voxrt_pixel_buffer
  import voxrt_pkg::*;
#(
  parameter  int unsigned Depth   = 256,  // A power of two.
  localparam int unsigned TagBits = $clog2(Depth) + 1  // A place and its lap.
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  // Take a place.
  input  logic               take_i,   // Only with ready_o.
  output logic               ready_o,
  output logic [TagBits-1:0] tag_o,
  // Fill one that was taken, once, in any order.
  input  logic               fill_i,
  input  logic [TagBits-1:0] tag_i,
  input  pixel_t             pixel_i,
  // Pixels in the order in which places were taken.
  output logic               valid_o,
  input  logic               ready_i,
  output pixel_t             pixel_o
);
  localparam int unsigned PlaceBits = TagBits - 1;
  localparam int unsigned FifoDepth = 4;

  typedef struct packed {
    logic   lap;
    pixel_t pixel;
  } place_t;

  // All places are cleared in the lap number 0; pixels start with lap 1.
  localparam logic [TagBits-1:0] First = {1'b1, PlaceBits'(0)};

  (* ram_style = "block" *)
  place_t               place_q[Depth];
  place_t               read1_q, read2_q;
  logic [TagBits-1:0]   take_q, fetch_q, given_q;
  logic                 clearing_q, fetches, valid1_q, valid2_q, filled, early, pops, unused_ready;
  logic [2:0]           waiting_q;  // In the FIFO.
  logic [PlaceBits-1:0] write_place;

  assign ready_o     = take_q != (given_q ^ First) && !clearing_q;
  assign tag_o       = take_q;
  assign write_place = clearing_q ? take_q[PlaceBits-1:0] : tag_i[PlaceBits-1:0];

  // Two places may be on their way when the FIFO fills up.
  assign fetches = 3'(valid1_q) + 3'(valid2_q) + waiting_q < 3'(FifoDepth);
  assign filled  = valid2_q && read2_q.lap == given_q[PlaceBits];
  assign early   = valid2_q && !filled;
  assign pops    = valid_o && ready_i;

  always_ff @(posedge clk_i) begin
    if (fill_i || clearing_q) place_q[write_place] <= '{lap: !clearing_q && tag_i[PlaceBits], pixel: pixel_i};
    read1_q <= place_q[fetch_q[PlaceBits-1:0]];
    read2_q <= read1_q;
  end

  always_ff @(posedge clk_i) begin
    if (take_i || clearing_q) take_q <= take_q + 1'b1;
    if (take_q[PlaceBits-1:0] == '1) clearing_q <= 1'b0;
    if (fetches) fetch_q <= fetch_q + 1'b1;
    if (filled) given_q <= given_q + 1'b1;
    valid1_q  <= fetches;
    valid2_q  <= valid1_q;
    waiting_q <= waiting_q + 3'(filled) - 3'(pops);
    if (early || clearing_q) begin
      fetch_q  <= given_q;
      valid1_q <= 1'b0;
      valid2_q <= 1'b0;
    end
    if (!rst_ni) begin
      take_q     <= '0;
      fetch_q    <= First;
      given_q    <= First;
      clearing_q <= 1'b1;
      valid1_q   <= 1'b0;
      valid2_q   <= 1'b0;
      waiting_q  <= '0;
    end
  end

  voxrt_fifo #(
    .Width($bits(pixel_t)),
    .Depth(FifoDepth)
  ) u_read (
    .clk_i,
    .rst_ni,
    .valid_i(filled),
    .ready_o(unused_ready),
    .data_i (read2_q.pixel),
    .valid_o,
    .ready_i,
    .data_o (pixel_o)
  );
endmodule
