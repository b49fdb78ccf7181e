// The work of voxrt_shader with a pixel per eight clocks, for parts with few flip-flops: one multiplier for the squares
// and one for the channels, which take axes and channels one after the other, and a divider per channel that makes a bit
// per clock. No brightness from elsewhere.
//
// A beat has eight turns. What the turns of axis 0 and of red do; the next axis and the next channel are a turn later:
//
//   0  size        1, 2   square           3  sum       6, 7  colour x square      8  dividend
//   9 to 16  bits of the quotient         19  all channels into the FIFO
`include "voxrt_assert.svh"

module voxrt_serial_shader
  import voxrt_pkg::*;
(
  input  logic            clk_i,
  input  logic            rst_ni,
  // See voxrt_shader.
  input  raster_t         raster_i,
  input  shading_t        shading_i,
  input  material_write_t material_write_i,
  input  logic            valid_i,
  output logic            ready_o,
  input  pixel_t          pixel_i,
  output logic            pixel_valid_o,
  input  logic            pixel_ready_i,
  output shaded_pixel_t   pixel_o
);
  localparam int unsigned SumBits = SquareBits + 2;
  localparam int unsigned DivisorBits = SumBits + 1;
  localparam int unsigned FifoDepth = 32;

  typedef struct packed {
    pixel_t pixel;
    logic   first;
    logic   line_end;
    logic   last;
  } info_t;

  // Whose turn: axis[t] is the axis or channel whose step t it is; none above 2.
  logic [2:0] turn_q, axis[8];
  logic advance;

  assign advance = turn_q == 3'd7;

  always_comb for (int unsigned t = 0; t < 8; t++) axis[t] = turn_q - 3'(t);

  always_ff @(posedge clk_i) begin
    turn_q <= turn_q + 3'd1;
    if (!rst_ni) turn_q <= '0;
  end

  // Directions. That of a pixel stays until its sizes are made.
  logic direction_valid, direction_used, first, line_end, last;
  logic signed [ScanBits-1:0] direction[3];
  logic [3:1] valid_q;

  assign direction_used = valid_q[1] && turn_q == 3'd2;

  voxrt_ray_generator u_directions (
    .clk_i,
    .rst_ni,
    .raster_i,
    .valid_o    (direction_valid),
    .ready_i    (direction_used),
    .direction_o(direction),
    .first_o    (first),
    .line_end_o (line_end),
    .last_o     (last)
  );

  // Credits: places in the FIFO that are not reserved for a pixel under way.
  localparam int unsigned CountBits = $clog2(FifoDepth) + 1;
  logic [CountBits-1:0] credits_q;
  logic enters, leaves, ready_q;

  assign ready_o = ready_q && direction_valid && advance;
  assign enters  = valid_i && ready_o;

  always_ff @(posedge clk_i) begin
    credits_q <= credits_q - CountBits'(enters) + CountBits'(leaves);
    ready_q   <= credits_q != '0;
    if (!rst_ni) begin
      credits_q <= CountBits'(FifoDepth);
      ready_q   <= 1'b0;
    end
  end

  // A pixel in its first, second and third beat.
  info_t info_q[1:3];

  always_ff @(posedge clk_i) begin
    if (advance) begin
      valid_q <= {valid_q[2:1], enters};
      info_q  <= '{'{pixel: pixel_i, first: first, line_end: line_end, last: last}, info_q[1], info_q[2]};
    end
    if (!rst_ni) valid_q <= '0;
  end

  // 0: size, brightness of the face. 1, 2: square.
  logic [DirectionBits-1:0] size_q;
  logic signed [ScanBits-1:0] component;
  logic [SquareBits-1:0] square;
  logic upper, upper_q;
  logic [7:0] face_q;

  always_comb begin
    component = direction[2];
    upper     = direction[2] < 0;
    for (int unsigned a = 0; a < 2; a++) begin
      if (axis[0] == 3'(a)) component = direction[a];
      if (info_q[1].pixel.face == face_e'(a)) upper = direction[a] < 0;
    end
  end

  always_ff @(posedge clk_i) begin
    size_q <= DirectionBits'(component < 0 ? -component : component);
    if (turn_q == 3'd0) upper_q <= upper;
    face_q <= face_brightness(shading_i.brightness, shading_i.flat, info_q[1].pixel.face, upper_q);
  end

  voxrt_multiply #(
    .ABits(DirectionBits),
    .BBits(DirectionBits)
  ) u_square (
    .clk_i,
    .a_i      (size_q),
    .b_i      (size_q),
    .product_o(square)
  );

  // 3: sum, and the square of the axis crossed; where brightness does not depend on the angle, that of the face.
  logic [SumBits-1:0] sum_q;
  logic [SquareBits-1:0] part_q;
  face_e angle;

  assign angle = shading_i.flat || shading_i.faces ? FaceNone : info_q[1].pixel.face;

  always_ff @(posedge clk_i) begin
    if (axis[3] == 3'd0) begin
      sum_q  <= angle == FaceNone ? SumBits'(FaceUnit) : SumBits'(square);
      part_q <= angle == FaceX ? square : SquareBits'(face_q);
    end else if (axis[3] <= 3'd2 && angle != FaceNone) begin
      sum_q <= sum_q + SumBits'(square);
      if (axis[3][1:0] == angle) part_q <= square;
    end
  end

  // 6, 7: colour x square. The table is in block RAM: its 256 entries would take a sixth of such a part's memories in logic.
  (* ram_style = "block" *)
  colour_t table_q[256];
  colour_t colour_q;
  logic [7:0] channel;
  logic [SquareBits+7:0] product;

  always_ff @(posedge clk_i) begin
    if (material_write_i.valid) table_q[material_write_i.material] <= material_write_i.entry.colour;
    if (turn_q == 3'd3) colour_q <= table_q[info_q[1].pixel.material];
  end

  always_comb begin
    channel = colour_q.blue;
    if (axis[6] == 3'd0) channel = colour_q.red;
    if (axis[6] == 3'd1) channel = colour_q.green;
  end

  voxrt_multiply #(
    .ABits(SquareBits),
    .BBits(8)
  ) u_product (
    .clk_i,
    .a_i      (part_q),
    .b_i      (channel),
    .product_o(product)
  );

  // 8: dividend; then the bits of (2 c d_a**2 + |d|**2) / (2 |d|**2), as voxrt_divide finds them.
  logic [DivisorBits+7:0] dividend;
  logic [7:0] quotient_q[3];

  assign dividend = (DivisorBits + 8)'({product, 1'b0}) + (DivisorBits + 8)'(sum_q);

  for (genvar c = 0; c < 3; c++) begin : gen_channel
    logic [DivisorBits:0] remainder_q, sum;
    logic [DivisorBits-1:0] divisor;
    logic [SumBits-1:0] divisor_q;
    logic [7:0] bits_q;
    logic subtracts, carry;

    assign divisor      = {divisor_q, 1'b0};
    assign subtracts    = !remainder_q[DivisorBits];
    assign {sum, carry} = {remainder_q[DivisorBits-1:0], bits_q[7], 1'b1} +
        {subtracts, divisor ^ {DivisorBits{subtracts}}, subtracts};

    always_ff @(posedge clk_i) begin
      remainder_q <= sum;
      bits_q      <= {bits_q[6:0], !sum[DivisorBits]};
      if (axis[0] == 3'(c)) begin
        quotient_q[c]         <= {bits_q[6:0], !sum[DivisorBits]};
        {remainder_q, bits_q} <= {1'b0, dividend};
        divisor_q             <= sum_q;
      end
    end

    logic unused;
    assign unused = carry;
  end

  // 19: out.
  logic fifo_ready, shaded_valid;
  shaded_pixel_t shaded;

  assign shaded_valid = valid_q[3] && turn_q == 3'd3;

  always_comb begin
    shaded.colour   = '{red: quotient_q[0], green: quotient_q[1], blue: quotient_q[2]};
    shaded.pixel    = info_q[3].pixel;
    shaded.first    = info_q[3].first;
    shaded.line_end = info_q[3].line_end;
    shaded.last     = info_q[3].last;
  end

  voxrt_fifo #(
    .Width($bits(shaded_pixel_t)),
    .Depth(FifoDepth)
  ) u_out (
    .clk_i,
    .rst_ni,
    .valid_i(shaded_valid),
    .ready_o(fifo_ready),
    .data_i (shaded),
    .valid_o(pixel_valid_o),
    .ready_i(pixel_ready_i),
    .data_o (pixel_o)
  );

  assign leaves = pixel_valid_o && pixel_ready_i;

  `VOXRT_ASSERT(FifoHoldsPixel, !shaded_valid || fifo_ready)
  `VOXRT_ASSERT(CreditsWithinPlaces, credits_q <= CountBits'(FifoDepth))
  `VOXRT_ASSERT(PixelHasDirection, !enters || direction_valid)
endmodule
