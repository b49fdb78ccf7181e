// Computes colours from materials and faces, exact to the last bit, one pixel per RayClocks clocks:
//   colour = round half up (c * part / whole)
//   by face             the face's brightness / 255; flat: 255 / 255
//   by angle            d_a**2 / |d|**2, a the axis crossed, d the ray's direction: the report's perceptual curve
//                       (section 3.1.2)
// A pixel without a face has the material's own colour. With Given, voxrt_brightness may give a pixel another factor,
// and sums of colours instead of the material's; brightness by face is then its own.
//
// A second ray generator computes the directions again, in pixel order: of a ray, only material and face need come
// through the lanes. The pipeline never stops; a pixel enters when there is a credit for the FIFO behind.
//
// Pipeline: direction, material | sizes | squares: two clocks | sums | colour x square: two clocks | dividend |
// 8 bits of the quotient | FIFO.
`include "voxrt_assert.svh"

module voxrt_shader
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes     = 1,     // Lanes that the pixels come from.
  parameter bit          Given     = 1'b0,  // voxrt_brightness is there.
  parameter int unsigned RayClocks = 1      // 1, or 4: one multiplier for three axes or channels.
) (
  input  logic            clk_i,
  input  logic            rst_ni,
  // Frame.
  input  raster_t         raster_i,
  input  shading_t        shading_i,         // Held during a frame.
  // Material table; entry 0 is the background.
  input  material_write_t material_write_i,
  // Pixels in.
  input  logic            valid_i,
  output logic            ready_o,
  input  pixel_t          pixel_i,
  input  brightness_t     brightness_i,
  // Pixels out.
  output logic            pixel_valid_o,
  input  logic            pixel_ready_i,
  output shaded_pixel_t   pixel_o
);
  localparam int unsigned SumBits = SquareBits + 2;
  localparam int unsigned Setup = 8;
  localparam int unsigned Stages = Setup + 8;
  localparam int unsigned FifoDepth = 32;

  typedef struct packed {
    pixel_t pixel;
    logic   first;
    logic   line_end;
    logic   last;
  } info_t;

  // Directions.
  logic direction_valid, enters, first, line_end, last;
  logic signed [ScanBits-1:0] direction[3];

  // With many lanes, directions are made ahead. Then a pixel that enters moves a pointer, not the generator far away.
  // This needs a pipeline that moves at every clock.
  localparam bit Ahead = many_lanes(Lanes) && RayClocks == 1;

  voxrt_ray_generator #(
    .Ahead(Ahead)
  ) u_directions (
    .clk_i,
    .rst_ni,
    .raster_i,
    .valid_o    (direction_valid),
    .ready_i    (enters),
    .direction_o(direction),
    .first_o    (first),
    .line_end_o (line_end),
    .last_o     (last)
  );

  // Credits: places in the FIFO that are not reserved for a pixel under way.
  localparam int unsigned CountBits = $clog2(FifoDepth) + 1;
  logic [CountBits-1:0] credits_q;
  logic leaves, ready_q, advance;
  logic [1:0] turn;

  voxrt_turns #(
    .RayClocks(RayClocks)
  ) u_turns (
    .clk_i,
    .rst_ni,
    .turn_o   (turn),
    .advance_o(advance)
  );

  if (Ahead) begin : gen_ahead
    assign ready_o = ready_q;
  end else begin : gen_at_once
    assign ready_o = ready_q && direction_valid && advance;
  end
  assign enters = valid_i && ready_o;

  always_ff @(posedge clk_i) begin
    credits_q <= credits_q - CountBits'(enters) + CountBits'(leaves);
    // This is a clock late: a pixel may have entered since. With Ahead the FIFO of directions is empty only before the frame's
    // first direction and after its last one.
    ready_q   <= credits_q > CountBits'(1);
    if (Ahead && !direction_valid) ready_q <= 1'b0;
    if (!rst_ni) begin
      credits_q <= CountBits'(FifoDepth);
      ready_q   <= 1'b0;
    end
  end

  // The pipeline moves when `advance` is high; `moves` says it of the stages that hold a pixel.
  logic [Stages:1] valid_q, moves;
  info_t info_q[1:Stages];

  assign moves = advance ? valid_q : '0;

  always_ff @(posedge clk_i) begin
    if (advance) valid_q <= {valid_q[Stages-1:1], enters};
    if (!rst_ni) valid_q <= '0;
    // With Ahead, stage 1 loads at every clock, because enters is a long path. valid_q says whether it holds a pixel.
    if (Ahead ? 1'b1 : enters) info_q[1] <= '{pixel: pixel_i, first: first, line_end: line_end, last: last};
    for (int unsigned s = 2; s <= Stages; s++) if (moves[s-1]) info_q[s] <= info_q[s-1];
  end

  // 1 direction, material.
  // A channel of a colour, or of a sum of colours.
  localparam int unsigned ChannelBits = Given ? ColourSumBits : 8;

  // The table is not in block RAM, which the octree may fill up.
  (* ram_style = "distributed" *)
  colour_t table_q[256];
  colour_t colour1_q;
  logic [2:0][ChannelBits-1:0] channel_q[2:5];  // Red is 0.
  brightness_t brightness_q[1:4];
  logic signed [ScanBits-1:0] direction1_q[3];

  always_ff @(posedge clk_i) begin
    if (material_write_i.valid) table_q[material_write_i.material] <= material_write_i.entry.colour;
    if (Ahead ? 1'b1 : enters) begin
      colour1_q       <= table_q[pixel_i.material];
      brightness_q[1] <= Given ? brightness_i : '0;
      direction1_q    <= direction;
    end
    if (moves[1]) begin
      channel_q[2] <= {ChannelBits'(colour1_q.blue), ChannelBits'(colour1_q.green), ChannelBits'(colour1_q.red)};
      if (Given && brightness_q[1].sum_given) channel_q[2] <= $bits(channel_q[2])'(brightness_q[1].sum);
    end
    for (int unsigned s = 3; s <= 5; s++) if (moves[s-1]) channel_q[s] <= channel_q[s-1];
    for (int unsigned s = 2; s <= 4; s++) if (moves[s-1]) brightness_q[s] <= brightness_q[s-1];
  end

  // 2 sizes, 3 and 4 squares, 5 sums; on the way the brightness of the face, where it does not depend on the angle.
  logic [DirectionBits-1:0] size2_q[3];
  logic [SquareBits-1:0] square4[3], square5_q;
  logic [SumBits-1:0] sum5_q, sum6_q, sum7_q, sum8_q;
  logic upper2_q;
  logic [7:0] face3_q, face4_q;
  face_e angle4_q;  // The axis whose square it is; FaceNone: the face's brightness.

  voxrt_three_products #(
    .RayClocks(RayClocks),
    .ABits    (DirectionBits),
    .BBits    (DirectionBits),
    .LogicBits({3{8'(DirectionBits - MultiplierSide)}})
  ) u_squares (
    .clk_i,
    .turn_i   (turn),
    .advance_i(advance),
    .a_i      (size2_q),
    .b_i      (size2_q),
    .product_o(square4)
  );

  always_ff @(posedge clk_i) begin
    if (moves[1]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        size2_q[a] <= DirectionBits'(direction1_q[a] < 0 ? -direction1_q[a] : direction1_q[a]);
      end
      unique case (info_q[1].pixel.face)
        FaceX:   upper2_q <= direction1_q[0] < 0;
        FaceY:   upper2_q <= direction1_q[1] < 0;
        default: upper2_q <= direction1_q[2] < 0;
      endcase
    end
    if (moves[2]) begin
      face3_q <= face_brightness(shading_i.brightness, shading_i.flat, info_q[2].pixel.face, upper2_q);
      if (Given) face3_q <= 8'(FaceUnit);  // Without a face; of others voxrt_brightness has it.
    end
    if (moves[3]) begin
      face4_q  <= face3_q;
      angle4_q <= shading_i.flat || shading_i.faces ? FaceNone : info_q[3].pixel.face;
    end
    if (moves[4]) begin
      sum5_q <= SumBits'(square4[0]) + SumBits'(square4[1]) + SumBits'(square4[2]);
      unique case (angle4_q)
        FaceX:   square5_q <= square4[0];
        FaceY:   square5_q <= square4[1];
        FaceZ:   square5_q <= square4[2];
        default: begin
          square5_q <= SquareBits'(face4_q);
          sum5_q    <= SumBits'(FaceUnit);
        end
      endcase
      if (Given && brightness_q[4].part_given) begin
        square5_q <= brightness_q[4].part;
        sum5_q    <= brightness_q[4].whole;
      end
    end
    if (moves[5]) sum6_q <= sum5_q;
    if (moves[6]) sum7_q <= sum6_q;
    if (moves[7]) sum8_q <= sum7_q;
  end

  // 6 and 7 colour x square, 8 dividend, then the bits of (2 c d_a**2 + |d|**2) / (2 |d|**2).
  localparam logic [7:0] ProductLogicBits = 8'(SquareBits - (MultiplierBits - 1));
  logic [SquareBits-1:0] square5[3];
  logic [ChannelBits-1:0] channel5[3];
  logic [SquareBits+ChannelBits-1:0] product7[3];
  logic [7:0] quotient[3];

  always_comb begin
    for (int unsigned c = 0; c < 3; c++) begin
      square5[c]  = square5_q;
      channel5[c] = channel_q[5][c];
    end
  end

  // One DSP slice, and one for the bits that it leaves; in two channels of three, logic for those.
  voxrt_three_products #(
    .RayClocks(RayClocks),
    .ABits    (SquareBits),
    .BBits    (ChannelBits),
    .LogicBits({8'd0, ProductLogicBits, ProductLogicBits})
  ) u_products (
    .clk_i,
    .turn_i   (turn),
    .advance_i(advance),
    .a_i      (square5),
    .b_i      (channel5),
    .product_o(product7)
  );

  for (genvar c = 0; c < 3; c++) begin : gen_channel
    logic [SumBits+8:0] dividend8_q;

    always_ff @(posedge clk_i) begin
      if (moves[7]) dividend8_q <= (SumBits + 9)'({product7[c], 1'b0}) + (SumBits + 9)'(sum7_q);
    end

    voxrt_divide #(
      .DivisorBits (SumBits + 1),
      .QuotientBits(8)
    ) u_divide (
      .clk_i,
      .valid_i   (moves[Stages-1:Setup]),
      .dividend_i(dividend8_q),
      .divisor_i ({sum8_q, 1'b0}),
      .quotient_o(quotient[c])
    );
  end

  // Out.
  logic fifo_ready;
  shaded_pixel_t shaded;

  always_comb begin
    shaded.colour   = '{red: quotient[0], green: quotient[1], blue: quotient[2]};
    shaded.pixel    = info_q[Stages].pixel;
    shaded.first    = info_q[Stages].first;
    shaded.line_end = info_q[Stages].line_end;
    shaded.last     = info_q[Stages].last;
  end

  voxrt_fifo #(
    .Width($bits(shaded_pixel_t)),
    .Depth(FifoDepth)
  ) u_out (
    .clk_i,
    .rst_ni,
    .valid_i(moves[Stages]),
    .ready_o(fifo_ready),
    .data_i (shaded),
    .valid_o(pixel_valid_o),
    .ready_i(pixel_ready_i),
    .data_o (pixel_o)
  );

  assign leaves = pixel_valid_o && pixel_ready_i;

  `VOXRT_ASSERT(FifoHoldsPixel, !moves[Stages] || fifo_ready)
  `VOXRT_ASSERT(CreditsWithinPlaces, credits_q <= CountBits'(FifoDepth))
  `VOXRT_ASSERT(PixelHasDirection, !enters || direction_valid)
endmodule
