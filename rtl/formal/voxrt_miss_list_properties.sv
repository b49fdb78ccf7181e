// Every lane whose miss is accepted gets its line once, when its entry ends; none else gets it. A line that is waited for
// is fetched once, and comes with its way. The environment has one lane per pipe; it does not ask for a line that it waits
// for, or that has come in the clock before.
module voxrt_miss_list_properties #(
  parameter int unsigned LineBits = 2,
  parameter int unsigned Entries  = 2
) (
  input logic                clk_i,
  input logic                rst_ni,
  input logic [         1:0] miss_i,
  input logic [LineBits-1:0] next_line0_i,
  input logic [LineBits-1:0] next_line1_i,
  input logic                fetch_ready_i,
  input logic                come_i
);
  logic empty_o, fetch_valid_o;
  logic [1:0] accepted_o, come_way_o;
  logic [LineBits-1:0] fetch_line_o, come_line_o, next_line[2], line[2];
  logic [0:0] lanes[2], free_lanes_o[2];
  logic [1:0] way[2];

  // A line is freed two clocks after it comes.
  logic [3:1] come_q;
  logic [LineBits-1:0] come_line_q[1:3];

  assign next_line = '{next_line0_i, next_line1_i};
  assign lanes     = '{1'b1, 1'b1};
  assign way       = '{2'(line[0]), 2'(line[1])};

  always_ff @(posedge clk_i) line <= next_line;

  voxrt_miss_list #(
    .Pipes    (2),
    .PipeLanes(1),
    .LineBits (LineBits),
    .Entries  (Entries)
  ) dut (
    .clk_i,
    .rst_ni,
    .empty_o,
    .miss_i,
    .next_line_i(next_line),
    .line_i     (line),
    .lanes_i    (lanes),
    .way_i      (way),
    .accepted_o,
    .fetch_valid_o,
    .fetch_ready_i,
    .fetch_line_o,
    .come_i,
    .come_line_o,
    .come_way_o,
    .free_i     (come_q[2]),
    .free_lanes_o
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);

  // Fetched, and not come.
  logic [$clog2(Entries):0] fetched_q;

  always_ff @(posedge clk_i) begin
    fetched_q   <= fetched_q + ($bits(fetched_q))'(fetch_valid_o && fetch_ready_i) - ($bits(fetched_q))'(come_i);
    come_q      <= {come_q[2:1], come_i};
    come_line_q <= '{come_line_o, come_line_q[1], come_line_q[2]};
    if (!rst_ni) begin
      fetched_q <= '0;
      come_q    <= '0;
    end
  end

  always_comb begin
    if (come_i) assume (fetched_q != '0);
    // The pipes have no lookup beside a line.
    if (come_q[2]) assume (miss_i == '0);
    for (int unsigned p = 0; p < 2; p++) if (come_q[3] && come_line_q[3] == line[p]) assume (!miss_i[p]);
  end

  // Lanes that wait for the line that is followed.
  logic [LineBits-1:0] target;
  always_ff @(posedge clk_i) target <= target;
  logic [1:0] waits_q, gets;
  logic on_way_q;

  always_comb begin
    for (int unsigned p = 0; p < 2; p++) begin
      if (waits_q[p] && line[p] == target) assume (!miss_i[p]);
      gets[p] = come_q[2] && come_line_q[2] == target && free_lanes_o[p][0];
      if (started_q && rst_ni) begin
        assert (!gets[p] || waits_q[p]);
        if (come_q[2] && come_line_q[2] == target) assert (gets[p] == waits_q[p]);
        // What is waited for is under way.
        if (waits_q[p]) assert (!empty_o);
        if (waits_q[p] && !on_way_q) assert (fetch_valid_o);
        // One that misses alone enters an empty list, and joins the other that waits for its line.
        if (miss_i[p] && !miss_i[1-p] && empty_o) assert (accepted_o[p]);
        if (miss_i[p] && line[p] == target && waits_q[1-p]) assert (accepted_o[p]);
      end
    end
    if (started_q && rst_ni && come_i) assert (come_way_o == 2'(come_line_o));
    // Fetched once.
    if (started_q && rst_ni && fetch_valid_o && fetch_line_o == target) assert (!on_way_q);
  end

  always_ff @(posedge clk_i) begin
    for (int unsigned p = 0; p < 2; p++) begin
      if (gets[p]) waits_q[p] <= 1'b0;
      if (accepted_o[p] && line[p] == target) waits_q[p] <= 1'b1;
    end
    if (come_q[2] && come_line_q[2] == target) on_way_q <= 1'b0;
    if (fetch_valid_o && fetch_ready_i && fetch_line_o == target) on_way_q <= 1'b1;
    if (!rst_ni) begin
      waits_q  <= '0;
      on_way_q <= 1'b0;
    end
    cover (started_q && rst_ni && gets == '1);
  end
endmodule
