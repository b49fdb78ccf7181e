// The clock of pipelines whose units share a multiplier (RayClocks = 4): a beat has four turns. turn_o, 0 to 3, says
// whose value the unit takes, and the pipeline moves at the clock edge after the last turn. With RayClocks = 1 each
// clock is a beat.
module voxrt_turns #(
  parameter int unsigned RayClocks = 1  // Clocks per beat: 1 or 4.
) (
  input  logic       clk_i,
  input  logic       rst_ni,
  output logic [1:0] turn_o,
  output logic       advance_o
);
  if (RayClocks > 1) begin : gen_beat
    logic [1:0] turn_q;
    logic advance_q;

    always_ff @(posedge clk_i) begin
      turn_q    <= turn_q + 2'd1;
      advance_q <= turn_q == 2'd2;
      if (!rst_ni) begin
        turn_q    <= '0;
        advance_q <= 1'b0;
      end
    end

    assign turn_o    = turn_q;
    assign advance_o = advance_q;
  end else begin : gen_no_beat
    logic unused;
    assign unused    = &{clk_i, rst_ni};
    assign turn_o    = '0;
    assign advance_o = 1'b1;
  end
endmodule
