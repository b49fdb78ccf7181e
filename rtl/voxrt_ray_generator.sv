// Directions of a frame's pixels, row by row from the top left, by additions alone:
//   direction(column, row) = look + right * (column - width/2) + up * (height/2 - row)
//
// start_i latches nothing: look, right, up, width and height must hold while valid_o may still rise. The first
// direction comes SizeBits clocks after start_i; after that one every clock that ready_i is high.
module voxrt_ray_generator
  import voxrt_pkg::*;
(
  input  logic                         clk_i,
  input  logic                         rst_ni,
  input  logic                         start_i,
  input  logic signed [CameraBits-1:0] look_i      [3],
  input  logic signed [CameraBits-1:0] right_i     [3],
  input  logic signed [CameraBits-1:0] up_i        [3],
  input  logic        [  SizeBits-1:0] width_i,
  input  logic        [  SizeBits-1:0] height_i,
  output logic                         valid_o,
  input  logic                         ready_i,
  output logic signed [  ScanBits-1:0] direction_o [3],
  output logic                         first_o,          // First pixel of the frame.
  output logic                         line_end_o,       // Last pixel of its line.
  output logic                         last_o            // Last pixel of the frame.
);
  typedef enum logic [1:0] {
    Idle,
    Corner,
    Scan
  } state_e;

  state_e                      state_q;
  logic        [SizeBits-1:0]  column_q, row_q, half_width_q, half_height_q;
  logic                        first_q;
  logic signed [ScanBits-1:0]  direction_q[3], line_q[3], right_q[3], up_q[3];
  logic                        line_end, last;

  assign line_end = column_q == width_i - 1'b1;
  assign last     = line_end && row_q == height_i - 1'b1;

  always_ff @(posedge clk_i) begin
    unique case (state_q)
      Corner: begin
        // The top left corner by shift and add: look - right * (width/2) + up * (height/2).
        half_width_q  <= half_width_q >> 1;
        half_height_q <= half_height_q >> 1;
        for (int unsigned a = 0; a < 3; a++) begin
          direction_q[a] <= direction_q[a] - (half_width_q[0] ? right_q[a] : '0) + (half_height_q[0] ? up_q[a] : '0);
          line_q[a]      <= direction_q[a];
          right_q[a]     <= right_q[a] <<< 1;
          up_q[a]        <= up_q[a] <<< 1;
        end
        if (half_width_q == '0 && half_height_q == '0) state_q <= Scan;
      end
      Scan: begin
        if (ready_i) begin
          first_q  <= 1'b0;
          column_q <= column_q + 1'b1;
          for (int unsigned a = 0; a < 3; a++) direction_q[a] <= direction_q[a] + ScanBits'(right_i[a]);
          if (line_end) begin
            column_q <= '0;
            row_q    <= row_q + 1'b1;
            for (int unsigned a = 0; a < 3; a++) begin
              direction_q[a] <= line_q[a] - ScanBits'(up_i[a]);
              line_q[a]      <= line_q[a] - ScanBits'(up_i[a]);
            end
          end
          if (last) state_q <= Idle;
        end
      end
      default: ;
    endcase
    if (start_i) begin
      state_q       <= Corner;
      column_q      <= '0;
      row_q         <= '0;
      first_q       <= 1'b1;
      half_width_q  <= width_i >> 1;
      half_height_q <= height_i >> 1;
      for (int unsigned a = 0; a < 3; a++) begin
        direction_q[a] <= ScanBits'(look_i[a]);
        right_q[a]     <= ScanBits'(right_i[a]);
        up_q[a]        <= ScanBits'(up_i[a]);
      end
    end
    if (!rst_ni) state_q <= Idle;
  end

  assign valid_o     = state_q == Scan;
  assign direction_o = direction_q;
  assign first_o     = first_q;
  assign line_end_o  = line_end;
  assign last_o      = last;
endmodule
