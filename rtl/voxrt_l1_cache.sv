// A lane's own cache of octree lines (blocks of eight words): tags first, then data. It answers like the other forms of
// memory: the word comes five clocks after its address, or it does not and the ray asks again when it comes round.
//
//   0 address | 1 tags, states, what to do | 2, 3 block RAM | 4 choose the word
//
// A line that is not there is asked for, once, and takes the place of the least recently used one of its set. Ways are
//   empty
//   pending  its line is asked for; at most one way of a set
//   fresh    its line has come, and the ray that waits for it has not been here since
//   valid
// Neither pending nor fresh lines are replaced: two rays that want the same place cannot evict each other's line before
// it is read. Each ray waits for one line at most, and comes back, so that a fresh line becomes valid.
//
// Prefetch: when a word is a pointer, its ray will want that block when it comes round. It is asked for at once. Such a
// line comes as valid, unless a ray has asked for it in the meantime: an error can end the ray. With Lod it is asked for
// three clocks later, when the lane knows whether the ray goes into the block at all.
module voxrt_l1_cache
  import voxrt_pkg::*;
#(
  parameter int unsigned BlockBits = 12,
  parameter int unsigned SetBits   = 5,    // 1 or more.
  parameter int unsigned Ways      = 4,
  parameter bit          Prefetch  = 1'b1,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  clear_i,          // Drop all lines; only when idle_o.
  output logic                                  idle_o,           // No line is asked for.
  // Lane.
  input  logic                                  read_i,
  input  logic                  [BlockBits+3:0] address_i,        // {line, octant}
  output logic                                  ack_o,
  output logic      [payload_bits(BlockBits, Lod):0] word_o,
  input  logic                                  stops_i,          // Lod: the ray of the word of three clocks ago hits it.
  // Lines: requests, and answers in any order, each for the set of the one line that is pending there.
  output logic                                  request_valid_o,
  input  logic                                  request_ready_i,
  output logic                    [BlockBits:0] request_line_o,
  input  logic                                  answer_valid_i,   // At any clock.
  input  logic                    [SetBits-1:0] answer_set_i,
  input  logic [7:0][payload_bits(BlockBits, Lod):0] answer_words_i
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned WordBits = PayloadBits + 1;
  localparam int unsigned LineBits = BlockBits + 1;
  localparam int unsigned TagBits1 = LineBits - SetBits;
  localparam int unsigned Sets = 2 ** SetBits;
  localparam int unsigned WayBits = Ways > 1 ? $clog2(Ways) : 1;
  // Lines asked for at a time: as many as the queue of answers holds. Each set asks for one at most.
  localparam int unsigned Outstanding = Sets < 8 ? Sets : 8;
  localparam int unsigned CountBits = $clog2(Outstanding) + 1;

  // Ways by set.
  logic [   Ways-1:0]           valid_q      [Sets];  // Fresh or valid.
  logic [   Ways-1:0]           fresh_q      [Sets];
  logic [   Sets-1:0]           pending_q, demanded_q;
  logic [WayBits-1:0]           pending_way_q[Sets];
  logic [   Ways-1:0][Ways-1:0] newer_q      [Sets];  // [a][b]: a was used after b.

  // 1 tags: of the lane's line and of the line to prefetch.
  logic                read1_q, prefetch, prefetch_waits_q;
  logic [LineBits-1:0] line1_q, prefetch_line_q;
  logic [         2:0] octant1_q;
  logic [ SetBits-1:0] set1, prefetch_set;
  logic [    Ways-1:0] same1, prefetch_same;

  assign set1         = line1_q[SetBits-1:0];
  assign prefetch_set = prefetch_line_q[SetBits-1:0];

  // What becomes of the tags.
  logic                allocates;
  logic [LineBits-1:0] new_line;
  logic [ SetBits-1:0] new_set;
  logic [ WayBits-1:0] victim;

  assign new_set = new_line[SetBits-1:0];

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic [TagBits1-1:0] tag_q[Sets];

    always_ff @(posedge clk_i) begin
      if (allocates && victim == WayBits'(w)) tag_q[new_set] <= new_line[LineBits-1:SetBits];
    end

    assign same1[w]         = tag_q[set1] == line1_q[LineBits-1:SetBits];
    assign prefetch_same[w] = tag_q[prefetch_set] == prefetch_line_q[LineBits-1:SetBits];
  end

  logic [    Ways-1:0] hit_ways;
  logic [ WayBits-1:0] hit_way;
  logic                hit, waits, wants, prefetches, may_ask;
  logic [   CountBits-1:0] asked_q;

  always_comb begin
    hit_ways = same1 & valid_q[set1];
    hit      = read1_q && hit_ways != '0;
    hit_way  = '0;
    for (int unsigned w = 0; w < Ways; w++) if (hit_ways[w]) hit_way |= WayBits'(w);
    waits      = read1_q && pending_q[set1] && same1[pending_way_q[set1]];
    wants      = read1_q && !hit && !pending_q[set1];
    prefetches = prefetch && (prefetch_same & valid_q[prefetch_set]) == '0 && !pending_q[prefetch_set];
    new_line   = wants ? line1_q : prefetch_line_q;
    may_ask    = asked_q != CountBits'(Outstanding);
  end

  // The least recently used way that may be replaced. Before all are used, the order may be none: then the first.
  logic [    Ways-1:0] replaceable, oldest;

  always_comb begin
    replaceable = ~fresh_q[new_set];
    oldest      = replaceable;
    for (int unsigned w = 0; w < Ways; w++) begin
      for (int unsigned v = 0; v < Ways; v++) begin
        if (v != w && replaceable[v] && !newer_q[new_set][v][w]) oldest[w] = 1'b0;
      end
    end
    if (oldest == '0) oldest = replaceable;
    victim = '0;
    for (int unsigned w = Ways; w > 0; w--) if (oldest[w-1]) victim = WayBits'(w - 1);
    allocates = (wants || prefetches) && may_ask && replaceable != '0;
  end

  // Lines come, two words per clock; the way is readable when the last two are read after they are written.
  localparam int unsigned AnswerBits = SetBits + 8 * WordBits;

  logic                     answer_valid, fills_last, unused_answer_ready;
  logic [7:0][WordBits-1:0] answer_words;
  logic [              1:0] quarter_q;
  logic [      SetBits-1:0] answer_set;

  voxrt_fifo #(
    .Width(AnswerBits),
    .Depth(Outstanding)
  ) u_answers (
    .clk_i,
    .rst_ni,
    .valid_i(answer_valid_i),
    .ready_o(unused_answer_ready),
    .data_i ({answer_set_i, answer_words_i}),
    .valid_o(answer_valid),
    .ready_i(quarter_q == 2'd3),
    .data_o ({answer_set, answer_words})
  );

  assign fills_last = answer_valid && quarter_q == 2'd2;

  // Recency is kept in memory: one set is written at a clock.
  logic [Ways-1:0][Ways-1:0] newer;
  logic                      touches;
  logic [       SetBits-1:0] touched_set;
  logic [       WayBits-1:0] touched;

  assign touches     = hit || allocates;
  assign touched_set = hit ? set1 : new_set;
  assign touched     = hit ? hit_way : victim;

  always_comb begin
    newer = newer_q[touched_set];
    for (int unsigned w = 0; w < Ways; w++) newer[w][touched] = 1'b0;
    newer[touched] = '1;
  end

  always_ff @(posedge clk_i) begin
    if (touches) newer_q[touched_set] <= newer;
    if (hit) fresh_q[set1][hit_way] <= 1'b0;
    if (waits) demanded_q[set1] <= 1'b1;
    if (fills_last) begin
      pending_q[answer_set]                            <= 1'b0;
      valid_q[answer_set][pending_way_q[answer_set]]   <= 1'b1;
      fresh_q[answer_set][pending_way_q[answer_set]]   <= demanded_q[answer_set] || (waits && set1 == answer_set);
    end
    if (allocates) begin
      pending_q[new_set]       <= 1'b1;
      demanded_q[new_set]      <= wants;
      pending_way_q[new_set]   <= victim;
      valid_q[new_set][victim] <= 1'b0;
    end
    asked_q <= asked_q + CountBits'(allocates) - CountBits'(answer_valid && quarter_q == 2'd3);
    if (answer_valid) quarter_q <= quarter_q + 1'b1;
    if (!rst_ni || clear_i) begin
      valid_q   <= '{default: '0};
      fresh_q   <= '{default: '0};
      pending_q <= '0;
    end
    if (!rst_ni) begin
      asked_q   <= '0;
      quarter_q <= '0;
    end
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
    .data_i (new_line),
    .valid_o(request_valid_o),
    .ready_i(request_ready_i),
    .data_o (request_line_o)
  );

  // 2 to 4 data.
  logic [                4:2] hit_q;
  logic [SetBits+WayBits-1:0] way2_q;
  logic [                2:0] octant2_q;
  logic [                1:0] odd_q;       // In stages 4 and 3.
  logic [ 1:0][WordBits-1:0] pair, unused_pair;
  logic [      WordBits-1:0] word4, word_q;
  logic                      ack_q;

  voxrt_block_ram #(
    .Width(2 * WordBits),
    .Depth(Sets * 2 ** WayBits * 4)
  ) u_data (
    .clk_i,
    .a_read_i (1'b0),
    .a_write_i(answer_valid),
    .a_row_i  ({answer_set, pending_way_q[answer_set], quarter_q}),
    .a_data_i ({answer_words[{quarter_q, 1'b1}], answer_words[{quarter_q, 1'b0}]}),
    .a_data_o (unused_pair),
    .b_read_i (hit_q[2]),
    .b_row_i  ({way2_q, octant2_q[2:1]}),
    .b_data_o (pair)
  );

  assign word4 = pair[odd_q[1]];

  always_ff @(posedge clk_i) begin
    read1_q    <= read_i;
    line1_q    <= address_i[BlockBits+3:3];
    octant1_q  <= address_i[2:0];
    hit_q      <= {hit_q[3:2], hit};
    way2_q     <= {set1, hit_way};
    octant2_q  <= octant1_q;
    odd_q      <= {odd_q[0], octant2_q[0]};
    ack_q      <= hit_q[4];
    word_q     <= word4;
    if (!rst_ni) begin
      read1_q <= 1'b0;
      hit_q   <= '0;
      ack_q   <= 1'b0;
    end
  end

  // What a word points to.
  logic pointer4, points;

  assign pointer4 = Prefetch && hit_q[4] && !word4[PayloadBits];

  if (Lod) begin : gen_lod
    logic [2:0]           pointer_q;
    logic [BlockBits-1:0] block_q  [3];

    assign points     = pointer_q != '0;
    assign prefetch = prefetch_waits_q && !stops_i;

    always_ff @(posedge clk_i) begin
      pointer_q        <= {pointer_q[1:0], pointer4};
      block_q          <= '{word4[BlockBits-1:0], block_q[0], block_q[1]};
      prefetch_waits_q <= pointer_q[2];
      prefetch_line_q  <= {1'b0, block_q[2]};
      if (!rst_ni) begin
        pointer_q        <= '0;
        prefetch_waits_q <= 1'b0;
      end
    end
  end else begin : gen_at_once
    logic unused_stops;

    assign unused_stops = stops_i;
    assign points       = 1'b0;
    assign prefetch   = prefetch_waits_q;

    always_ff @(posedge clk_i) begin
      prefetch_waits_q <= pointer4 && rst_ni;
      prefetch_line_q  <= {1'b0, word4[BlockBits-1:0]};
    end
  end

  assign idle_o = asked_q == '0 && !read1_q && !points && !prefetch;
  assign ack_o  = ack_q;
  assign word_o = word_q;

`ifndef SYNTHESIS
  // Before the first reset, nothing holds.
  logic reset_seen_q = 1'b0;
  always_ff @(posedge clk_i) reset_seen_q <= reset_seen_q || !rst_ni;

  always_ff @(posedge clk_i) begin
    if (rst_ni && reset_seen_q) begin
      assert ($onehot0(hit_ways)) else $error("a line is in two ways");
      assert (asked_q <= CountBits'(Outstanding)) else $error("more lines are asked for than the queues hold");
      assert (!answer_valid || pending_q[answer_set] || quarter_q == 2'd3) else $error("a line comes unasked");
      assert (!allocates || !fresh_q[new_set][victim]) else $error("a fresh line is replaced");
      assert (!clear_i || idle_o) else $error("lines are dropped while others come");
    end
  end
`endif
endmodule
