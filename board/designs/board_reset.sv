// Resets one clock: rst_no is low until the PLL has been locked for 16 clocks, and again when it loses its lock. Flip-flops
// are 0 when an FPGA is configured.
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
    count_q <= locked ? count_q + 4'(count_q != '1) : '0;
    rst_nq  <= locked && count_q == '1;
  end

  assign rst_no = rst_nq;
endmodule
