// Puts a lane's pixels back in order: a place is taken when a ray starts, filled when it ends, emptied in order.
//
// A place holds a pixel of the reader's lap when its lap bit says so; so nothing but the lap bits needs a reset, which
// takes Depth clocks.
//
// A pixel and its detail may be stored before the place is filled; what is stored last before that comes out.
module voxrt_pixel_buffer
  import voxrt_pkg::*;
#(
  parameter  int unsigned Depth      = 64,  // A power of two.
  parameter  int unsigned DetailBits = 1,
  localparam int unsigned TagBits    = $clog2(Depth) + 1  // A place and its lap.
) (
  input  logic                  clk_i,
  input  logic                  rst_ni,
  // Take a place.
  input  logic                  take_i,   // Only with ready_o.
  output logic                  ready_o,
  output logic [   TagBits-1:0] tag_o,
  // Fill one that was taken, once, in any order.
  input  logic                  fill_i,
  input  logic [   TagBits-1:0] tag_i,
  input  logic                  lit_i,
  // Store in it, until it is filled.
  input  logic                  store_pixel_i,
  input  pixel_t                pixel_i,
  input  logic                  store_detail_i,
  input  logic [DetailBits-1:0] detail_i,
  // Pixels in the order in which places were taken.
  output logic                  valid_o,
  input  logic                  ready_i,
  output pixel_t                pixel_o,
  output logic                  lit_o,
  output logic [DetailBits-1:0] detail_o
);
  localparam int unsigned PlaceBits = TagBits - 1;

  pixel_t                pixel_q [Depth];
  logic [DetailBits-1:0] detail_q[Depth];
  logic                  lit_q   [Depth];
  logic                  lap_q   [Depth];
  logic [TagBits-1:0]   take_q, read_q, clear_q;
  logic                 filled, advance, clearing;
  logic [PlaceBits-1:0] write_place, read_place;
  logic                 valid_q, out_lit_q;
  pixel_t               out_q;
  logic [DetailBits-1:0] out_detail_q;

  assign clearing    = !clear_q[PlaceBits];
  assign ready_o     = take_q != (read_q ^ {1'b1, PlaceBits'(0)}) && !clearing;
  assign tag_o       = take_q;
  assign write_place = clearing ? clear_q[PlaceBits-1:0] : tag_i[PlaceBits-1:0];
  assign read_place  = read_q[PlaceBits-1:0];
  assign filled      = lap_q[read_place] != read_q[PlaceBits] && !clearing;
  assign advance     = filled && (ready_i || !valid_q);

  always_ff @(posedge clk_i) begin
    if (take_i) take_q <= take_q + 1'b1;
    if (fill_i || clearing) begin
      // The first lap, number 0, marks with 1.
      lap_q[write_place] <= !clearing && !tag_i[PlaceBits];
      lit_q[write_place] <= lit_i;
    end
    if (store_pixel_i) pixel_q[tag_i[PlaceBits-1:0]] <= pixel_i;
    if (store_detail_i) detail_q[tag_i[PlaceBits-1:0]] <= detail_i;
    if (clearing) clear_q <= clear_q + 1'b1;
    if (ready_i) valid_q <= 1'b0;
    if (advance) begin
      read_q       <= read_q + 1'b1;
      valid_q      <= 1'b1;
      out_q        <= pixel_q[read_place];
      out_lit_q    <= lit_q[read_place];
      out_detail_q <= detail_q[read_place];
    end
    if (!rst_ni) begin
      take_q  <= '0;
      read_q  <= '0;
      clear_q <= '0;
      valid_q <= 1'b0;
    end
  end

  assign valid_o = valid_q;
  assign pixel_o  = out_q;
  assign lit_o    = out_lit_q;
  assign detail_o = out_detail_q;
endmodule
