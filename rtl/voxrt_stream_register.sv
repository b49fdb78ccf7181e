// A register in a stream: what is offered behind it comes from flip-flops. One transfer a clock; ready_o looks through to
// ready_i.
module voxrt_stream_register #(
  parameter int unsigned Width = 8
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [Width-1:0] data_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [Width-1:0] data_o
);
  logic             valid_q;
  logic [Width-1:0] data_q;

  assign ready_o = !valid_q || ready_i;
  assign valid_o = valid_q;
  assign data_o  = data_q;

  always_ff @(posedge clk_i) begin
    if (ready_o) begin
      valid_q <= valid_i;
      data_q  <= data_i;
    end
    if (!rst_ni) valid_q <= 1'b0;
  end
endmodule
