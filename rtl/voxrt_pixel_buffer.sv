// Puts a lane's pixels back in order: a place is taken when a ray starts, filled when it ends, emptied in order.
//
// Places are in block RAM, read ahead of time, in order, two clocks long. A place holds a pixel of the reader's lap
// when its lap bit says so; else it was read too early, and reading starts again from there. Nothing but the lap bits
// needs a reset, which takes Depth clocks.
//
// With StoresFirst a pixel may be stored before its place is filled, which then tells whether it is lit: two memories.
// Without, both happen at once, and one is enough.
module voxrt_pixel_buffer #(
  parameter  int unsigned Width       = 10,
  parameter  int unsigned Depth       = 256,  // A power of two.
  parameter  bit          StoresFirst = 1'b0,
  localparam int unsigned TagBits     = $clog2(Depth) + 1  // A place and its lap.
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
  input  logic               lit_i,
  // Store a pixel in it, once, no later than that.
  input  logic               store_i,
  input  logic [  Width-1:0] pixel_i,
  // Pixels in the order in which places were taken.
  output logic               valid_o,
  input  logic               ready_i,
  output logic               lit_o,
  output logic [  Width-1:0] pixel_o
);
  localparam int unsigned PlaceBits = TagBits - 1;
  localparam int unsigned FifoDepth = 4;

  // All places are cleared in the lap number 0; pixels start with lap 1.
  localparam logic [TagBits-1:0] First = {1'b1, PlaceBits'(0)};

  logic [TagBits-1:0]   take_q, fetch_q, given_q, free;
  logic                 ready_q, clearing_q, fetches, valid1_q, valid2_q, lap2, filled, early, pops, unused_ready;
  logic [2:0]           waiting_q;  // In the FIFO.
  logic [PlaceBits-1:0] write_place;

  // A clock late, so that a place may have been taken since: the last free one is not given away.
  assign free        = (given_q ^ First) - take_q;
  assign ready_o     = ready_q;
  assign tag_o       = take_q;
  assign write_place = clearing_q ? take_q[PlaceBits-1:0] : tag_i[PlaceBits-1:0];

  // Two places may be on their way when the FIFO fills up.
  assign fetches = 3'(valid1_q) + 3'(valid2_q) + waiting_q < 3'(FifoDepth);
  assign filled  = valid2_q && lap2 == given_q[PlaceBits];
  assign early   = valid2_q && !filled;
  assign pops    = valid_o && ready_i;

  always_ff @(posedge clk_i) begin
    ready_q <= free > TagBits'(1) && !clearing_q && rst_ni;
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

  if (StoresFirst) begin : gen_two_memories
    typedef struct packed {
      logic lap;
      logic lit;
    } mark_t;

    (* ram_style = "block" *)
    mark_t            mark_q[Depth];
    (* ram_style = "block" *)
    logic [Width-1:0] pixel_q[Depth];
    mark_t            mark1_q, mark2_q;
    logic [Width-1:0] pixel1_q, pixel2_q;

    always_ff @(posedge clk_i) begin
      if (fill_i || clearing_q) mark_q[write_place] <= '{lap: !clearing_q && tag_i[PlaceBits], lit: lit_i};
      if (store_i) pixel_q[tag_i[PlaceBits-1:0]] <= pixel_i;
      mark1_q  <= mark_q[fetch_q[PlaceBits-1:0]];
      mark2_q  <= mark1_q;
      pixel1_q <= pixel_q[fetch_q[PlaceBits-1:0]];
      pixel2_q <= pixel1_q;
    end

    assign lap2 = mark2_q.lap;

    voxrt_fifo #(
      .Width(1 + Width),
      .Depth(FifoDepth)
    ) u_read (
      .clk_i,
      .rst_ni,
      .valid_i(filled),
      .ready_o(unused_ready),
      .data_i ({mark2_q.lit, pixel2_q}),
      .valid_o,
      .ready_i,
      .data_o ({lit_o, pixel_o})
    );
  end else begin : gen_one_memory
    typedef struct packed {
      logic             lap;
      logic [Width-1:0] pixel;
    } place_t;

    (* ram_style = "block" *)
    place_t place_q[Depth];
    place_t place1_q, place2_q;
    logic   unused_store;

    always_ff @(posedge clk_i) begin
      if (fill_i || clearing_q) place_q[write_place] <= '{lap: !clearing_q && tag_i[PlaceBits], pixel: pixel_i};
      place1_q <= place_q[fetch_q[PlaceBits-1:0]];
      place2_q <= place1_q;
    end

    assign unused_store = store_i && lit_i;
    assign lit_o        = 1'b0;
    assign lap2         = place2_q.lap;

    voxrt_fifo #(
      .Width(Width),
      .Depth(FifoDepth)
    ) u_read (
      .clk_i,
      .rst_ni,
      .valid_i(filled),
      .ready_o(unused_ready),
      .data_i (place2_q.pixel),
      .valid_o,
      .ready_i,
      .data_o (pixel_o)
    );
  end
endmodule
