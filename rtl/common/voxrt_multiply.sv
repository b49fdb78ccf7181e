// The product of two whole numbers, two clocks later.
//
// Use it for each product that is wider than a multiplier of the part: how a product is cut into multipliers decides
// the clock and the number of DSP slices, and stands here once. voxrt_pkg::MultiplierBits says what the part has.
//
// 25 x 18: the lowest LogicBits bits of a are multiplied in logic, and all others left to synthesis, which cascades DSP
// slices of 7-series parts and moves both registers and the sum into them; a few bits in logic may spare a slice. 18 x
// 18: in parts, with a register behind each multiplier and one behind their sum.
module voxrt_multiply
  import voxrt_pkg::*;
#(
  parameter int unsigned ABits     = 20,  // 1 or more.
  parameter int unsigned BBits     = 20,  // 1 or more.
  parameter int unsigned LogicBits = 0    // Bits of a that are multiplied in logic: fewer than ABits.
) (
  input  logic                   clk_i,
  input  logic [      ABits-1:0] a_i,
  input  logic [      BBits-1:0] b_i,
  output logic [ABits+BBits-1:0] product_o
);
  if (ABits < 1) $error("voxrt_multiply: ABits must be 1 bit or more");
  if (BBits < 1) $error("voxrt_multiply: BBits must be 1 bit or more");
  if (LogicBits >= ABits) $error("voxrt_multiply: LogicBits must be less than ABits");

  localparam int unsigned ProductBits = ABits + BBits;

  logic [ProductBits-1:0] product2_q;
  assign product_o = product2_q;

  if (MultiplierBits >= 25 && LogicBits > 0) begin : gen_split
    localparam int unsigned HighBits = ProductBits - LogicBits;
    // The narrower number's bits, two per row, choose multiples of the other.
    localparam bit AChooses = LogicBits < BBits;
    localparam int unsigned ChooseBits = AChooses ? LogicBits : BBits;
    localparam int unsigned ChosenBits = AChooses ? BBits : LogicBits;
    localparam int unsigned Rows = (ChooseBits + 1) / 2;
    localparam int unsigned LowBits = LogicBits + BBits;

    logic [2*Rows-1:0] chooses;
    logic [ChosenBits-1:0] chosen;
    logic [LowBits-1:0] low, low1_q;
    logic [HighBits-1:0] high1_q, high2_q;
    logic [LogicBits-1:0] low2_q;

    if (AChooses) begin : gen_a_chooses
      assign chooses = (2 * Rows)'(a_i[LogicBits-1:0]);
      assign chosen  = b_i;
    end else begin : gen_b_chooses
      assign chooses = (2 * Rows)'(b_i);
      assign chosen  = a_i[LogicBits-1:0];
    end

    always_comb begin
      low = '0;
      for (int unsigned i = 0; i < Rows; i++) begin
        low += (LowBits'(chooses[2*i] ? chosen : '0) + LowBits'({chooses[2*i+1] ? chosen : '0, 1'b0})) << (2 * i);
      end
    end

    always_ff @(posedge clk_i) begin
      high1_q <= HighBits'(a_i[ABits-1:LogicBits]) * HighBits'(b_i);
      low1_q  <= low;
      high2_q <= high1_q + HighBits'(low1_q[LowBits-1:LogicBits]);
      low2_q  <= low1_q[LogicBits-1:0];
    end

    assign product2_q = {high2_q, low2_q};
  end else if (MultiplierBits >= 25) begin : gen_wide
    logic [ProductBits-1:0] product1_q;

    always_ff @(posedge clk_i) begin
      product1_q <= ProductBits'(a_i) * ProductBits'(b_i);
      product2_q <= product1_q;
    end
  end else begin : gen_narrow
    // All parts of a number have the same size.
    localparam int unsigned AParts = (ABits + MultiplierBits - 1) / MultiplierBits;
    localparam int unsigned BParts = (BBits + MultiplierBits - 1) / MultiplierBits;
    localparam int unsigned APart = (ABits + AParts - 1) / AParts;
    localparam int unsigned BPart = (BBits + BParts - 1) / BParts;

    logic [AParts*APart-1:0] a;
    logic [BParts*BPart-1:0] b;
    logic [APart+BPart-1:0] part1_q[AParts][BParts];
    logic [ProductBits-1:0] sum;

    assign a = (AParts * APart)'(a_i);
    assign b = (BParts * BPart)'(b_i);

    always_comb begin
      sum = '0;
      for (int unsigned i = 0; i < AParts; i++) begin
        for (int unsigned j = 0; j < BParts; j++) sum += ProductBits'(part1_q[i][j]) << (i * APart + j * BPart);
      end
    end

    always_ff @(posedge clk_i) begin
      for (int unsigned i = 0; i < AParts; i++) begin
        for (int unsigned j = 0; j < BParts; j++) begin
          part1_q[i][j] <= (APart + BPart)'(a[i*APart+:APart]) * (APart + BPart)'(b[j*BPart+:BPart]);
        end
      end
      product2_q <= sum;
    end
  end
endmodule
