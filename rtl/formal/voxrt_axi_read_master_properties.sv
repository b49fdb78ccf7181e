// Every request is answered once, in order, with the data of its address or as failed; after 2**TimeoutBits clocks at the
// latest. An address that is offered stays until it is taken, through failures and clears; so does the order of bursts.
// The slave keeps AXI's order of answers; it may answer with errors, and may stop to answer.
module voxrt_axi_read_master_properties
  import voxrt_pkg::*;
#(
  parameter int unsigned UnderWay    = 2,
  parameter int unsigned TimeoutBits = 3
) (
  input logic        clk_i,
  input logic        rst_ni,
  input logic        clear_i,
  input logic        recover_i,
  input logic        fail_i,
  input logic        request_valid_i,
  input logic [31:0] request_address_i,
  input logic        answer_ready_i,
  input logic        arready_i,
  input logic        rvalid_i,
  input logic [ 1:0] rresp_i
);
  logic request_ready_o, answer_valid_o, answer_failed_o, bus_error_o, bus_timeout_o;
  logic [255:0] answer_line_o;
  axi_read_request_t axi_o;
  axi_read_response_t axi_i;

  voxrt_axi_read_master #(
    .UnderWay   (UnderWay),
    .TimeoutBits(TimeoutBits)
  ) dut (
    .clk_i,
    .rst_ni,
    .clear_i,
    .recover_i,
    .fail_i,
    .request_valid_i,
    .request_ready_o,
    .request_address_i,
    .answer_valid_o,
    .answer_ready_i,
    .answer_failed_o,
    .answer_line_o,
    .bus_error_o,
    .bus_timeout_o,
    .axi_o,
    .axi_i
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb
    if (started_q)
      assume (rst_ni);
      else assume (!rst_ni);

  // The slave: addresses that it took, of which it gives the oldest; a beat's data are its number and its address.
  logic [31:0] held_q[2*UnderWay];
  logic [2:0] count_q;
  logic [1:0] beat_q;
  logic takes, gives, error_q;  // An error in the last burst.

  assign takes = axi_o.arvalid && arready_i;
  assign gives = rvalid_i && axi_o.rready;

  always_comb begin
    axi_i.arready = arready_i;
    axi_i.rvalid  = rvalid_i;
    axi_i.rdata   = {{16{beat_q}}, held_q[0]};
    axi_i.rresp   = rresp_i;
    if (count_q == '0) assume (!rvalid_i);
    assume (!rresp_i[0] || rresp_i[1]);
    // Few addresses, in which every bit is 0 and 1.
    assume (request_address_i == {8{request_address_i[3:0]}});
  end

  always_ff @(posedge clk_i) begin
    if (gives) beat_q <= beat_q + 1'b1;
    if (gives) error_q <= rresp_i[1] || (error_q && beat_q != '0);
    if (gives && beat_q == 2'd3) for (int unsigned i = 1; i < 2 * UnderWay; i++) held_q[i-1] <= held_q[i];
    if (takes) held_q[count_q-3'(gives&&beat_q==2'd3)] <= axi_o.araddr;
    count_q <= count_q + 3'(takes) - 3'(gives && beat_q == 2'd3);
    if (!rst_ni) begin
      count_q <= '0;
      beat_q  <= '0;
    end
  end

  // Requests to be answered.
  logic [31:0] owed_q[2];
  logic [1:0] owed_count_q;
  logic asks, answers;

  assign asks    = request_valid_i && request_ready_o && !clear_i;
  assign answers = answer_valid_o && answer_ready_i;

  always_ff @(posedge clk_i) begin
    if (answers) owed_q[0] <= owed_q[1];
    if (asks) owed_q[1'(owed_count_q-2'(answers))] <= request_address_i;
    owed_count_q <= clear_i ? '0 : owed_count_q + 2'(asks) - 2'(answers);
    if (!rst_ni) owed_count_q <= '0;
  end

  always_comb begin
    // As voxrt_cached_memory uses it.
    if (recover_i) assume (owed_count_q == '0 && !request_valid_i && !fail_i);
    if (started_q) begin
      assert (owed_count_q <= 2'(UnderWay));
      assert (count_q <= 3'(UnderWay));
      if (answer_valid_o) assert (owed_count_q != '0);
      if (answer_valid_o && !answer_failed_o) begin
        assert (!error_q);
        for (int unsigned b = 0; b < 4; b++) assert (answer_line_o[64*b+:64] == {{16{2'(b)}}, owed_q[0]});
      end
    end
  end

  // It fails for a reason: the input, an error on the bus, silence of at least half of the time.
  logic reason_q;
  logic [TimeoutBits:0] silence_q;

  always_ff @(posedge clk_i) begin
    if (recover_i) reason_q <= 1'b0;
    if (fail_i || bus_error_o || bus_timeout_o) reason_q <= 1'b1;
    silence_q <= silence_q + 1'b1;
    if (rvalid_i || asks || (owed_count_q == '0 && !request_valid_i)) silence_q <= '0;
    if (!rst_ni || clear_i) begin
      reason_q  <= 1'b0;
      silence_q <= '0;
    end
  end

  always_comb begin
    if (started_q) begin
      assert (answer_failed_o == reason_q);
      if (bus_error_o) assert (rvalid_i && rresp_i[1]);
      if (bus_timeout_o) assert (silence_q >= (TimeoutBits + 1)'(2 ** TimeoutBits / 2));
    end
  end

  // AXI: what is offered stays.
  logic offered_q;
  logic [31:0] address_q;

  always_ff @(posedge clk_i) begin
    offered_q <= rst_ni && axi_o.arvalid && !arready_i;
    address_q <= axi_o.araddr;
  end

  always_comb if (started_q && offered_q) assert (axi_o.arvalid && axi_o.araddr == address_q);

  // An answer, or a beat, or a failure, in time.
  logic [TimeoutBits+1:0] waited_q;

  always_ff @(posedge clk_i) begin
    waited_q <= waited_q + 1'b1;
    if (!rst_ni || clear_i || recover_i || owed_count_q == '0 || answer_valid_o || rvalid_i || asks) waited_q <= '0;
  end

  always_comb if (started_q) assert (waited_q <= (TimeoutBits + 2)'(2 ** TimeoutBits + 1));

  // Failures and clears after which the slave owes nothing: the first request after them gets its line. So does the
  // second one in a row.
  logic after_failure_q, after_clear_q;
  logic [1:0] asked_q, lines_q;

  always_ff @(posedge clk_i) begin
    if (asks && asked_q != '1) asked_q <= asked_q + 1'b1;
    if (answers && !answer_failed_o && lines_q != '1) lines_q <= lines_q + 1'b1;
    if (!rst_ni || clear_i || fail_i || bus_error_o || bus_timeout_o) begin
      after_failure_q <= rst_ni && !clear_i && fail_i && !request_valid_i && !axi_o.arvalid && count_q == '0;
      after_clear_q   <= rst_ni && clear_i && !request_valid_i && !axi_o.arvalid && count_q == 3'd1 && gives && beat_q == 2'd3;
      asked_q <= '0;
      lines_q <= '0;
    end
  end

  always_ff @(posedge clk_i) begin
    cover (started_q && answers && answer_failed_o && count_q != '0);
    cover (started_q && answers && !answer_failed_o);
    cover (started_q && answers && !answer_failed_o && gives);
    cover (started_q && answers && !answer_failed_o && lines_q == 2'd1);
    cover (started_q && answers && !answer_failed_o && after_failure_q && asked_q == 2'd1);
    cover (started_q && answers && !answer_failed_o && after_clear_q && asked_q == 2'd1);
    cover (started_q && bus_timeout_o);
  end
endmodule
