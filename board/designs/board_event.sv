// Hands a value from one clock to another, each time send_i is set. Use it for values of more than one bit, whose bits
// board_synchronizer would give at different clocks. send_i must not be set again before three clocks of the receiver
// have passed.
module board_event #(
  parameter int unsigned Width = 8  // Bits: 1 or more.
) (
  input  logic             from_clk_i,
  input  logic             from_rst_ni,
  input  logic             send_i,
  input  logic [Width-1:0] value_i,
  input  logic             to_clk_i,
  output logic             received_o,   // For one clock, value_o from then on.
  output logic [Width-1:0] value_o
);
  if (Width < 1) $error("board_event: Width must be 1 bit or more");

  logic toggle_q, toggle, last_q;
  logic [Width-1:0] value_q;

  always_ff @(posedge from_clk_i) begin
    if (send_i) begin
      toggle_q <= !toggle_q;
      value_q  <= value_i;
    end
    if (!from_rst_ni) toggle_q <= 1'b0;
  end

  board_synchronizer u_toggle (
    .clk_i(to_clk_i),
    .bit_i(toggle_q),
    .bit_o(toggle)
  );

  // What changed with the toggle has been still for two clocks when the toggle is seen.
  always_ff @(posedge to_clk_i) begin
    last_q     <= toggle;
    received_o <= toggle != last_q;
    if (toggle != last_q) value_o <= value_q;
  end
endmodule
