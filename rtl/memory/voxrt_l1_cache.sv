// A lane's own cache of octree lines (blocks of eight words): tags first, then data. It answers like the other forms of
// memory: the word comes five clocks after its address, or it does not and the ray asks again when it comes round, every
// TurnClocks clocks.
//
//   0 address | 1 tags, what to do | 2, 3 block RAM | 4 choose the word
//
// A line that is not there is asked for, once, and takes the place of the least recently used one of its set. A set asks
// for one line at a time. Once that has come, it stays for a turn at least: in this time each ray that waits for it comes
// and reads it. So two rays that want the same place cannot evict each other's line before it is read.
//
// The state of a set is in memories of one bit per set. Each has one writer, which needs no other port to write a
// difference: a set waits for a line when asked_set_q and come_set_q differ, and takes no other line while asked_set_q
// and free_set_q do.
//
// The line that a pointer leads to is not asked for before its ray comes round: that would take a second look-up of tags
// per clock, a third of this cache, and save 1 % of the clocks (2 % with one lane and with four).
`include "voxrt_assert.svh"

module voxrt_l1_cache
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter int unsigned SetBits = 5,  // 2**SetBits sets: 1 or more, less than BlockBits.
  parameter int unsigned Ways = 4,  // Lines of a set: 1, 2 or 4.
  // Clocks until a ray comes round: 2 or more.
  parameter int unsigned TurnClocks = lane_slots(memory_clocks(int'(CachedForm))),
  parameter bit Lod = 1'b0
) (
  input logic clk_i,
  input logic rst_ni,
  input logic clear_i,  // Drop all lines; only when idle_o.
  output logic idle_o,  // No line is asked for.
  // Lane.
  input logic read_i,
  input logic [BlockBits+3:0] address_i,  // {line, octant}
  output logic ack_o,
  output logic [payload_bits(BlockBits, Lod):0] word_o,
  // Lines: requests, and answers in any order, each for the set of the one line that it waits for, two words per clock:
  // see voxrt_line_queue.
  output logic request_valid_o,
  input logic request_ready_i,
  output logic [BlockBits:0] request_line_o,
  input logic answer_valid_i,
  input logic [SetBits-1:0] answer_set_i,
  input logic [1:0] answer_quarter_i,
  input logic [1:0][payload_bits(BlockBits, Lod):0] answer_pair_i
);
  if (SetBits < 1 || SetBits >= BlockBits)
    $error("voxrt_l1_cache: SetBits must be 1 bit or more, and less than BlockBits");
  if (Ways != 1 && Ways != 2 && Ways != 4) $error("voxrt_l1_cache: Ways must be 1, 2 or 4");
  if (TurnClocks < 2) $error("voxrt_l1_cache: TurnClocks must be 2 clocks or more");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned WordBits = PayloadBits + 1;
  localparam int unsigned LineBits = BlockBits + 1;
  localparam int unsigned TagBits1 = LineBits - SetBits;
  localparam int unsigned Sets = 2 ** SetBits;
  localparam int unsigned WayBits = Ways > 1 ? $clog2(Ways) : 1;
  localparam int unsigned Outstanding = l1_outstanding(SetBits);
  localparam int unsigned CountBits = $clog2(Outstanding) + 1;

  // States of the sets: see above.
  logic asked_set_q[Sets], come_set_q[Sets], free_set_q[Sets];
  logic [WayBits-1:0] new_way_q[Sets];  // The way for the line that the set has asked for last.

  // Which ways were used last, by set: bit b (b - 1) / 2 + a says that a was used after b, for ways a < b.
  localparam int unsigned OrderBits = Ways > 1 ? Ways * (Ways - 1) / 2 : 1;
  logic [OrderBits-1:0] order_q[Sets];

  // After a reset and when lines are dropped, all sets are written, for a turn at least: then nothing is under way.
  localparam int unsigned WalkBits = $clog2(TurnClocks + 1) > SetBits ? $clog2(TurnClocks + 1) : SetBits;
  logic [WalkBits-1:0] walk_q;
  logic [SetBits-1:0] walk_set;
  logic walks_q;

  assign walk_set = walk_q[SetBits-1:0];

  always_ff @(posedge clk_i) begin
    walk_q <= walk_q + 1'b1;
    if (walk_q == '1) walks_q <= 1'b0;
    if (!rst_ni || clear_i) begin
      walk_q  <= '0;
      walks_q <= 1'b1;
    end
  end

  // 1 tags.
  logic read1_q;
  logic [LineBits-1:0] line1_q;
  logic [2:0] octant1_q;
  logic [SetBits-1:0] set1;
  logic [Ways-1:0] same1;

  assign set1 = line1_q[SetBits-1:0];

  // What becomes of the tags.
  logic allocates;
  logic [SetBits-1:0] new_row;  // The row that is written.
  logic [TagBits1:0] new_tag;  // A bit that says that the way is not empty, and the line's upper bits.
  logic [WayBits-1:0] victim;

  assign new_row = walks_q ? walk_set : set1;
  assign new_tag = walks_q ? '0 : {1'b1, line1_q[LineBits-1:SetBits]};

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic [TagBits1:0] tag_q[Sets];

    always_ff @(posedge clk_i) if (walks_q || (allocates && victim == WayBits'(w))) tag_q[new_row] <= new_tag;

    assign same1[w] = tag_q[set1] == {1'b1, line1_q[LineBits-1:SetBits]};
  end

  logic [Ways-1:0] hit_ways;
  logic [WayBits-1:0] hit_way;
  logic pending1, taken1, hit;
  logic [CountBits-1:0] outstanding_q;

  always_comb begin
    pending1 = asked_set_q[set1] != come_set_q[set1];
    taken1   = asked_set_q[set1] != free_set_q[set1];
    hit_way  = '0;
    for (int unsigned w = 0; w < Ways; w++) begin
      hit_ways[w] = same1[w] && !(pending1 && new_way_q[set1] == WayBits'(w));
      if (same1[w]) hit_way |= WayBits'(w);
    end
    hit       = read1_q && hit_ways != '0;
    // A set that takes a line waits for none: what is in its tags is there.
    allocates = read1_q && same1 == '0 && !taken1 && outstanding_q != CountBits'(Outstanding) && !walks_q;
  end

  // The least recently used way of a set, from its order.
  function automatic logic [WayBits-1:0] oldest_way(logic [OrderBits-1:0] order);
    oldest_way = '0;
    for (int unsigned w = 0; w < Ways; w++) begin
      automatic logic oldest = 1'b1;
      for (int unsigned a = 0; a < w; a++) oldest &= order[w*(w-1)/2+a];
      for (int unsigned b = w + 1; b < Ways; b++) oldest &= !order[b*(b-1)/2+w];
      if (oldest) oldest_way |= WayBits'(w);
    end
  endfunction

  assign victim = oldest_way(order_q[set1]);

  // Sets whose line has come, for a turn. The way is readable: the last two words are read after they are written.
  typedef struct packed {
    logic               valid;
    logic [SetBits-1:0] set;
    logic               asked;
  } come_t;
  come_t come, come_q[TurnClocks], turn;

  assign come = '{
          valid: answer_valid_i && answer_quarter_i == 2'd2,
          set: answer_set_i,
          asked: asked_set_q[answer_set_i]
      };
  assign turn = come_q[TurnClocks-1];

  always_ff @(posedge clk_i) begin
    come_q[0] <= come;
    for (int unsigned t = 1; t < TurnClocks; t++) come_q[t] <= come_q[t-1];
  end

  // A hit counts as use. A line that comes is used by the ray that waits for it, before its set asks for another.
  logic [OrderBits-1:0] order;

  always_comb begin
    order = order_q[set1];
    for (int unsigned b = 1; b < Ways; b++) begin
      for (int unsigned a = 0; a < b; a++) begin
        if (hit_way == WayBits'(a)) order[b*(b-1)/2+a] = 1'b1;
        if (hit_way == WayBits'(b)) order[b*(b-1)/2+a] = 1'b0;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (walks_q || hit) order_q[new_row] <= walks_q ? '0 : order;
    if (walks_q || allocates) asked_set_q[new_row] <= !walks_q && !free_set_q[set1];
    if (walks_q || come.valid) come_set_q[walks_q?walk_set : come.set] <= !walks_q && come.asked;
    if (walks_q || turn.valid) free_set_q[walks_q?walk_set : turn.set] <= !walks_q && turn.asked;
    if (allocates) new_way_q[set1] <= victim;
    outstanding_q <= outstanding_q + CountBits'(allocates) - CountBits'(answer_valid_i && answer_quarter_i == 2'd3);
    if (!rst_ni) outstanding_q <= '0;
  end

  // Requests.
  logic unused_request_ready;

  voxrt_fifo #(
    .Width(LineBits),
    .Depth(Outstanding)
  ) u_requests (
    .clk_i,
    .rst_ni,
    .valid_i(allocates),
    .ready_o(unused_request_ready),
    .data_i (line1_q),
    .valid_o(request_valid_o),
    .ready_i(request_ready_i),
    .data_o (request_line_o)
  );

  // 2 to 4 data.
  logic [4:2] hit_q;
  logic [SetBits+WayBits-1:0] way2_q;
  logic [2:0] octant2_q;
  logic [1:0] odd_q;  // Whether the word is odd, in stages 4 and 3.
  logic [1:0][WordBits-1:0] pair, unused_pair;
  logic [WordBits-1:0] word4, word_q;
  logic ack_q;

  voxrt_block_ram #(
    .Width(2 * WordBits),
    .Depth(Sets * 2 ** WayBits * 4)
  ) u_data (
    .clk_i,
    .a_read_i (1'b0),
    .a_write_i(answer_valid_i),
    .a_row_i  ({answer_set_i, new_way_q[answer_set_i], answer_quarter_i}),
    .a_data_i (answer_pair_i),
    .a_data_o (unused_pair),
    .b_read_i (hit_q[2]),
    .b_row_i  ({way2_q, octant2_q[2:1]}),
    .b_data_o (pair)
  );

  assign word4 = pair[odd_q[1]];

  always_ff @(posedge clk_i) begin
    read1_q   <= read_i;
    line1_q   <= address_i[BlockBits+3:3];
    octant1_q <= address_i[2:0];
    hit_q     <= {hit_q[3:2], hit};
    way2_q    <= {set1, hit_way};
    octant2_q <= octant1_q;
    odd_q     <= {odd_q[0], octant2_q[0]};
    ack_q     <= hit_q[4];
    word_q    <= word4;
    if (!rst_ni) begin
      read1_q <= 1'b0;
      hit_q   <= '0;
      ack_q   <= 1'b0;
    end
  end

  assign idle_o = outstanding_q == '0 && !walks_q && !read1_q;
  assign ack_o  = ack_q;
  assign word_o = word_q;

  `VOXRT_ASSERT(LineInOneWay, walks_q || !read1_q || $onehot0(same1))
  `VOXRT_ASSERT(QueuesHoldLines, walks_q || outstanding_q <= CountBits'(Outstanding))
  `VOXRT_ASSERT(
      LineWasAskedFor,
      walks_q || !answer_valid_i || asked_set_q[answer_set_i] != come_set_q[answer_set_i] || answer_quarter_i == 2'd3)
  `VOXRT_ASSERT(SetAsksForOneLine, walks_q || !allocates || asked_set_q[set1] == free_set_q[set1])
  `VOXRT_ASSERT(ClearedWhenIdle, walks_q || !clear_i || idle_o)
endmodule
