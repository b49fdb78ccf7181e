// Which rows of a memory are free: rows are taken one by one and given back in any order. After a reset all are free.
//
// Nobody takes more rows than there are: the list of those given back is as long as the memory, and is not asked for
// one before each has been taken once.
module voxrt_free_rows #(
  parameter int unsigned RowBits = 5
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               take_i,
  output logic [RowBits-1:0] row_o,      // That is taken next.
  input  logic               give_i,
  input  logic [RowBits-1:0] row_i
);
  logic [RowBits-1:0] given_back_q[2 ** RowBits];
  logic [RowBits-1:0] take_q, give_q;
  logic               all_taken_once_q;

  assign row_o = all_taken_once_q ? given_back_q[take_q] : take_q;

  always_ff @(posedge clk_i) begin
    if (take_i) take_q <= take_q + 1'b1;
    if (take_i && take_q == '1) all_taken_once_q <= 1'b1;
    if (give_i) begin
      give_q               <= give_q + 1'b1;
      given_back_q[give_q] <= row_i;
    end
    if (!rst_ni) begin
      take_q           <= '0;
      give_q           <= '0;
      all_taken_once_q <= 1'b0;
    end
  end
endmodule
