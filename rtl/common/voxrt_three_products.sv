// Three products of whole numbers. With RayClocks = 1 each has a multiplier of its own, and they come two clocks later.
// With RayClocks = 4 one multiplier makes all, for parts with few of them, and they come two beats later. Values stay
// for a beat (voxrt_turns).
module voxrt_three_products #(
  parameter int unsigned            RayClocks = 1,
  parameter int unsigned            ABits     = 20,  // See voxrt_multiply.
  parameter int unsigned            BBits     = 20,
  parameter bit          [2:0][7:0] LogicBits = '0   // The LogicBits of each multiplier; a shared one has none.
) (
  input  logic                   clk_i,
  input  logic [            1:0] turn_i,
  input  logic                   advance_i,
  input  logic [      ABits-1:0] a_i      [3],
  input  logic [      BBits-1:0] b_i      [3],
  output logic [ABits+BBits-1:0] product_o[3]
);
  if (RayClocks == 1) begin : gen_own
    logic unused;
    assign unused = &{turn_i, advance_i};

    for (genvar i = 0; i < 3; i++) begin : gen_product
      voxrt_multiply #(
        .ABits    (ABits),
        .BBits    (BBits),
        .LogicBits(32'(LogicBits[i]))
      ) u_multiply (
        .clk_i,
        .a_i      (a_i[i]),
        .b_i      (b_i[i]),
        .product_o(product_o[i])
      );
    end
  end else begin : gen_shared
    logic [ABits-1:0] a;
    logic [BBits-1:0] b;
    logic [ABits+BBits-1:0] product;

    always_comb begin
      a = a_i[2];
      b = b_i[2];
      for (int unsigned i = 0; i < 2; i++) begin
        if (turn_i == 2'(i)) begin
          a = a_i[i];
          b = b_i[i];
        end
      end
    end

    voxrt_multiply #(
      .ABits(ABits),
      .BBits(BBits)
    ) u_multiply (
      .clk_i,
      .a_i      (a),
      .b_i      (b),
      .product_o(product)
    );

    voxrt_collect #(
      .Width (ABits + BBits),
      .Clocks(2),
      .Beats (2)
    ) u_collect (
      .clk_i,
      .turn_i,
      .advance_i,
      .result_i (product),
      .results_o(product_o)
    );
  end
endmodule
