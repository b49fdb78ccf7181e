// Counts the clocks of another clock in 2**WindowBits clocks of this one, as multiples of 2**StepBits. Without a reset:
// the flip-flops of an ECP5 are 0 when it is configured, and the second window is right whatever they are.
module board_clock_meter #(
  parameter int unsigned WindowBits = 20,  // 8 .. 28.
  parameter int unsigned StepBits   = 6    // 2**StepBits other clocks take two clocks or more: 1 .. 16.
) (
  input  logic        clk_i,
  input  logic        other_clk_i,
  output logic [31:0] clocks_o      // Of the last window; 0 before the first one ends.
);
  if (WindowBits < 8 || WindowBits > 28) $error("board_clock_meter: WindowBits must be 8 to 28");
  if (StepBits < 1 || StepBits > 16) $error("board_clock_meter: StepBits must be 1 to 16");

  // The highest bit changes each 2**StepBits clocks.
  logic [StepBits:0] other_q;
  always_ff @(posedge other_clk_i) other_q <= other_q + 1'b1;

  logic changing, last_q;

  board_synchronizer u_other (
    .clk_i,
    .bit_i(other_q[StepBits]),
    .bit_o(changing)
  );

  logic [WindowBits-1:0] window_q;
  logic [31-StepBits:0] steps_q;

  always_ff @(posedge clk_i) begin
    last_q   <= changing;
    window_q <= window_q + 1'b1;
    if (changing != last_q) steps_q <= steps_q + 1'b1;
    if (window_q == '1) begin
      clocks_o <= {steps_q, {StepBits{1'b0}}};
      steps_q  <= (32 - StepBits)'(changing != last_q);
    end
  end
endmodule
