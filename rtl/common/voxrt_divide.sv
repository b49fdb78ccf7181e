// A pipeline that divides: dividend / divisor, rounded down, exact, one quotient per clock. It has a stage per bit of
// the quotient, which must fit: dividend < divisor * 2**QuotientBits.
//
// Use it where a division may start at every clock. For a division now and then, a loop of one stage is smaller, as in
// voxrt_hit_point.
//
// Non-restoring: a stage adds the divisor to the remainder when that is negative, and subtracts it otherwise, in one
// adder. The bit is 1 where the result is not negative.
module voxrt_divide #(
  parameter int unsigned DivisorBits  = 8,  // 1 or more.
  parameter int unsigned QuotientBits = 8   // 2 or more.
) (
  input logic clk_i,
  input logic [QuotientBits-1:0] valid_i,  // Whether each stage has a value: its registers hold where it has none.
  input logic [DivisorBits+QuotientBits-1:0] dividend_i,
  input logic [DivisorBits-1:0] divisor_i,
  output logic [QuotientBits-1:0] quotient_o  // QuotientBits clocks later.
);
  if (DivisorBits < 1) $error("voxrt_divide: DivisorBits must be 1 bit or more");
  if (QuotientBits < 2) $error("voxrt_divide: QuotientBits must be 2 bits or more");

  // Before stage s: the remainder (highest bit: negative), then the dividend's bits to come and the quotient's so far.
  logic [DivisorBits:0] remainder[QuotientBits+1];
  logic [QuotientBits-1:0] bits[QuotientBits+1];
  logic [DivisorBits-1:0] divisor[QuotientBits+1];

  assign {remainder[0], bits[0]} = {1'b0, dividend_i};
  assign divisor[0]              = divisor_i;
  assign quotient_o              = bits[QuotientBits];

  for (genvar s = 0; s < QuotientBits; s++) begin : gen_bit
    logic subtracts, carry;
    logic [DivisorBits:0] sum, remainder_q;
    logic [DivisorBits-1:0] divisor_q;
    logic [QuotientBits-1:0] bits_q;

    assign subtracts = !remainder[s][DivisorBits];
    // + divisor, or + ~divisor + 1. What leaves at the top is what the sign was before.
    assign {sum, carry} = {remainder[s][DivisorBits-1:0], bits[s][QuotientBits-1], 1'b1} +
        {subtracts, divisor[s] ^ {DivisorBits{subtracts}}, subtracts};

    always_ff @(posedge clk_i) begin
      if (valid_i[s]) begin
        remainder_q <= sum;
        divisor_q   <= divisor[s];
        bits_q      <= {bits[s][QuotientBits-2:0], !sum[DivisorBits]};
      end
    end

    logic unused;
    assign unused         = carry;
    assign remainder[s+1] = remainder_q;
    assign divisor[s+1]   = divisor_q;
    assign bits[s+1]      = bits_q;
  end
endmodule
