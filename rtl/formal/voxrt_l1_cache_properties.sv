// A word that is acknowledged is the one asked for, never another block's. Each line is asked for once until it comes.
// And rays get on: three rays that read any lines, through a cache of two places, with a memory that answers each
// request within MemoryClocks: some ray gets its word within Patience clocks.
//
// The environment has a ring of three rays, each of which reads a word until it gets it, and then any other.
module voxrt_l1_cache_properties
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits    = 5,
  parameter int unsigned SetBits      = 1,
  parameter int unsigned Ways         = 1,
  parameter int unsigned MemoryClocks = 2,
  parameter int unsigned Patience     = 22
) (
  input logic                                                  clk_i,
  input logic                                                  rst_ni,
  input logic                                                  start_i,          // A ray reads.
  input logic [BlockBits+3:0]                                  address_i,        // What it reads next.
  input logic                                                  request_ready_i,
  input logic                                                  answer_i,
  input logic [  SetBits-1:0]                                  answer_set_i,
  input logic [          7:0][payload_bits(BlockBits, 1'b0):0] answer_words_i
);
  localparam int unsigned LineBits = BlockBits + 1;
  localparam int unsigned Rays = 3;
  localparam int unsigned Sets = 2 ** SetBits;
  localparam int unsigned Clocks = 5;
  localparam int unsigned TurnClocks = 6;

  logic idle_o, read, ack_o, request_valid_o;
  logic [BlockBits+3:0] address;
  logic [LineBits-1:0] request_line_o;
  logic [payload_bits(BlockBits, 1'b0):0] word_o;

  logic [SetBits-1:0] fill_set;
  logic fill_valid;
  logic [1:0] fill_quarter;
  logic [1:0][payload_bits(BlockBits, 1'b0):0] fill_pair;

  voxrt_line_queue #(
    .Lanes   (1),
    .SetBits (SetBits),
    .WordBits(payload_bits(BlockBits, 1'b0) + 1),
    .Depth   (Sets)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .valid_i  (answer_i),
    .set_i    (answer_set_i),
    .words_i  (answer_words_i),
    .valid_o  (fill_valid),
    .set_o    (fill_set),
    .quarter_o(fill_quarter),
    .pair_o   (fill_pair)
  );

  voxrt_l1_cache #(
    .BlockBits (BlockBits),
    .SetBits   (SetBits),
    .Ways      (Ways),
    .TurnClocks(TurnClocks)
  ) dut (
    .clk_i,
    .rst_ni,
    .clear_i         (1'b0),
    .idle_o,
    .read_i          (read),
    .address_i       (address),
    .ack_o,
    .word_o,
    .request_valid_o,
    .request_ready_i,
    .request_line_o,
    .answer_valid_i  (fill_valid),
    .answer_set_i    (fill_set),
    .answer_quarter_i(fill_quarter),
    .answer_pair_i   (fill_pair)
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb
    if (started_q)
      assume (rst_ni);
      else assume (!rst_ni);

  // Rays come to the port in turn, once the cache is ready. The answer to a read comes Clocks clocks later, so a turn is
  // longer: TurnClocks is 3 x 2 clocks.
  logic [2:0] turn_q;
  logic [Rays-1:0] reads_q;
  logic [BlockBits+3:0] wanted_q[Rays];
  logic [Clocks-1:0] asked_q;
  logic [1:0] ray, ray_q[Clocks];
  logic slot, ready_q;

  assign slot    = !turn_q[0] && (ready_q || idle_o);
  assign ray     = turn_q[2:1];
  assign read    = slot && (reads_q[ray] || start_i);
  assign address = reads_q[ray] ? wanted_q[ray] : address_i;

  always_ff @(posedge clk_i) begin
    turn_q  <= turn_q == 3'(TurnClocks - 1) ? '0 : turn_q + 1'b1;
    ready_q <= ready_q || idle_o;
    asked_q <= {asked_q[Clocks-2:0], read};
    ray_q   <= '{ray, ray_q[0], ray_q[1], ray_q[2], ray_q[3]};
    if (read) begin
      reads_q[ray]  <= 1'b1;
      wanted_q[ray] <= address;
    end
    if (ack_o) reads_q[ray_q[Clocks-1]] <= 1'b0;
    if (!rst_ni) begin
      turn_q  <= '0;
      asked_q <= '0;
      reads_q <= '0;
      ready_q <= 1'b0;
    end
  end

  // The memory: a word of it, which is followed; all other words may be anything else.
  logic [BlockBits+3:0] target;
  logic [payload_bits(BlockBits, 1'b0):0] target_word;
  always_ff @(posedge clk_i) begin
    target      <= target;
    target_word <= target_word;
  end

  // Lines that were taken and not answered, by set, and for how long.
  logic [Sets-1:0] taken_q;
  logic [LineBits-1:0] line_q[Sets];
  logic [2:0] age_q[Sets];
  logic [SetBits-1:0] request_set;

  assign request_set = request_line_o[SetBits-1:0];

  always_ff @(posedge clk_i) begin
    for (int unsigned s = 0; s < Sets; s++) if (taken_q[s]) age_q[s] <= age_q[s] + 1'b1;
    if (answer_i) taken_q[answer_set_i] <= 1'b0;
    if (request_valid_o && request_ready_i) begin
      taken_q[request_set] <= 1'b1;
      line_q[request_set]  <= request_line_o;
      age_q[request_set]   <= '0;
    end
    if (!rst_ni) taken_q <= '0;
  end

  always_comb begin
    // Fair: requests are taken at once, and answered in time.
    if (started_q) assume (request_ready_i);
    for (int unsigned s = 0; s < Sets; s++) begin
      if (started_q && taken_q[s] && age_q[s] == 3'(MemoryClocks)) assume (answer_i && answer_set_i == SetBits'(s));
    end
    if (answer_i) begin
      assume (taken_q[answer_set_i]);
      for (int unsigned o = 0; o < 8; o++) begin
        if ({line_q[answer_set_i], 3'(o)} == target)
          assume (answer_words_i[o] == target_word);
          else assume (answer_words_i[o] != target_word);
      end
    end
  end

  // Each is asked for once.
  always_comb if (started_q && request_valid_o) assert (!taken_q[request_set] || answer_i);

  // Right words, of the rays that have asked.
  logic [BlockBits+3:0] answered;
  assign answered = wanted_q[ray_q[Clocks-1]];

  always_comb begin
    if (started_q && rst_ni && ack_o) begin
      assert (asked_q[Clocks-1] && reads_q[ray_q[Clocks-1]]);
      assert ((word_o == target_word) == (answered == target));
    end
  end

  // Progress.
  logic [4:0] waits_q;

  always_ff @(posedge clk_i) begin
    waits_q <= waits_q + 1'b1;
    if (!rst_ni || ack_o || reads_q == '0) waits_q <= '0;
  end

  always_comb if (started_q) assert (waits_q < 5'(Patience));

  always_ff @(posedge clk_i) begin
    cover (started_q && ack_o && answered == target);
  end
endmodule
