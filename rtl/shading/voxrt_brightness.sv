// The brightness of pixels that are not shaded by the ray's own angle: means of mirrors, faces, light and shadow. It
// stands before the shader only in cores that have such a feature. It gives, with f the brightness of the face and m
// the ambient value:
//
//   mean                sum of colours * 1 / count
//   by face             colour * f / 255, also where it is lit; flat: f = 255
//   by face, in shadow  colour * f * m / (255 * 256)
//   by angle, lit       colour * D_a**2 / |D|**2, or as in shadow where that is brighter
//   by angle, in shadow colour * m / 256
//
// The direction D from the hit point to the light is computed again here, so that a hit point travels through the
// reorder buffer and not three squares. All stages hold while a pixel waits at the end.
//
// Stages: detail | point | D | sizes | squares | sum, square | ambient x sum: two clocks | compare.
module voxrt_brightness
  import voxrt_pkg::*;
#(
  parameter int unsigned MaxDepth = 10,
  parameter bit          Light    = 1'b1,
  parameter bit          Mirrors  = 1'b1
) (
  input logic clk_i,
  input logic rst_ni,
  // Held during a frame.
  input logic [MaxDepth:0] side_i,  // Side of the world in voxels, one-hot.
  input logic [2:0][31:0] light_i,  // 1/16 voxel, signed.
  input shading_t shading_i,
  // Pixels, their details as the reorder buffer has them.
  input logic valid_i,
  output logic ready_o,
  input pixel_t pixel_i,
  input logic lit_i,
  input logic [detail_bits(MaxDepth, Light, Mirrors)-1:0] detail_i,
  output logic valid_o,
  input logic ready_i,
  output pixel_t pixel_o,
  output brightness_t brightness_o
);
  localparam int unsigned HitBits = MaxDepth + FractionBits;
  localparam int unsigned DetailBits = detail_bits(MaxDepth, Light, Mirrors);
  localparam int unsigned LightBits = light_bits(MaxDepth);
  localparam int unsigned Stages = Light ? 9 : 1;
  localparam int unsigned WholeBits = SquareBits + 2;
  localparam int unsigned MirroredBit = Light ? 3 * HitBits : 0;

  typedef struct packed {
    pixel_t   pixel;
    shade_e   shade;
    logic     lit;
    logic     upper;    // The face looks along its axis.
    mirrors_t mirrors;
  } info_t;

  logic [Stages:1] valid_q;
  info_t info_q[1:Stages];
  logic moves;

  assign moves   = ready_i || !valid_q[Stages];
  assign ready_o = moves;
  assign valid_o = valid_q[Stages];
  assign pixel_o = info_q[Stages].pixel;

  shade_e shade;
  logic [2:0] mirrored;
  logic upper, by_face;

  always_comb begin
    shade    = shade_e'(detail_i[DetailBits-1-:2]);
    mirrored = detail_i[MirroredBit+:3];
    unique case (pixel_i.face)
      FaceX:   upper = mirrored[0];
      FaceY:   upper = mirrored[1];
      default: upper = mirrored[2];
    endcase
  end

  assign by_face = shading_i.flat || shading_i.faces;

  always_ff @(posedge clk_i) begin
    if (moves) begin
      valid_q[1]        <= valid_i;
      info_q[1].pixel   <= pixel_i;
      info_q[1].shade   <= shade;
      info_q[1].lit     <= lit_i;
      info_q[1].upper   <= upper;
      info_q[1].mirrors <= '0;
      if (Mirrors) info_q[1].mirrors <= mirrors_t'(detail_i[DetailBits-3:0]);
      for (int unsigned s = 2; s <= Stages; s++) begin
        valid_q[s] <= valid_q[s-1];
        info_q[s]  <= info_q[s-1];
      end
    end
    if (!rst_ni) valid_q <= '0;
  end

  logic [SquareBits-1:0] part;
  logic [WholeBits-1:0] whole;

  if (Light) begin : gen_light
    // 1 detail, 2 point, 3 D.
    logic [3*HitBits+2:0] detail1_q;
    hit_point_t hit_point1;
    logic signed [LightBits+1:0] direction[3];
    logic signed [MaxDepth+FractionBits+2:0] unused_point[3];

    always_ff @(posedge clk_i) if (moves) detail1_q <= detail_i[3*HitBits+2:0];

    always_comb begin
      hit_point1.tag      = '0;
      hit_point1.face     = info_q[1].pixel.face;
      hit_point1.mirrored = detail1_q[3*HitBits+:3];
      for (int unsigned a = 0; a < 3; a++) hit_point1.point[a] = PointLimit'(detail1_q[a*HitBits+:HitBits]);
    end

    voxrt_light_direction #(
      .MaxDepth(MaxDepth)
    ) u_direction (
      .clk_i,
      .enable_i   (moves),
      .side_i,
      .light_i,
      .hit_point_i(hit_point1),
      .point_o    (unused_point),
      .direction_o(direction)
    );

    // 4 sizes, 5 squares, 6 sum and square, 7 and 8 ambient x sum and x face, 9 compare.
    logic [DirectionBits-1:0] size4_q[3];
    logic [SquareBits-1:0] square5_q[3], square6_q, square7_q, square8_q, part9_q;
    logic [WholeBits-1:0] sum6_q, sum7_q, sum8_q, whole9_q;
    logic [WholeBits+7:0] ambient7_q, ambient8_q;
    logic [7:0] face7_q, face8_q;
    logic [15:0] shadow8_q;  // face7_q * ambient.

    always_ff @(posedge clk_i) begin
      if (moves) begin
        for (int unsigned a = 0; a < 3; a++) begin
          size4_q[a]   <= DirectionBits'(direction[a] < 0 ? -direction[a] : direction[a]);
          square5_q[a] <= SquareBits'(size4_q[a]) * SquareBits'(size4_q[a]);
        end
        sum6_q <= WholeBits'(square5_q[0]) + WholeBits'(square5_q[1]) + WholeBits'(square5_q[2]);
        unique case (info_q[5].pixel.face)
          FaceX:   square6_q <= square5_q[0];
          FaceY:   square6_q <= square5_q[1];
          default: square6_q <= square5_q[2];
        endcase
        square7_q  <= square6_q;
        sum7_q     <= sum6_q;
        ambient7_q <= (WholeBits + 8)'(sum6_q) * (WholeBits + 8)'(shading_i.ambient);
        square8_q  <= square7_q;
        sum8_q     <= sum7_q;
        ambient8_q <= ambient7_q;
        face7_q    <= face_brightness(shading_i.brightness, shading_i.flat, info_q[6].pixel.face, info_q[6].upper);
        face8_q    <= face7_q;
        shadow8_q  <= 16'(face7_q) * 16'(shading_i.ambient);
        part9_q    <= square8_q;
        whole9_q   <= sum8_q;
        if (by_face) begin
          part9_q  <= SquareBits'(face8_q);
          whole9_q <= WholeBits'(FaceUnit);
          if (info_q[8].shade == ShadeLight && !info_q[8].lit) begin
            part9_q  <= SquareBits'(shadow8_q);
            whole9_q <= WholeBits'(256 * FaceUnit);
          end
        end else if (!info_q[8].lit || (WholeBits + 8)'({square8_q, 8'd0}) <= ambient8_q) begin
          part9_q  <= SquareBits'(shading_i.ambient);
          whole9_q <= WholeBits'(256);
        end
      end
    end

    assign part  = part9_q;
    assign whole = whole9_q;
  end else begin : gen_no_light
    logic unused_frame;
    assign unused_frame = &{side_i, light_i};
    assign part  = SquareBits'(face_brightness(shading_i.brightness, shading_i.flat, info_q[1].pixel.face,
                                               info_q[1].upper));
    assign whole = WholeBits'(FaceUnit);
  end

  always_comb begin
    brightness_o.part_given = by_face || info_q[Stages].shade != ShadeAngle;
    brightness_o.sum_given  = info_q[Stages].shade == ShadeMean;
    brightness_o.part       = part;
    brightness_o.whole      = whole;
    brightness_o.sum        = info_q[Stages].mirrors.total;
    if (brightness_o.sum_given) begin
      brightness_o.part  = SquareBits'(1);
      brightness_o.whole = WholeBits'(info_q[Stages].mirrors.count);
    end
  end
endmodule
