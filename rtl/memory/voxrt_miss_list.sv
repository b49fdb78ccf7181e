// The lines that voxrt_l2_cache waits for, in the order in which they are fetched and come, and which lanes want each.
// With it, lookups go on while lines are on their way, and a line that many lanes want is fetched once.
//
// A miss, per pipe, joins the entry of its line, or gets one: at most one new entry per clock, for which the pipes take
// turns. The lines of all entries are compared a clock before the miss is known, which makes a long path shorter. An
// entry stays until free_i, when its line is in the tags for all lookups that come after. A lane asks once for a line,
// until it comes.
//
// Who waits is in memories: a lane waits for an entry when its bits in joined_q and answered_q differ. The first is
// written by misses, the second when the entry ends. Both are cleared after a reset; until then nothing is accepted.
`include "voxrt_assert.svh"

module voxrt_miss_list #(
  parameter int unsigned Pipes     = 2,   // 1 or 2.
  parameter int unsigned PipeLanes = 8,   // Lanes per pipe: 1 or more.
  parameter int unsigned LineBits  = 13,  // Bits of a line's number: 1 or more.
  parameter int unsigned Entries   = 16   // Lines: a power of two, 2 or more.
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  output logic                 empty_o,
  // Misses.
  input  logic [    Pipes-1:0] miss_i,
  input  logic [ LineBits-1:0] next_line_i  [Pipes],  // line_i of the next clock.
  input  logic [ LineBits-1:0] line_i       [Pipes],
  input  logic [PipeLanes-1:0] lanes_i      [Pipes],  // One-hot.
  input  logic [          1:0] way_i        [Pipes],  // The way for its line.
  output logic [    Pipes-1:0] accepted_o,            // The entry that is joined or entered.
  // Lines to fetch.
  output logic                 fetch_valid_o,
  input  logic                 fetch_ready_i,
  output logic [ LineBits-1:0] fetch_line_o,
  // The next line comes: come_line_o goes to come_way_o.
  input  logic                 come_i,
  output logic [ LineBits-1:0] come_line_o,
  output logic [          1:0] come_way_o,
  // The oldest entry ends: who wanted it.
  input  logic                 free_i,
  output logic [PipeLanes-1:0] free_lanes_o [Pipes]
);
  if (Pipes < 1 || Pipes > 2) $error("voxrt_miss_list: Pipes must be 1 or 2");
  if (PipeLanes < 1) $error("voxrt_miss_list: PipeLanes must be 1 or more");
  if (LineBits < 1) $error("voxrt_miss_list: LineBits must be 1 bit or more");
  if (Entries < 2 || 2 ** $clog2(Entries) != Entries)
    $error("voxrt_miss_list: Entries must be a power of two, 2 or more");

  localparam int unsigned IndexBits = $clog2(Entries);
  typedef logic [IndexBits-1:0] index_t;

  logic [Entries-1:0] valid_q;
  logic [LineBits-1:0] line_q[Entries];  // These are compared with all lookups.
  logic [LineBits-1:0] fetched_q[Entries];  // The same, for what reads one entry.
  logic [LineBits+1:0] coming_q[Entries];  // The same with the way.
  index_t tail_q, fetch_q, come_q, free_q, walk_q;
  logic walks_q;

  logic [Entries-1:0] same_q[Pipes];
  index_t entry[Pipes];  // The entry that is joined or entered.
  logic [Pipes-1:0] joins, enters;
  logic full, second_first_q, enters_second, both_same_q;

  assign full = valid_q[tail_q] || walks_q;

  always_comb begin
    for (int unsigned p = 0; p < Pipes; p++) begin
      entry[p] = '0;
      for (int unsigned e = 0; e < Entries; e++) begin
        if (same_q[p][e]) entry[p] |= index_t'(e);
      end
      if (same_q[p] == '0) entry[p] = tail_q;
      joins[p]  = miss_i[p] && same_q[p] != '0;
      enters[p] = miss_i[p] && same_q[p] == '0 && !full;
    end
    // If both pipes miss, one enters, and the other joins it if it wants the same line.
    enters_second = Pipes == 2 && enters[Pipes-1] && (second_first_q || !enters[0]);
    accepted_o    = joins | enters;
    if (enters == '1 && Pipes == 2 && !both_same_q) begin
      accepted_o[0]       = joins[0] || !enters_second;
      accepted_o[Pipes-1] = joins[Pipes-1] || enters_second;
    end
  end

  logic [LineBits-1:0] new_line;

  assign new_line = line_i[enters_second?Pipes-1 : 0];

  // Whether the line that enters is the next one. Which enters is known late: both are compared before.
  logic [Pipes-1:0] same_as_first, same_as_last, same_as_new;

  always_comb begin
    for (int unsigned p = 0; p < Pipes; p++) begin
      same_as_first[p] = line_i[0] == next_line_i[p];
      same_as_last[p]  = line_i[Pipes-1] == next_line_i[p];
    end
    same_as_new = enters_second ? same_as_last : same_as_first;
  end

  // An entry that ends now counts, too: what misses in the next clock does not want its line, which is in the tags.
  always_ff @(posedge clk_i) begin
    both_same_q <= next_line_i[0] == next_line_i[Pipes-1];
    for (int unsigned p = 0; p < Pipes; p++) begin
      for (int unsigned e = 0; e < Entries; e++) begin
        same_q[p][e] <= (valid_q[e] && line_q[e] == next_line_i[p]) ||
            (enters != '0 && tail_q == index_t'(e) && same_as_new[p]);
      end
    end
    if (!rst_ni) for (int unsigned p = 0; p < Pipes; p++) same_q[p] <= '0;
  end

  always_ff @(posedge clk_i) begin
    if (enters != '0) begin
      valid_q[tail_q]   <= 1'b1;
      line_q[tail_q]    <= new_line;
      fetched_q[tail_q] <= new_line;
      coming_q[tail_q]  <= {way_i[enters_second?Pipes-1 : 0], new_line};
      tail_q            <= tail_q + 1'b1;
      second_first_q    <= !enters_second;
    end
    if (fetch_valid_o && fetch_ready_i) fetch_q <= fetch_q + 1'b1;
    if (come_i) come_q <= come_q + 1'b1;
    if (free_i) begin
      valid_q[free_q] <= 1'b0;
      free_q          <= free_q + 1'b1;
    end
    if (!rst_ni) begin
      valid_q        <= '0;
      tail_q         <= '0;
      fetch_q        <= '0;
      come_q         <= '0;
      free_q         <= '0;
      second_first_q <= 1'b0;
    end
  end

  // Who waits.
  always_ff @(posedge clk_i) begin
    walk_q <= walk_q + 1'b1;
    if (walk_q == '1) walks_q <= 1'b0;
    if (!rst_ni) begin
      walk_q  <= '0;
      walks_q <= 1'b1;
    end
  end

  for (genvar p = 0; p < Pipes; p++) begin : gen_lanes
    logic [PipeLanes-1:0] joined_q[Entries], answered_q[Entries];

    always_ff @(posedge clk_i) begin
      if (walks_q || (miss_i[p] && accepted_o[p])) begin
        joined_q[walks_q?walk_q : entry[p]] <= walks_q ? '0 : joined_q[entry[p]] ^ lanes_i[p];
      end
      if (walks_q || free_i) answered_q[walks_q?walk_q : free_q] <= walks_q ? '0 : joined_q[free_q];
    end

    assign free_lanes_o[p] = joined_q[free_q] ^ answered_q[free_q];
  end

  // An entry whose number comes round again is not fetched before it is entered anew.
  logic [IndexBits:0] unfetched_q;

  always_ff @(posedge clk_i) begin
    unfetched_q <= unfetched_q + (IndexBits + 1)'(enters != '0) - (IndexBits + 1)'(fetch_valid_o && fetch_ready_i);
    if (!rst_ni) unfetched_q <= '0;
  end

  assign empty_o                   = valid_q == '0 && !walks_q;
  assign fetch_valid_o             = unfetched_q != '0;
  assign fetch_line_o              = fetched_q[fetch_q];
  assign {come_way_o, come_line_o} = coming_q[come_q];

  for (genvar p = 0; p < Pipes; p++) begin : gen_check
    `VOXRT_ASSERT(LineHasOneEntry, $onehot0(same_q[p]) || !miss_i[p])
  end
  `VOXRT_ASSERT(LineIsWaitedFor, !come_i || valid_q[come_q])
  `VOXRT_ASSERT(EntryEnds, !free_i || valid_q[free_q])
endmodule
