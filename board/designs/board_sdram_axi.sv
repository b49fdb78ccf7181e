// The core's AXI4 reads (4 beats of 64 bits, in order) become lines of the SDRAM.
//
// Addresses are of bytes, and multiples of 32; bits above 32 MB are ignored. Other bursts than the core's are not served.
module board_sdram_axi
  import voxrt_pkg::*;
(
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  axi_read_request_t          axi_i,
  output axi_read_response_t         axi_o,
  output logic                       valid_o,
  input  logic                       ready_i,
  output logic               [ 19:0] line_o,
  input  logic                       done_i,
  input  logic               [255:0] data_i
);
  logic pending_q, under_way_q, beats_q;
  logic [19:0] line_q;
  logic [1:0] beat_q;
  logic [255:0] data_q;

  // A new address waits while the line before is read; it is asked for when that line's last beat has gone.
  assign axi_o.arready = !pending_q;
  assign axi_o.rvalid  = beats_q;
  assign axi_o.rdata   = data_q[63:0];
  assign axi_o.rresp   = '0;
  assign valid_o       = pending_q && !under_way_q && !beats_q;
  assign line_o        = line_q;

  always_ff @(posedge clk_i) begin
    if (axi_i.arvalid && axi_o.arready) begin
      pending_q <= 1'b1;
      line_q    <= axi_i.araddr[24:5];
    end
    if (valid_o && ready_i) begin
      pending_q   <= 1'b0;
      under_way_q <= 1'b1;
    end
    if (done_i) begin
      under_way_q <= 1'b0;
      beats_q     <= 1'b1;
      beat_q      <= '0;
      data_q      <= data_i;
    end
    if (axi_o.rvalid && axi_i.rready) begin
      data_q <= {64'd0, data_q[255:64]};
      beat_q <= beat_q + 1'b1;
      if (beat_q == '1) beats_q <= 1'b0;
    end
    if (!rst_ni) begin
      pending_q   <= 1'b0;
      under_way_q <= 1'b0;
      beats_q     <= 1'b0;
    end
  end
endmodule
