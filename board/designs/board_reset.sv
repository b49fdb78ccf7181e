// Resets one clock: rst_no is low for 16 clocks from the PLL's lock on. Flip-flops of an ECP5 are 0 when it is
// configured.
module board_reset (
  input  logic clk_i,
  input  logic locked_i,  // Any clock.
  output logic rst_no
);
  logic [3:0] count_q = '0;
  logic locked, rst_nq = 1'b0;

  board_synchronizer u_locked (
    .clk_i,
    .bit_i(locked_i),
    .bit_o(locked)
  );

  always_ff @(posedge clk_i) begin
    if (locked && !rst_nq) count_q <= count_q + 1'b1;
    rst_nq <= rst_nq || count_q == '1;
  end

  assign rst_no = rst_nq;
endmodule
