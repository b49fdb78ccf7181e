// Turns strips into lines: pixels come in the order of voxrt_strip_generator, and go out line by line, as video wants
// them. While one strip is written, the one before is read: two strips of at most 2**strip_bits(Lanes) pixels.
module voxrt_strip_buffer
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes = 1,
  parameter int unsigned Width = 10  // Bits: 1 or more.
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  // The frame starts, a clock before its pixels. Then width and height are held.
  input  logic                start_i,
  input  logic [SizeBits-1:0] width_i,
  input  logic [SizeBits-1:0] height_i,
  input  logic                valid_i,
  output logic                ready_o,
  input  logic [   Width-1:0] pixel_i,
  output logic                valid_o,
  input  logic                ready_i,
  output logic [   Width-1:0] pixel_o
);
  if (Width < 1) $error("voxrt_strip_buffer: Width must be 1 bit or more");

  localparam int unsigned StripBits = strip_bits(Lanes);
  localparam int unsigned QueueDepth = 8;
  localparam int unsigned CountBits = $clog2(QueueDepth) + 1;

  logic write_strip_q, read_strip_q, writes, reads, unused_ready;
  logic [1:0] full_q, reading_q;
  logic [CountBits-1:0] read_q;  // Pixels on their way, and in the queue.
  logic [Width-1:0] pixel, unused_pixel;
  strip_place_t to, from;

  assign ready_o = !full_q[write_strip_q];
  assign writes  = valid_i && ready_o;
  assign reads   = full_q[read_strip_q] && read_q != CountBits'(QueueDepth);

  voxrt_strip_place #(
    .Lanes(Lanes)
  ) u_to (
    .clk_i,
    .start_i,
    .width_i,
    .height_i,
    .advances_i(writes),
    .place_o   (to)
  );

  voxrt_strip_place #(
    .Lanes  (Lanes),
    .ByLines(1'b1)
  ) u_from (
    .clk_i,
    .start_i,
    .width_i,
    .height_i,
    .advances_i(reads),
    .place_o   (from)
  );

  always_ff @(posedge clk_i) begin
    if (reads && from.last_line && from.last_column) begin
      full_q[read_strip_q] <= 1'b0;
      read_strip_q         <= !read_strip_q;
    end
    if (writes && to.last_line && to.last_column) begin
      full_q[write_strip_q] <= 1'b1;
      write_strip_q         <= !write_strip_q;
    end
    reading_q <= {reading_q[0], reads};
    read_q    <= read_q + CountBits'(reads) - CountBits'(valid_o && ready_i);
    if (!rst_ni || start_i) begin
      full_q        <= '0;
      write_strip_q <= 1'b0;
      read_strip_q  <= 1'b0;
      reading_q     <= '0;
      read_q        <= '0;
    end
  end

  voxrt_block_ram #(
    .Width(Width),
    .Depth(2 ** (StripBits + 1))
  ) u_pixels (
    .clk_i,
    .a_read_i (1'b0),
    .a_write_i(writes),
    .a_row_i  ({write_strip_q, to.address[StripBits-1:0]}),
    .a_data_i (pixel_i),
    .a_data_o (unused_pixel),
    .b_read_i (reads),
    .b_row_i  ({read_strip_q, from.address[StripBits-1:0]}),
    .b_data_o (pixel)
  );

  voxrt_fifo #(
    .Width(Width),
    .Depth(QueueDepth)
  ) u_queue (
    .clk_i,
    .rst_ni (rst_ni && !start_i),
    .valid_i(reading_q[1]),
    .ready_o(unused_ready),
    .data_i (pixel),
    .valid_o,
    .ready_i,
    .data_o (pixel_o)
  );
endmodule
