// Puts three results of a shared unit side by side. With RayClocks = 4 one multiplier serves the three axes, so their
// results come one after the other, but the next stage of a pipeline wants them together and for a whole beat.
//
// The unit gets the values of turns 0, 1 and 2; results come Clocks clocks later. Side by side they are there Beats
// beats after the values, during the whole beat.
module voxrt_collect #(
  parameter int unsigned Width  = 8,  // Bits: 1 or more.
  parameter int unsigned Clocks = 2,  // Clocks of the unit from its values to their result: 2 or 3.
  parameter int unsigned Beats  = 2   // Beats from values to results_o: 2 or more.
) (
  input  logic             clk_i,
  input  logic [      1:0] turn_i,
  input  logic             advance_i,
  input  logic [Width-1:0] result_i,
  output logic [Width-1:0] results_o[3]
);
  if (Width < 1) $error("voxrt_collect: Width must be 1 bit or more");
  if (Clocks < 2 || Clocks > 3) $error("voxrt_collect: Clocks must be 2 or 3 clocks");
  if (Beats < 2) $error("voxrt_collect: Beats must be 2 beats or more");

  localparam logic [1:0] FirstTurn = 2'(Clocks);
  localparam logic [1:0] SecondTurn = 2'(Clocks + 1);
  localparam logic [1:0] LastTurn = 2'(Clocks + 2);

  logic [Width-1:0] first_q, second_q;
  logic [Width-1:0] results_q[Beats][3];

  always_ff @(posedge clk_i) begin
    if (turn_i == FirstTurn) first_q <= result_i;
    if (turn_i == SecondTurn) second_q <= result_i;
    if (turn_i == LastTurn) results_q[0] <= '{first_q, second_q, result_i};
    if (advance_i) begin
      for (int unsigned b = 1; b < Beats; b++) results_q[b] <= results_q[b-1];
    end
  end

  assign results_o = results_q[Beats-1];
endmodule
