// Quotient of QuotientBits digits, one a stage: dividend / divisor rounded down, exact; one a clock. The quotient must
// fit, that is dividend < divisor * 2**QuotientBits.
//
// Non-restoring: a stage adds the divisor to what remains when that is negative, and takes it away otherwise, in one
// adder. The digit is 1 where the result is not negative, as if what was taken too much had been put back.
module voxrt_divide #(
  parameter int unsigned DivisorBits  = 8,
  parameter int unsigned QuotientBits = 8
) (
  input  logic                                clk_i,
  input  logic [            QuotientBits-1:0] valid_i,     // Of each stage: registers hold where it is low.
  input  logic [DivisorBits+QuotientBits-1:0] dividend_i,
  input  logic [             DivisorBits-1:0] divisor_i,
  output logic [            QuotientBits-1:0] quotient_o   // QuotientBits clocks later.
);
  // Before stage s: what remains (highest bit: negative), then the dividend's digits to come and the quotient's so far.
  logic [DivisorBits:0]    remainder[QuotientBits+1];
  logic [QuotientBits-1:0] digits   [QuotientBits+1];
  logic [DivisorBits-1:0]  divisor  [QuotientBits+1];

  assign {remainder[0], digits[0]} = {1'b0, dividend_i};
  assign divisor[0]                = divisor_i;
  assign quotient_o                = digits[QuotientBits];

  for (genvar s = 0; s < QuotientBits; s++) begin : gen_digit
    logic                    takes, carry;
    logic [DivisorBits:0]    sum, remainder_q;
    logic [DivisorBits-1:0]  divisor_q;
    logic [QuotientBits-1:0] digits_q;

    assign takes = !remainder[s][DivisorBits];
    // + divisor, or + ~divisor + 1. What leaves at the top is what the sign was before.
    assign {sum, carry} = {remainder[s][DivisorBits-1:0], digits[s][QuotientBits-1], 1'b1} +
        {takes, divisor[s] ^ {DivisorBits{takes}}, takes};

    always_ff @(posedge clk_i) begin
      if (valid_i[s]) begin
        remainder_q <= sum;
        divisor_q   <= divisor[s];
        digits_q    <= {digits[s][QuotientBits-2:0], !sum[DivisorBits]};
      end
    end

    logic unused;
    assign unused         = carry;
    assign remainder[s+1] = remainder_q;
    assign divisor[s+1]   = divisor_q;
    assign digits[s+1]    = digits_q;
  end
endmodule
