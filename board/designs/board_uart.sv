// A serial line: 8 data bits, no parity, one stop bit. Any ratio of clock and baud from 8 upwards.
module board_uart #(
  parameter int unsigned ClockHz = 75_000_000,  // Hz: 8 times Baud or more.
  parameter int unsigned Baud    = 3_000_000    // 1/s: 300 or more.
) (
  input  logic       clk_i,
  input  logic       rst_ni,
  // Received bytes; broken_o: the stop bit was missing.
  input  logic       rx_i,
  output logic       valid_o,
  output logic       broken_o,
  output logic [7:0] byte_o,
  // Bytes to send.
  input  logic       valid_i,
  output logic       ready_o,
  input  logic [7:0] byte_i,
  output logic       tx_o
);
  if (Baud > ClockHz / 8) $error("board_uart: ClockHz and Baud must be in a ratio of 8 or more");
  if (Baud < 300) $error("board_uart: Baud must be 300 or more");

  // The part of a bit per clock, in 1/2**PhaseBits: the baud is met within 1 in 2**16.
  localparam int unsigned PhaseBits = 20;
  localparam int unsigned Step = int'((64'(Baud) * (64'd1 << PhaseBits) + 64'(ClockHz) / 2) / 64'(ClockHz));

  // Receive: sample in the middle of each bit.
  logic rx;
  logic [PhaseBits-1:0] rx_phase_q;
  logic rx_sample;
  logic [3:0] rx_left_q;  // Bits to come, with start and stop.
  logic [7:0] rx_bits_q;

  board_synchronizer u_rx (
    .clk_i,
    .bit_i(rx_i),
    .bit_o(rx)
  );

  logic [PhaseBits-1:0] rx_phase;
  assign {rx_sample, rx_phase} = rx_phase_q + (PhaseBits + 1)'(Step);

  always_ff @(posedge clk_i) begin
    valid_o    <= 1'b0;
    rx_phase_q <= rx_phase;
    if (rx_left_q == '0) begin
      rx_phase_q <= {1'b1, (PhaseBits - 1)'(0)};
      if (!rx) rx_left_q <= 4'd10;
    end else if (rx_sample) begin
      rx_left_q <= rx_left_q - 4'd1;
      rx_bits_q <= {rx, rx_bits_q[7:1]};
      // A start bit that is over in its middle was a disturbance.
      if (rx_left_q == 4'd10 && rx) rx_left_q <= '0;
      if (rx_left_q == 4'd1) begin
        valid_o  <= 1'b1;
        broken_o <= !rx;
        byte_o   <= rx_bits_q;
      end
    end
    if (!rst_ni) begin
      rx_left_q <= '0;
      valid_o   <= 1'b0;
    end
  end

  // Send.
  logic [PhaseBits-1:0] tx_phase_q, tx_phase;
  logic tx_next;
  logic [3:0] tx_left_q;
  logic [9:0] tx_bits_q;

  assign {tx_next, tx_phase} = tx_phase_q + (PhaseBits + 1)'(Step);
  assign ready_o             = tx_left_q == '0;

  always_ff @(posedge clk_i) begin
    tx_phase_q <= tx_phase;
    if (ready_o) begin
      tx_phase_q <= '0;
      if (valid_i) begin
        tx_bits_q <= {1'b1, byte_i, 1'b0};
        tx_left_q <= 4'd10;
      end
    end else if (tx_next) begin
      tx_bits_q <= {1'b1, tx_bits_q[9:1]};
      tx_left_q <= tx_left_q - 4'd1;
    end
    if (!rst_ni) begin
      tx_bits_q <= '1;
      tx_left_q <= '0;
    end
  end

  assign tx_o = tx_bits_q[0];
endmodule
