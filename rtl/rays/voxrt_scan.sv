// Computes the start values of both ray generators of a frame: the direction of its top left pixel
//   look - right * (width/2) + up * (height/2)
// bit by bit from the highest, and the step from line to line, -up. One adder per axis is enough, because this happens
// once per frame.
//
// Look, right and up must hold from start_i on, during the frame. corner_o comes 2 * SizeBits + 1 clocks after start_i;
// with it, line_step_o is the direction of the top left pixel. Two clocks later it is the step.
module voxrt_scan
  import voxrt_pkg::*;
(
  input  logic                                clk_i,
  input  logic                                rst_ni,
  input  logic                                start_i,
  input  logic [         2:0][CameraBits-1:0] look_i,         // Signed.
  input  logic [         2:0][CameraBits-1:0] right_i,        // Signed.
  input  logic [         2:0][CameraBits-1:0] up_i,           // Signed.
  input  logic [SizeBits-2:0]                 half_width_i,
  input  logic [SizeBits-2:0]                 half_height_i,
  output logic                                corner_o,
  output logic [         2:0][  ScanBits-1:0] line_step_o     // Signed.
);
  typedef enum logic [2:0] {
    Idle,    // line_step_o is the step.
    Right,   // Twice the sum, minus right where the bit of width/2 is set.
    Up,      // Plus up where the bit of height/2 is set.
    Look,    // Plus look.
    Corner,  // The sum is the first direction.
    Line     // 0 - up.
  } state_e;

  localparam int unsigned HalfBits = SizeBits - 1;

  state_e state_q;
  logic [HalfBits-1:0] half_width_q, half_height_q;
  logic [$clog2(HalfBits)-1:0] bit_q;
  logic signed [ScanBits-1:0] sum_q[3];
  // What a state adds, one clock later: choice and sum in one clock would be a long path.
  logic add_q, double_q, subtract_q, corner_q;
  logic signed [CameraBits:0] term_q[3];

  always_ff @(posedge clk_i) begin
    add_q      <= state_q != Idle && state_q != Corner && !start_i && rst_ni;
    double_q   <= state_q == Right;
    subtract_q <= state_q == Right || state_q == Line;
    corner_q   <= state_q == Corner && !start_i && rst_ni;
    for (int unsigned a = 0; a < 3; a++) begin
      unique case (state_q)
        Right:   term_q[a] <= half_width_q[HalfBits-1] ? (CameraBits + 1)'($signed(right_i[a])) : '0;
        Up:      term_q[a] <= half_height_q[HalfBits-1] ? (CameraBits + 1)'($signed(up_i[a])) : '0;
        Look:    term_q[a] <= (CameraBits + 1)'($signed(look_i[a]));
        default: term_q[a] <= (CameraBits + 1)'($signed(up_i[a]));
      endcase
      if (add_q) begin
        sum_q[a] <= (double_q ? sum_q[a] <<< 1 : sum_q[a]) + (ScanBits'(term_q[a]) ^ {ScanBits{subtract_q}}) +
            ScanBits'(subtract_q);
      end
      if (start_i || corner_q) sum_q[a] <= '0;
    end
    unique case (state_q)
      Right:   state_q <= Up;
      Up: begin
        half_width_q  <= half_width_q << 1;
        half_height_q <= half_height_q << 1;
        bit_q       <= bit_q - 1'b1;
        state_q       <= bit_q == '0 ? Look : Right;
      end
      Look:    state_q <= Corner;
      Corner:  state_q <= Line;
      default: state_q <= Idle;
    endcase
    if (start_i) begin
      state_q       <= Right;
      half_width_q  <= half_width_i;
      half_height_q <= half_height_i;
      bit_q         <= ($bits(bit_q))'(HalfBits - 1);
    end
    if (!rst_ni) state_q <= Idle;
  end

  assign corner_o    = corner_q;
  assign line_step_o = {sum_q[2], sum_q[1], sum_q[0]};
endmodule
