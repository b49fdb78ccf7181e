// The cache that lanes share, between their own caches (voxrt_l1_cache) and the external memory (voxrt_line_reader). It
// has two pipes; pipe p serves the lanes i with i mod 2 = p, in turn, one per clock.
//
//   0 choose a lane, or a line that has come | 1, 2 tags | 3 hit or miss | 4 data | 5 to the lanes
//
// Every request is answered once. One that misses gets an entry in the list of misses, or joins the entry of its line:
// voxrt_miss_list. Where neither is possible, it is refused, and tried again. Lines come in the order of the list. Such a
// line takes stage 0 of both pipes: it is written into tags and data and goes to the lanes that wait. So what a lookup
// sees of tags, list and data is always of one order, that of stage 0.
//
// A line replaces one of its set: an empty way, or one that was not used lately, by a tree of three bits. Of two lookups at
// a clock, one counts as use. The bits are read a clock before a lookup is known to miss, and written a clock after it:
// paths are short, and lookups of a set that follow each other so closely are seldom.
`include "voxrt_assert.svh"

module voxrt_l2_cache
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes     = 16,
  parameter int unsigned BlockBits = 12,
  parameter int unsigned SetBits   = 9,     // 2**SetBits sets of four lines: 1 or more, less than BlockBits.
  parameter bit          Lod       = 1'b0,
  parameter int unsigned Misses    = 32     // Lines: a power of two, 2 or more.
) (
  input logic clk_i,
  input logic rst_ni,
  input logic flush_i,  // Drop all lines; only when idle_o.
  output logic idle_o,
  // Lanes.
  input logic [Lanes-1:0] request_valid_i,
  output logic [Lanes-1:0] request_ready_o,  // The request is accepted, for one clock.
  input logic [BlockBits:0] request_line_i[Lanes],
  output logic [Lanes-1:0] answer_valid_o,
  output logic [BlockBits:0] answer_line_o[2],  // By pipe.
  output logic [7:0][payload_bits(BlockBits, Lod):0] answer_words_o[2],
  // External memory.
  output logic fetch_valid_o,
  input logic fetch_ready_i,
  output logic [BlockBits:0] fetch_line_o,
  input logic fill_valid_i,
  output logic fill_ready_o,
  input logic [7:0][payload_bits(BlockBits, Lod):0] fill_words_i
);
  if (SetBits < 1 || SetBits >= BlockBits)
    $error("voxrt_l2_cache: SetBits must be 1 bit or more, and less than BlockBits");
  if (Misses < 2 || 2 ** $clog2(Misses) != Misses) $error("voxrt_l2_cache: Misses must be a power of two, 2 or more");

  localparam int unsigned Ways = 4;
  localparam int unsigned Pipes = Lanes > 1 ? 2 : 1;
  localparam int unsigned PipeLanes = (Lanes + 1) / 2;
  localparam int unsigned LineBits = BlockBits + 1;
  localparam int unsigned StoredBits = LineBits - SetBits;  // Bits of a line's number that the tags hold.
  localparam int unsigned LineWidth = 8 * (payload_bits(BlockBits, Lod) + 1);
  typedef logic [LineBits-1:0] line_t;

  // 0 choose. A lane that is looked up waits for the outcome.
  logic walks_q, fills;
  logic [SetBits-1:0] walk_q;
  logic [Lanes-1:0] looked_up_q, granted, decided;
  logic [PipeLanes-1:0] wants[Pipes], grant[Pipes], late_q[Pipes];
  line_t fill_line;
  logic list_empty;
  logic [1:0] fill_way;

  assign fills        = fill_valid_i && !walks_q;
  assign fill_ready_o = !walks_q;

  // The first that wants from the one after the last that got, or else the first of all.
  function automatic logic [PipeLanes-1:0] first_of(logic [PipeLanes-1:0] set);
    return set & (~set + 1'b1);
  endfunction

  always_comb begin
    granted = '0;
    for (int unsigned p = 0; p < Pipes; p++) begin
      wants[p] = '0;
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (Pipes * k + p < Lanes) begin
          wants[p][k] = request_valid_i[Pipes*k+p] && !looked_up_q[Pipes*k+p] && !fill_valid_i && !walks_q;
        end
      end
      grant[p] = (wants[p] & late_q[p]) != '0 ? first_of(wants[p] & late_q[p]) : first_of(wants[p]);
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (Pipes * k + p < Lanes) granted[Pipes*k+p] = grant[p][k];
      end
    end
  end

  always_ff @(posedge clk_i) begin
    looked_up_q <= (looked_up_q | granted) & ~decided;
    for (int unsigned p = 0; p < Pipes; p++) begin
      if (grant[p] != '0) late_q[p] <= ~(grant[p] | (grant[p] - 1'b1));
    end
    if (!rst_ni) looked_up_q <= '0;
  end

  // What goes through the stages.
  line_t line_q[Pipes][1:5];
  logic [PipeLanes-1:0] lanes_q[Pipes][1:5];  // One-hot or 0; in stages 4 and 5 those that get the line.
  logic [5:1] fill_q;
  logic [2:1] walk1_q;
  line_t fill_line_q[1:5];
  logic [1:0] fill_way_q[1:3];
  logic [LineWidth-1:0] fill_words_q[1:5];
  logic [PipeLanes-1:0] hit_lanes[Pipes], fill_lanes[Pipes];

  always_ff @(posedge clk_i) begin
    fill_q          <= {fill_q[4:1], fills};
    walk1_q         <= {walk1_q[1], walks_q};
    fill_line_q[1]  <= walks_q ? line_t'(walk_q) : fill_line;
    fill_way_q[1]   <= fill_way;
    fill_words_q[1] <= fill_words_i;
    for (int unsigned s = 2; s <= 5; s++) begin
      fill_line_q[s]  <= fill_line_q[s-1];
      fill_words_q[s] <= fill_words_q[s-1];
    end
    for (int unsigned s = 2; s <= 3; s++) fill_way_q[s] <= fill_way_q[s-1];
    for (int unsigned p = 0; p < Pipes; p++) begin
      line_q[p][1] <= '0;
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (grant[p][k]) line_q[p][1] <= request_line_i[Pipes*k+p];
      end
      for (int unsigned s = 2; s <= 5; s++) line_q[p][s] <= line_q[p][s-1];
      lanes_q[p][1] <= grant[p];
      lanes_q[p][2] <= lanes_q[p][1];
      lanes_q[p][3] <= lanes_q[p][2];
      lanes_q[p][4] <= fill_q[3] ? fill_lanes[p] : hit_lanes[p];
      lanes_q[p][5] <= lanes_q[p][4];
    end
    walk_q <= walks_q ? walk_q + 1'b1 : '0;
    if (flush_i) walks_q <= 1'b1;
    if (walk_q == '1) walks_q <= 1'b0;
    if (!rst_ni) begin
      fill_q  <= '0;
      walk1_q <= '0;
      walks_q <= 1'b0;
      for (int unsigned p = 0; p < Pipes; p++) lanes_q[p] <= '{default: '0};
    end
  end

  // 1 to 3 tags: a bit that says that the way is not empty, and the line.
  logic [StoredBits:0] tag[Pipes][Ways];

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic [StoredBits:0] a_tag, b_tag;

    voxrt_block_ram #(
      .Width(StoredBits + 1),
      .Depth(2 ** SetBits)
    ) u_tags (
      .clk_i,
      .a_read_i (1'b1),
      .a_write_i((fill_q[1] && fill_way_q[1] == 2'(w)) || walk1_q[1]),
      .a_row_i  (fill_q[1] || walk1_q[1] ? fill_line_q[1][SetBits-1:0] : line_q[0][1][SetBits-1:0]),
      .a_data_i ({fill_q[1], fill_line_q[1][LineBits-1:SetBits]}),
      .a_data_o (a_tag),
      .b_read_i (1'b1),
      .b_row_i  (line_q[Pipes-1][1][SetBits-1:0]),
      .b_data_o (b_tag)
    );

    assign tag[0][w] = a_tag;
    if (Pipes == 2) begin : gen_second
      assign tag[1][w] = b_tag;
    end else begin : gen_one
      logic unused_tag;
      assign unused_tag = ^b_tag;
    end
  end

  // 3 hit or miss.
  logic [Ways-1:0] same[Pipes], empty[Pipes];
  logic [1:0] hit_way[Pipes], new_way[Pipes];
  logic [Pipes-1:0] hit, misses, missed;
  line_t line3[Pipes];

  // Use: bit 0 is the half used last, bits 1 and 2 the way used last of each half. All orders are legal: no reset.
  logic [2:0] used_q[2**SetBits];
  logic [1:0] older_q[Pipes];
  line_t line2[Pipes];

  always_comb for (int unsigned p = 0; p < Pipes; p++) line2[p] = line_q[p][2];

  always_ff @(posedge clk_i) begin
    for (int unsigned p = 0; p < Pipes; p++) older_q[p] <= older_way(used_q[line2[p][SetBits-1:0]]);
  end

  always_comb begin
    decided = '0;
    for (int unsigned p = 0; p < Pipes; p++) begin
      line3[p]   = line_q[p][3];
      hit_way[p] = '0;
      new_way[p] = older_q[p];
      for (int unsigned w = 0; w < Ways; w++) begin
        same[p][w]  = tag[p][w] == {1'b1, line_q[p][3][LineBits-1:SetBits]};
        empty[p][w] = !tag[p][w][StoredBits];
        if (same[p][w]) hit_way[p] |= 2'(w);
      end
      for (int unsigned w = Ways; w > 0; w--) if (empty[p][w-1]) new_way[p] = 2'(w - 1);
      hit[p]       = lanes_q[p][3] != '0 && same[p] != '0;
      misses[p]    = lanes_q[p][3] != '0 && same[p] == '0;
      hit_lanes[p] = hit[p] ? lanes_q[p][3] : '0;
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (Pipes * k + p < Lanes) decided[Pipes*k+p] = lanes_q[p][3][k];
      end
    end
  end

  always_comb begin
    request_ready_o = '0;
    for (int unsigned p = 0; p < Pipes; p++) begin
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (Pipes * k + p < Lanes) request_ready_o[Pipes*k+p] = lanes_q[p][3][k] && (hit[p] || missed[p]);
      end
    end
  end

  logic second_first_q, counts_second, uses_q;
  logic [SetBits-1:0] used_set_q;
  logic [1:0] used_way_q;

  function automatic logic [1:0] older_way(logic [2:0] used);
    return {!used[0], used[0] ? !used[1] : !used[2]};
  endfunction

  assign counts_second = Pipes == 2 && lanes_q[Pipes-1][3] != '0 && (second_first_q || lanes_q[0][3] == '0);

  always_ff @(posedge clk_i) begin
    second_first_q <= !second_first_q;
    uses_q <= counts_second ? hit[Pipes-1] || missed[Pipes-1] : hit[0] || missed[0];
    used_set_q <= line3[counts_second?Pipes-1 : 0][SetBits-1:0];
    used_way_q     <= counts_second ? (hit[Pipes-1] ? hit_way[Pipes-1] : new_way[Pipes-1]) :
        hit[0] ? hit_way[0] : new_way[0];
    if (uses_q) begin
      used_q[used_set_q][0] <= used_way_q[1];
      if (used_way_q[1]) used_q[used_set_q][2] <= used_way_q[0];
      else used_q[used_set_q][1] <= used_way_q[0];
    end
    if (!rst_ni) second_first_q <= 1'b0;
  end

  logic [PipeLanes-1:0] lanes3[Pipes];
  always_comb for (int unsigned p = 0; p < Pipes; p++) lanes3[p] = lanes_q[p][3];

  voxrt_miss_list #(
    .Pipes    (Pipes),
    .PipeLanes(PipeLanes),
    .LineBits (LineBits),
    .Entries  (Misses)
  ) u_misses (
    .clk_i,
    .rst_ni,
    .empty_o     (list_empty),
    .miss_i      (misses),
    .next_line_i (line2),
    .line_i      (line3),
    .lanes_i     (lanes3),
    .way_i       (new_way),
    .accepted_o  (missed),
    .fetch_valid_o,
    .fetch_ready_i,
    .fetch_line_o,
    .come_i      (fills),
    .come_line_o (fill_line),
    .come_way_o  (fill_way),
    .free_i      (fill_q[3]),
    .free_lanes_o(fill_lanes)
  );

  // 3 to 5 data.
  logic [LineWidth-1:0] words[2];

  voxrt_block_ram #(
    .Width(LineWidth),
    .Depth(Ways * 2 ** SetBits)
  ) u_data (
    .clk_i,
    .a_read_i (1'b1),
    .a_write_i(fill_q[3]),
    .a_row_i  (fill_q[3] ? {fill_line_q[3][SetBits-1:0], fill_way_q[3]} : {line_q[0][3][SetBits-1:0], hit_way[0]}),
    .a_data_i (fill_words_q[3]),
    .a_data_o (words[0]),
    .b_read_i (1'b1),
    .b_row_i  ({line_q[Pipes-1][3][SetBits-1:0], hit_way[Pipes-1]}),
    .b_data_o (words[1])
  );

  // 5 to the lanes.
  always_comb begin
    answer_valid_o = '0;
    for (int unsigned p = 0; p < 2; p++) begin
      answer_line_o[p]  = fill_q[5] ? fill_line_q[5] : line_q[p%Pipes][5];
      answer_words_o[p] = fill_q[5] ? fill_words_q[5] : words[p];
    end
    for (int unsigned p = 0; p < Pipes; p++) begin
      for (int unsigned k = 0; k < PipeLanes; k++) begin
        if (Pipes * k + p < Lanes) answer_valid_o[Pipes*k+p] = lanes_q[p][5][k];
      end
    end
  end

  always_comb begin
    idle_o = list_empty && !walks_q && walk1_q == '0 && fill_q == '0 && request_valid_i == '0;
    for (int unsigned p = 0; p < Pipes; p++) begin
      for (int unsigned s = 1; s <= 5; s++) if (lanes_q[p][s] != '0) idle_o = 1'b0;
    end
  end

  for (genvar p = 0; p < Pipes; p++) begin : gen_check
    `VOXRT_ASSERT(LineInOneWay, $onehot0(same[p]) || !hit[p])
    `VOXRT_ASSERT(NoLookupBesideFill, !fill_q[3] || lanes_q[p][3] == '0)
  end
  `VOXRT_ASSERT(FlushedWhenIdle, !flush_i || idle_o)
endmodule
