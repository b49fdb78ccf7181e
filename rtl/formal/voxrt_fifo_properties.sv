// What goes in comes out, in order, once, and nothing else: one value, chosen freely, is followed through the FIFO.
// Proven without bound by induction: the two assertions on indices tie the counters to the value followed.
module voxrt_fifo_properties #(
  parameter int unsigned Width = 4,
  parameter int unsigned Depth = 4
) (
  input logic             clk_i,
  input logic             rst_ni,
  input logic             valid_i,
  input logic [Width-1:0] data_i,
  input logic             ready_i,
  input logic             follow    // The solver's choice.
);
  localparam int unsigned IndexBits = $clog2(Depth);

  logic ready_o, valid_o;
  logic [Width-1:0] data_o;

  voxrt_fifo #(
    .Width(Width),
    .Depth(Depth)
  ) dut (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .data_i,
    .valid_o,
    .ready_i,
    .data_o
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);

  // How many are inside.
  logic [IndexBits:0] count_q;
  logic pushes, pops;

  assign pushes = valid_i && ready_o;
  assign pops   = valid_o && ready_i;

  always_ff @(posedge clk_i) begin
    count_q <= count_q + (IndexBits + 1)'(pushes) - (IndexBits + 1)'(pops);
    if (!rst_ni) count_q <= '0;
  end

  // The value followed: pushed at a time that the solver chooses; ahead_q others leave before it.
  logic inside_q;
  logic [IndexBits:0] ahead_q;
  logic [Width-1:0] value_q;
  logic follows;

  assign follows = pushes && follow && !inside_q;

  always_ff @(posedge clk_i) begin
    if (follows) begin
      inside_q <= 1'b1;
      value_q  <= data_i;
      ahead_q  <= count_q - (IndexBits + 1)'(pops);
    end else if (inside_q && pops) begin
      if (ahead_q == '0) inside_q <= 1'b0;
      else ahead_q <= ahead_q - 1'b1;
    end
    if (!rst_ni) inside_q <= 1'b0;
  end

  logic [IndexBits:0] index;
  assign index = dut.read_q + ahead_q;

  always_comb begin
    if (started_q) begin
      assert (count_q == dut.write_q - dut.read_q);
      assert (count_q <= (IndexBits + 1)'(Depth));
      assert (ready_o == (count_q != (IndexBits + 1)'(Depth)));
      assert (valid_o == (count_q != '0));
      if (inside_q) begin
        assert (ahead_q < count_q);
        assert (dut.data_q[index[IndexBits-1:0]] == value_q);
        if (ahead_q == '0) assert (valid_o && data_o == value_q);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    cover (started_q && count_q == (IndexBits + 1)'(Depth));
    cover (started_q && inside_q && ahead_q == '0 && pops);
  end
endmodule
