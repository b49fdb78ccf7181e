// A channel of DVI 1.0 (section 3.2): eight bits of a colour, or two bits of control, as ten bits with few transitions
// and without a mean. Three clocks.
module board_tmds (
  input  logic       clk_i,
  input  logic       rst_ni,
  input  logic       visible_i,
  input  logic [7:0] data_i,
  input  logic [1:0] control_i,
  output logic [9:0] word_o      // Bit 0 goes first.
);
  function automatic logic [3:0] ones(logic [7:0] bits);
    ones = '0;
    for (int unsigned i = 0; i < 8; i++) ones += 4'(bits[i]);
  endfunction

  // Each bit is the one before it XOR its data, or XNOR; bit 8 says which.
  function automatic logic [8:0] chain_of(logic [7:0] data, logic inverts);
    chain_of = '0;
    for (int unsigned i = 0; i < 8; i++) chain_of |= 9'((^(data << (7 - i))) ^ (inverts && i[0])) << i;
    chain_of[8] = !inverts;
  endfunction

  // 1: count.
  logic visible_q[1:2];
  logic [1:0] control_q[1:2];
  logic [7:0] data_q;
  logic [3:0] ones_q;

  // 2: few transitions.
  logic inverts;
  logic [8:0] chain, chain_q;
  logic [3:0] chain_ones_q;

  assign inverts = ones_q > 4'd4 || (ones_q == 4'd4 && !data_q[0]);
  assign chain   = chain_of(data_q, inverts);

  always_ff @(posedge clk_i) begin
    visible_q[1] <= visible_i;
    visible_q[2] <= visible_q[1];
    control_q[1] <= control_i;
    control_q[2] <= control_q[1];
    data_q       <= data_i;
    ones_q       <= ones(data_i);
    chain_q      <= chain;
    chain_ones_q <= ones(chain[7:0]);
  end

  // 3: no mean: invert where that brings the sum of ones less zeros towards 0.
  logic signed [4:0] balance_q, balance, difference;  // Half the number of ones less that of zeros.
  logic flips;

  assign difference = $signed({1'b0, chain_ones_q}) - 5'sd4;

  always_comb begin
    if (balance_q == '0 || difference == '0) flips = !chain_q[8];
    else flips = (balance_q > 0) == (difference > 0);
    balance = balance_q;
    if (balance_q == '0 || difference == '0) balance = chain_q[8] ? balance_q + difference : balance_q - difference;
    else if (flips) balance = balance_q + 5'(chain_q[8]) - difference;
    else balance = balance_q - 5'(!chain_q[8]) + difference;
  end

  always_ff @(posedge clk_i) begin
    balance_q <= visible_q[2] ? balance : '0;
    if (visible_q[2]) begin
      word_o <= {flips, chain_q[8], chain_q[7:0] ^ {8{flips}}};
    end else begin
      unique case (control_q[2])
        2'b00: word_o <= 10'b1101010100;
        2'b01: word_o <= 10'b0010101011;
        2'b10: word_o <= 10'b0101010100;
        2'b11: word_o <= 10'b1010101011;
      endcase
    end
    if (!rst_ni) balance_q <= '0;
  end
endmodule
