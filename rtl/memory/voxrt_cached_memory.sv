// The octree memory in an external memory, behind caches: one per lane (voxrt_l1_cache), one for all (voxrt_l2_cache),
// and a reader on two AXI ports (voxrt_line_reader). Two lanes of a pipe of the L2 share the queue of lines that come
// from it (voxrt_line_queue).
//
// A frame begins with start_i; its root may be read from ready_o on. Between them, the caches are emptied if they must
// be: after a reset, after an error of the bus, and when flush_i has asked for it. flush_i may come at any clock; it never
// touches the frame that is traced.
//
// An error of the bus ends the frame: from then on, every line that is not in a cache is made of error words, without
// reading, so that all rays end. voxrt_axi_read_master says what an error is.
module voxrt_cached_memory
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes       = 1,
  parameter int unsigned BlockBits   = 12,
  parameter int unsigned L1SetBits   = 5,     // Sets of four lines.
  parameter int unsigned L2SetBits   = 9,
  parameter bit          Lod         = 1'b0,
  parameter int unsigned TimeoutBits = 16     // The bus must answer within 2**TimeoutBits clocks: 1 .. 32.
) (
  input logic clk_i,
  input logic rst_ni,
  input logic bus_rst_ni,  // A reset of the core does not reset the bus.
  // Frames.
  input logic start_i,
  output logic ready_o,
  input logic flush_i,
  input logic [31:0] base_i,  // See voxrt_line_reader.
  input logic lod_words_i,
  // Lanes.
  input logic [Lanes-1:0] read_i,
  input logic [BlockBits+3:0] address_i[Lanes],
  output logic [Lanes-1:0] ack_o,
  output logic [payload_bits(BlockBits, Lod):0] word_o[Lanes],
  // External memory.
  output axi_read_request_t axi_o[BusPorts],
  input axi_read_response_t axi_i[BusPorts],
  output memory_events_t events_o
);
  if (TimeoutBits < 1 || TimeoutBits > 32) $error("voxrt_cached_memory: TimeoutBits must be 1 to 32 bits");

  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);

  // Frames.
  logic waits_q, flushing_q, flush_needed_q, clears;
  logic [Lanes-1:0] l1_idle;
  logic l2_idle, idle_q;
  logic bus_error, bus_timeout;

  // No lane reads between start_i and ready_o: caches that are idle stay so, until they are emptied.
  assign clears  = waits_q && idle_q && flush_needed_q && !flushing_q;
  assign ready_o = waits_q && idle_q && !flush_needed_q && !flushing_q;

  always_ff @(posedge clk_i) begin
    idle_q <= l1_idle == '1 && l2_idle;
    if (start_i) waits_q <= 1'b1;
    if (ready_o) waits_q <= 1'b0;
    flushing_q <= clears;
    if (clears) flush_needed_q <= 1'b0;
    if (flush_i || bus_error || bus_timeout) flush_needed_q <= 1'b1;
    if (!rst_ni) begin
      idle_q         <= 1'b0;
      waits_q        <= 1'b0;
      flushing_q     <= 1'b0;
      flush_needed_q <= 1'b1;
    end
  end

  // Caches.
  logic [Lanes-1:0] request_valid, request_ready, answer_valid;
  logic [BlockBits:0] request_line[Lanes], answer_line[2], fetch_line;
  logic [7:0][PayloadBits:0] answer_words[2], fill_words;
  logic fetch_valid, fetch_ready, fill_valid, fill_ready;

  // Lane 4 g + p and, if there is one, lane 4 g + p + 2 are of queue 2 g + p; pipe p answers them.
  localparam int unsigned Queues = Lanes < 3 ? Lanes : 2 * (Lanes / 4) + (Lanes % 4 < 2 ? Lanes % 4 : 2);

  logic [1:0] fill_lanes[Queues];
  logic [L1SetBits-1:0] fill_set[Queues];
  logic [1:0] fill_quarter[Queues];
  logic [1:0][PayloadBits:0] fill_pair[Queues];

  for (genvar q = 0; q < Queues; q++) begin : gen_queue
    localparam int unsigned First = 4 * (q / 2) + q % 2;

    voxrt_line_queue #(
      .Lanes   (2),
      .SetBits (L1SetBits),
      .WordBits(PayloadBits + 1),
      .Depth   (2 * l1_outstanding(L1SetBits))
    ) u_lines (
      .clk_i,
      .rst_ni,
      .valid_i  ({First + 2 < Lanes && answer_valid[First+2<Lanes?First+2 : First], answer_valid[First]}),
      .set_i    (answer_line[q%2][L1SetBits-1:0]),
      .words_i  (answer_words[q%2]),
      .valid_o  (fill_lanes[q]),
      .set_o    (fill_set[q]),
      .quarter_o(fill_quarter[q]),
      .pair_o   (fill_pair[q])
    );
  end

  for (genvar i = 0; i < Lanes; i++) begin : gen_lane
    localparam int unsigned Queue = 2 * (i / 4) + i % 2;

    voxrt_l1_cache #(
      .BlockBits(BlockBits),
      .SetBits  (L1SetBits),
      .Lod      (Lod)
    ) u_l1 (
      .clk_i,
      .rst_ni,
      .clear_i         (clears),
      .idle_o          (l1_idle[i]),
      .read_i          (read_i[i]),
      .address_i       (address_i[i]),
      .ack_o           (ack_o[i]),
      .word_o          (word_o[i]),
      .request_valid_o (request_valid[i]),
      .request_ready_i (request_ready[i]),
      .request_line_o  (request_line[i]),
      .answer_valid_i  (fill_lanes[Queue][i/2%2]),
      .answer_set_i    (fill_set[Queue]),
      .answer_quarter_i(fill_quarter[Queue]),
      .answer_pair_i   (fill_pair[Queue])
    );
  end

  voxrt_l2_cache #(
    .Lanes    (Lanes),
    .BlockBits(BlockBits),
    .SetBits  (L2SetBits),
    .Lod      (Lod)
  ) u_l2 (
    .clk_i,
    .rst_ni,
    .flush_i        (clears),
    .idle_o         (l2_idle),
    .request_valid_i(request_valid),
    .request_ready_o(request_ready),
    .request_line_i (request_line),
    .answer_valid_o (answer_valid),
    .answer_line_o  (answer_line),
    .answer_words_o (answer_words),
    .fetch_valid_o  (fetch_valid),
    .fetch_ready_i  (fetch_ready),
    .fetch_line_o   (fetch_line),
    .fill_valid_i   (fill_valid),
    .fill_ready_o   (fill_ready),
    .fill_words_i   (fill_words)
  );

  // The list of misses and the ports of the bus are far apart: neither waits for the other within a clock.
  logic next_valid, next_ready;
  logic [BlockBits:0] next_line;

  voxrt_fifo #(
    .Width(BlockBits + 1),
    .Depth(2)
  ) u_fetches (
    .clk_i,
    .rst_ni,
    .valid_i(fetch_valid),
    .ready_o(fetch_ready),
    .data_i (fetch_line),
    .valid_o(next_valid),
    .ready_i(next_ready),
    .data_o (next_line)
  );

  voxrt_line_reader #(
    .BlockBits  (BlockBits),
    .Lod        (Lod),
    .TimeoutBits(TimeoutBits)
  ) u_reader (
    .clk_i,
    .rst_ni         (bus_rst_ni),
    .clear_i        (!rst_ni),
    .recover_i      (clears),
    .base_i,
    .lod_words_i,
    .request_valid_i(next_valid),
    .request_ready_o(next_ready),
    .request_line_i (next_line),
    .answer_valid_o (fill_valid),
    .answer_ready_i (fill_ready),
    .answer_words_o (fill_words),
    .bus_error_o    (bus_error),
    .bus_timeout_o  (bus_timeout),
    .axi_o,
    .axi_i
  );

  // Counts come a clock later, so that the sums are not behind the caches' decisions.
  memory_events_t counts_q;

  always_ff @(posedge clk_i) begin
    counts_q <= '{
        word_requests: 8'($countones(read_i)),
        line_requests: 8'($countones(request_ready)),
        lines_read: fetch_valid && fetch_ready,
        default: '0
    };
    if (!rst_ni) counts_q <= '0;
  end

  always_comb begin
    events_o             = counts_q;
    events_o.bus_error   = bus_error;
    events_o.bus_timeout = bus_timeout;
  end
endmodule
