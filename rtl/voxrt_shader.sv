// From materials and faces to colours, exact to the last bit, one pixel a clock:
//   colour = round half up (c * d_a**2 / |d|**2), a the axis crossed, d the ray's direction
// which is the report's perceptual curve (section 3.1.2). A pixel without a face has the material's own colour; so have
// all when Flat is built in and asked for. With Given, voxrt_brightness may say otherwise for a pixel: another factor, and
// sums of colours in the place of the material's.
//
// Directions are made again by a second ray generator, in pixel order: nothing of the ray but material and face need
// come through the lanes. The pipeline never stops; a pixel enters when the FIFO behind has a place for it.
//
// Pipeline: direction, material | sizes | squares: two clocks | sums | colour x square: two clocks | dividend |
// 8 digits | FIFO.
module voxrt_shader
  import voxrt_pkg::*;
#(
  parameter bit Flat  = 1'b0,
  parameter bit Given = 1'b0
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  // Frame, as voxrt_ray_generator wants it.
  input  logic                         start_i,
  input  logic                         corner_i,
  input  logic signed [  ScanBits-1:0] line_step_i       [3],
  input  logic signed [CameraBits-1:0] right_i           [3],
  input  logic        [  SizeBits-1:0] width_i,
  input  logic        [  SizeBits-1:0] height_i,
  // Material table; row 0 is the background.
  input  logic                         table_write_i,
  input  material_t                    table_material_i,
  input  colour_t                      table_colour_i,
  // Pixels in.
  input  logic                         valid_i,
  output logic                         ready_o,
  input  pixel_t                       pixel_i,
  input  brightness_t                  brightness_i,
  input  logic                         flat_i,                 // Held during a frame.
  // Pixels out.
  output logic                         valid_o,
  input  logic                         ready_i,
  output colour_t                      colour_o,
  output pixel_t                       pixel_o,
  output logic                         first_o,                // Of the frame.
  output logic                         line_end_o,
  output logic                         last_o                  // Of the frame.
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
  } place_t;

  // Directions.
  logic                       direction_valid, enters, first, line_end, last;
  logic signed [ScanBits-1:0] direction[3];

  voxrt_ray_generator u_directions (
    .clk_i,
    .rst_ni,
    .start_i,
    .corner_i,
    .line_step_i,
    .right_i,
    .width_i,
    .height_i,
    .valid_o    (direction_valid),
    .ready_i    (enters),
    .direction_o(direction),
    .first_o    (first),
    .line_end_o (line_end),
    .last_o     (last)
  );

  // Places in the FIFO that are not promised to a pixel under way.
  localparam int unsigned CreditBits = $clog2(FifoDepth) + 1;
  logic [CreditBits-1:0] credit_q;
  logic                  leaves, has_credit_q;

  assign ready_o = has_credit_q && direction_valid;
  assign enters  = valid_i && ready_o;

  always_ff @(posedge clk_i) begin
    credit_q     <= credit_q - CreditBits'(enters) + CreditBits'(leaves);
    // A clock late, in which a pixel may have entered.
    has_credit_q <= credit_q > CreditBits'(1);
    if (!rst_ni) begin
      credit_q     <= CreditBits'(FifoDepth);
      has_credit_q <= 1'b0;
    end
  end

  logic [Stages:1] valid_q;
  place_t          place_q[1:Stages];

  always_ff @(posedge clk_i) begin
    valid_q    <= rst_ni ? {valid_q[Stages-1:1], enters} : '0;
    place_q[1] <= '{pixel: pixel_i, first: first, line_end: line_end, last: last};
    for (int unsigned s = 2; s <= Stages; s++) if (valid_q[s-1]) place_q[s] <= place_q[s-1];
  end

  // 1 direction, material.
  // Of a channel: a colour, or a sum of colours.
  localparam int unsigned ChannelBits = Given ? ColourSumBits : 8;

  // Not in block RAM, which the octree may fill up.
  (* ram_style = "distributed" *)
  colour_t                     table_q[256];
  colour_t                     colour1_q;
  logic [2:0][ChannelBits-1:0] channel_q[2:5];  // Red is 0.
  brightness_t                 brightness_q[1:4];
  logic signed [ScanBits-1:0] direction1_q[3];

  always_ff @(posedge clk_i) begin
    if (table_write_i) table_q[table_material_i] <= table_colour_i;
    if (enters) begin
      colour1_q       <= table_q[pixel_i.material];
      brightness_q[1] <= Given ? brightness_i : '0;
      direction1_q    <= direction;
    end
    if (valid_q[1]) begin
      channel_q[2] <= {ChannelBits'(colour1_q.blue), ChannelBits'(colour1_q.green), ChannelBits'(colour1_q.red)};
      if (Given && brightness_q[1].sum_given) channel_q[2] <= $bits(channel_q[2])'(brightness_q[1].sum);
    end
    for (int unsigned s = 3; s <= 5; s++) if (valid_q[s-1]) channel_q[s] <= channel_q[s-1];
    for (int unsigned s = 2; s <= 4; s++) if (valid_q[s-1]) brightness_q[s] <= brightness_q[s-1];
  end

  // 2 sizes, 3 and 4 squares, 5 sums.
  logic [DirectionBits-1:0] size2_q[3];
  logic [SquareBits-1:0]    square4[3], square5_q;
  logic [SumBits-1:0]       sum5_q, sum6_q, sum7_q, sum8_q;

  for (genvar a = 0; a < 3; a++) begin : gen_square
    voxrt_multiply #(
      .ABits    (DirectionBits),
      .BBits    (DirectionBits),
      .LogicBits(DirectionBits - MultiplierSide)
    ) u_square (
      .clk_i,
      .a_i      (size2_q[a]),
      .b_i      (size2_q[a]),
      .product_o(square4[a])
    );
  end

  always_ff @(posedge clk_i) begin
    if (valid_q[1]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        size2_q[a] <= DirectionBits'(direction1_q[a] < 0 ? -direction1_q[a] : direction1_q[a]);
      end
    end
    if (valid_q[4]) begin
      sum5_q <= SumBits'(square4[0]) + SumBits'(square4[1]) + SumBits'(square4[2]);
      unique case (place_q[4].pixel.face)
        FaceX:   square5_q <= square4[0];
        FaceY:   square5_q <= square4[1];
        FaceZ:   square5_q <= square4[2];
        default: begin
          // Without a face: c * 1 / 1.
          square5_q <= SquareBits'(1);
          sum5_q    <= SumBits'(1);
        end
      endcase
      if (Flat && flat_i) begin
        square5_q <= SquareBits'(1);
        sum5_q    <= SumBits'(1);
      end
      if (Given && brightness_q[4].part_given) begin
        square5_q <= brightness_q[4].part;
        sum5_q    <= brightness_q[4].whole;
      end
    end
    if (valid_q[5]) sum6_q <= sum5_q;
    if (valid_q[6]) sum7_q <= sum6_q;
    if (valid_q[7]) sum8_q <= sum7_q;
  end

  // 6 and 7 colour x square, 8 dividend, then the digits of (2 c d_a**2 + |d|**2) / (2 |d|**2).
  logic [7:0] quotient[3];

  for (genvar c = 0; c < 3; c++) begin : gen_channel
    logic [SquareBits+ChannelBits-1:0] product7;
    logic [SumBits+8:0]                dividend8_q;

    // One DSP slice, and one for the bits that it leaves; in two channels of three, logic for those.
    voxrt_multiply #(
      .ABits    (SquareBits),
      .BBits    (ChannelBits),
      .LogicBits(c == 2 ? 0 : SquareBits - (MultiplierBits - 1))
    ) u_product (
      .clk_i,
      .a_i      (square5_q),
      .b_i      (channel_q[5][c]),
      .product_o(product7)
    );

    always_ff @(posedge clk_i) begin
      if (valid_q[7]) dividend8_q <= (SumBits + 9)'({product7, 1'b0}) + (SumBits + 9)'(sum7_q);
    end

    voxrt_divide #(
      .DivisorBits (SumBits + 1),
      .QuotientBits(8)
    ) u_divide (
      .clk_i,
      .valid_i   (valid_q[Stages-1:Setup]),
      .dividend_i(dividend8_q),
      .divisor_i ({sum8_q, 1'b0}),
      .quotient_o(quotient[c])
    );
  end

  // Out.
  localparam int unsigned OutBits = $bits(colour_t) + $bits(place_t);
  logic   unused_ready;
  place_t place;

  voxrt_fifo #(
    .Width(OutBits),
    .Depth(FifoDepth)
  ) u_out (
    .clk_i,
    .rst_ni,
    .valid_i(valid_q[Stages]),
    .ready_o(unused_ready),
    .data_i ({quotient[0], quotient[1], quotient[2], place_q[Stages]}),
    .valid_o,
    .ready_i,
    .data_o ({colour_o, place})
  );

  assign leaves     = valid_o && ready_i;
  assign pixel_o    = place.pixel;
  assign first_o    = place.first;
  assign line_end_o = place.line_end;
  assign last_o     = place.last;
endmodule
