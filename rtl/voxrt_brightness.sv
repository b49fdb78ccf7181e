// Pixels whose colour is not made of the ray's own angle: mirrors' mean, light and shadow. What the shader shall reckon:
//
//   mean                sum of colours * 1 / count
//   in shadow           colour * ambient / 256, the ambient value being in 1/256
//   lit                 colour * D_a**2 / |D|**2, or as in shadow where that is brighter
//   lit, flat           colour * 1 / 1
//
// The way D from the lit point to the light is made again from the sub-cell, so that what travels through the pixel buffer is
// the sub-cell and not three squares. All stages stand still while a pixel waits at the end.
//
// Stages: detail | lit point | D | sizes | squares | sum, square | ambient x sum | compare.
module voxrt_brightness
  import voxrt_pkg::*;
#(
  parameter  int unsigned MaxDepth   = 10,
  parameter  bit          Light      = 1'b1,
  parameter  bit          Mirrors    = 1'b1,
  localparam int unsigned PlaceBits  = MaxDepth + FractionBits,
  localparam int unsigned DetailBits = detail_bits(MaxDepth, Light, Mirrors),
  localparam int unsigned LightBits  = light_bits(MaxDepth)
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  // Held during a frame.
  input  logic        [    MaxDepth:0] world_i,        // One-hot: the world's side.
  input  logic signed [ LightBits-1:0] light_i   [3],  // 1/16 voxel.
  input  logic                         flat_i,
  input  logic        [           7:0] ambient_i,      // 1/256
  // Pixels.
  input  logic                         valid_i,
  output logic                         ready_o,
  input  pixel_t                       pixel_i,
  input  logic                         lit_i,
  input  logic        [DetailBits-1:0] detail_i,
  output logic                         valid_o,
  input  logic                         ready_i,
  output pixel_t                       pixel_o,
  output brightness_t                  brightness_o
);
  localparam int unsigned Stages = Light ? 9 : 1;
  localparam int unsigned WholeBits = SquareBits + 2;

  typedef struct packed {
    pixel_t   pixel;
    shade_e   shade;
    logic     lit;
    mirrors_t mirrors;
  } place_t;

  logic [Stages:1] valid_q;
  place_t          place_q[1:Stages];
  logic            moves;

  assign moves   = ready_i || !valid_q[Stages];
  assign ready_o = moves;
  assign valid_o = valid_q[Stages];
  assign pixel_o = place_q[Stages].pixel;

  always_ff @(posedge clk_i) begin
    if (moves) begin
      valid_q[1]         <= valid_i;
      place_q[1].pixel   <= pixel_i;
      place_q[1].shade   <= shade_e'(detail_i[DetailBits-1-:2]);
      place_q[1].lit     <= lit_i;
      place_q[1].mirrors <= '0;
      if (Mirrors) place_q[1].mirrors <= mirrors_t'(detail_i[DetailBits-3:0]);
      for (int unsigned s = 2; s <= Stages; s++) begin
        valid_q[s] <= valid_q[s-1];
        place_q[s] <= place_q[s-1];
      end
    end
    if (!rst_ni) valid_q <= '0;
  end

  logic [SquareBits-1:0] part;
  logic [ WholeBits-1:0] whole;

  if (Light) begin : gen_light
    // 1 detail, 2 lit point, 3 D.
    logic        [PlaceBits-1:0] place1_q[3];
    logic        [          2:0] mirrored1_q;
    logic signed [LightBits+1:0] way[3];
    logic signed [MaxDepth+LitFractionBits+1:0] unused_lit[3];

    always_ff @(posedge clk_i) begin
      if (moves) {mirrored1_q, place1_q[2], place1_q[1], place1_q[0]} <= detail_i[3*PlaceBits+2:0];
    end

    voxrt_light_way #(
      .MaxDepth(MaxDepth)
    ) u_way (
      .clk_i,
      .enable_i  (moves),
      .world_i,
      .light_i,
      .place_i   (place1_q),
      .mirrored_i(mirrored1_q),
      .face_i    (place_q[1].pixel.face),
      .lit_o     (unused_lit),
      .way_o     (way)
    );

    // 4 sizes, 5 squares, 6 sum and square, 7 and 8 ambient x sum, 9 compare.
    logic [DirectionBits-1:0] size4_q  [3];
    logic [   SquareBits-1:0] square5_q[3], square6_q, square7_q, square8_q, part9_q;
    logic [    WholeBits-1:0] sum6_q, sum7_q, sum8_q, whole9_q;
    logic [  WholeBits+7:0] ambient7_q, ambient8_q;

    always_ff @(posedge clk_i) begin
      if (moves) begin
        for (int unsigned a = 0; a < 3; a++) begin
          size4_q[a]   <= DirectionBits'(way[a] < 0 ? -way[a] : way[a]);
          square5_q[a] <= SquareBits'(size4_q[a]) * SquareBits'(size4_q[a]);
        end
        sum6_q <= WholeBits'(square5_q[0]) + WholeBits'(square5_q[1]) + WholeBits'(square5_q[2]);
        unique case (place_q[5].pixel.face)
          FaceX:   square6_q <= square5_q[0];
          FaceY:   square6_q <= square5_q[1];
          default: square6_q <= square5_q[2];
        endcase
        square7_q  <= square6_q;
        sum7_q     <= sum6_q;
        ambient7_q <= (WholeBits + 8)'(sum6_q) * (WholeBits + 8)'(ambient_i);
        square8_q  <= square7_q;
        sum8_q     <= sum7_q;
        ambient8_q <= ambient7_q;
        part9_q    <= square8_q;
        whole9_q   <= sum8_q;
        if (place_q[8].lit && flat_i) begin
          part9_q  <= SquareBits'(1);
          whole9_q <= WholeBits'(1);
        end else if (!place_q[8].lit || (WholeBits + 8)'({square8_q, 8'd0}) <= ambient8_q) begin
          part9_q  <= SquareBits'(ambient_i);
          whole9_q <= WholeBits'(256);
        end
      end
    end

    assign part  = part9_q;
    assign whole = whole9_q;
  end else begin : gen_no_light
    logic unused_frame;
    assign unused_frame = &{world_i, light_i[0], light_i[1], light_i[2], flat_i, ambient_i};
    assign part  = '0;
    assign whole = '0;
  end

  always_comb begin
    brightness_o.part_given = place_q[Stages].shade != ShadeAngle;
    brightness_o.sum_given  = place_q[Stages].shade == ShadeMean;
    brightness_o.part       = part;
    brightness_o.whole      = whole;
    brightness_o.sum        = place_q[Stages].mirrors.sum;
    if (brightness_o.sum_given) begin
      brightness_o.part  = SquareBits'(1);
      brightness_o.whole = WholeBits'(place_q[Stages].mirrors.count);
    end
  end
endmodule
