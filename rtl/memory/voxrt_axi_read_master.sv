// Reads lines of 32 bytes by AXI4: bursts of 4 beats of 64 bits, in order, with one id, and up to UnderWay of them at a
// time. It knows nothing of octrees: any module that reads lines from a bus may use it.
//
// Each request is answered once, in order. After an error of the bus (SLVERR, DECERR), or 2**TimeoutBits clocks without
// an answer, all requests are answered as failed at once, without the bus, until recover_i. What the bus still owes is
// counted, and dropped when it comes: so the rules of AXI hold through failures and soft resets.
`include "voxrt_assert.svh"

module voxrt_axi_read_master
  import voxrt_pkg::*;
#(
  parameter int unsigned UnderWay    = 8,  // Bursts: a power of two, 2 .. 256.
  parameter int unsigned TimeoutBits = 16  // The bus must answer within 2**TimeoutBits clocks: 1 .. 32.
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,             // The bus's reset.
  input  logic                       clear_i,            // Forget all requests; the bus goes on.
  input  logic                       recover_i,          // Use the bus again. Not while a request waits.
  input  logic                       fail_i,             // Fail as after an error of the bus.
  input  logic                       request_valid_i,
  output logic                       request_ready_o,
  input  logic               [ 31:0] request_address_i,
  output logic                       answer_valid_o,
  input  logic                       answer_ready_i,
  output logic                       answer_failed_o,
  output logic               [255:0] answer_line_o,
  output logic                       bus_error_o,        // For one clock each.
  output logic                       bus_timeout_o,
  output axi_read_request_t          axi_o,
  input  axi_read_response_t         axi_i
);
  if (UnderWay < 2 || UnderWay > 256 || 2 ** $clog2(UnderWay) != UnderWay)
    $error("voxrt_axi_read_master: UnderWay must be a power of two, 2 to 256");
  if (TimeoutBits < 1 || TimeoutBits > 32) $error("voxrt_axi_read_master: TimeoutBits must be 1 to 32 bits");

  localparam int unsigned CountBits = $clog2(UnderWay) + 1;
  localparam logic [CountBits-1:0] One = CountBits'(1);

  logic failed_q, fails, arvalid_q, line_valid_q;
  logic [31:0] araddr_q;
  logic [255:0] line_q;
  logic [1:0] beat_q;
  logic [TimeoutBits-1:0] waited_q;
  // Requests to be answered; bursts on the bus; those of them, the oldest, that are to be dropped.
  logic [CountBits-1:0] owed_q, owed, bursts_q, bursts, dropped_q;
  logic accepts, sends, answers, receives, ends, keeps;

  assign request_ready_o = failed_q ? owed_q != CountBits'(UnderWay) :
      (!arvalid_q || axi_i.arready) && bursts_q != CountBits'(UnderWay) && owed_q != CountBits'(UnderWay);
  assign accepts = request_valid_i && request_ready_o;
  assign sends = accepts && !failed_q;

  assign axi_o.arvalid = arvalid_q;
  assign axi_o.araddr = araddr_q;
  assign axi_o.rready = !line_valid_q || answer_ready_i;

  assign receives = axi_i.rvalid && axi_o.rready && bursts_q != '0;
  assign ends = receives && beat_q == '1;
  assign keeps = receives && dropped_q == '0 && !failed_q;

  assign answer_valid_o = failed_q ? owed_q != '0 : line_valid_q;
  assign answer_failed_o = failed_q;
  assign answer_line_o = line_q;
  assign answers = answer_valid_o && answer_ready_i;

  assign owed = owed_q + CountBits'(accepts) - CountBits'(answers);
  assign bursts = bursts_q + CountBits'(sends) - CountBits'(ends);

  assign bus_error_o = keeps && axi_i.rresp[1];
  assign bus_timeout_o = !failed_q && waited_q == '1;
  assign fails = bus_error_o || bus_timeout_o || fail_i;

  always_ff @(posedge clk_i) begin
    if (axi_i.arready) arvalid_q <= 1'b0;
    if (sends) begin
      arvalid_q <= 1'b1;
      araddr_q  <= request_address_i;
    end
    owed_q   <= owed;
    bursts_q <= bursts;
    if (receives) begin
      beat_q <= beat_q + 1'b1;
      line_q <= {axi_i.rdata, line_q[255:64]};
    end
    if (answers) line_valid_q <= 1'b0;
    if (ends && dropped_q == '0) line_valid_q <= 1'b1;
    if (ends && dropped_q != '0) dropped_q <= dropped_q - One;
    waited_q <= waited_q + 1'b1;
    if ((owed_q == '0 && !request_valid_i) || accepts || axi_i.rvalid || failed_q) waited_q <= '0;

    if (recover_i) failed_q <= 1'b0;
    if (fails) failed_q <= 1'b1;
    if (fails || clear_i) begin
      dropped_q    <= bursts;
      line_valid_q <= 1'b0;
    end
    if (clear_i) begin
      arvalid_q <= arvalid_q && !axi_i.arready;
      bursts_q  <= bursts_q - CountBits'(ends);
      dropped_q <= bursts_q - CountBits'(ends);
      owed_q    <= '0;
      failed_q  <= 1'b0;
      waited_q  <= '0;
    end
    if (!rst_ni) begin
      arvalid_q    <= 1'b0;
      owed_q       <= '0;
      bursts_q     <= '0;
      dropped_q    <= '0;
      beat_q       <= '0;
      line_valid_q <= 1'b0;
      failed_q     <= 1'b0;
      waited_q     <= '0;
    end
  end

  `VOXRT_ASSERT(DroppedWereBursts, dropped_q <= bursts_q)
  `VOXRT_ASSERT(OwedAsManyAsBursts, failed_q || owed_q == bursts_q - dropped_q + CountBits'(line_valid_q))
endmodule
