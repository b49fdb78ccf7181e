// Gives a bit of another clock, two clocks later. Use it for single bits alone; board_event takes values of more.
module board_synchronizer (
  input  logic clk_i,
  input  logic bit_i,
  output logic bit_o
);
  (* ASYNC_REG = "TRUE" *)
  logic [1:0] bits_q;

  always_ff @(posedge clk_i) bits_q <= {bits_q[0], bit_i};

  assign bit_o = bits_q[1];
endmodule
