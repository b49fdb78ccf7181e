// Quotient of QuotientBits digits, one a stage: dividend / divisor rounded down, exact; one a clock. The quotient must
// fit, that is dividend < divisor * 2**QuotientBits.
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
  // Before stage s: what remains, then the dividend's digits to come and the quotient's digits so far.
  logic [DivisorBits-1:0]  remainder[QuotientBits+1];
  logic [QuotientBits-1:0] digits   [QuotientBits+1];
  logic [DivisorBits-1:0]  divisor  [QuotientBits+1];

  assign {remainder[0], digits[0]} = dividend_i;
  assign divisor[0]                = divisor_i;
  assign quotient_o                = digits[QuotientBits];

  for (genvar s = 0; s < QuotientBits; s++) begin : gen_digit
    logic [DivisorBits:0]    trial;
    logic                    fits;
    logic [DivisorBits-1:0]  remainder_q, divisor_q;
    logic [QuotientBits-1:0] digits_q;

    assign trial = {remainder[s], digits[s][QuotientBits-1]};
    assign fits  = trial >= {1'b0, divisor[s]};

    always_ff @(posedge clk_i) begin
      if (valid_i[s]) begin
        remainder_q <= fits ? DivisorBits'(trial - {1'b0, divisor[s]}) : trial[DivisorBits-1:0];
        divisor_q   <= divisor[s];
        digits_q    <= {digits[s][QuotientBits-2:0], fits};
      end
    end

    assign remainder[s+1] = remainder_q;
    assign divisor[s+1]   = divisor_q;
    assign digits[s+1]    = digits_q;
  end
endmodule
