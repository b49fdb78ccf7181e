// CRC-32 as in Ethernet and zlib, bit by bit: a byte takes eight clocks.
module board_crc32 (
  input  logic        clk_i,
  input  logic        clear_i,
  input  logic        valid_i,  // Only while busy_o is low.
  input  logic [ 7:0] byte_i,
  output logic        busy_o,
  output logic [31:0] crc_o,    // The CRC of the bytes since clear_i.
  output logic        right_o   // The last four bytes were the CRC of those before.
);
  logic [31:0] crc_q;
  logic [7:0] byte_q;
  logic [3:0] left_q;

  assign busy_o  = left_q != '0;
  assign crc_o   = ~crc_q;
  assign right_o = crc_q == 32'hDEBB20E3;

  always_ff @(posedge clk_i) begin
    if (busy_o) begin
      crc_q  <= (crc_q >> 1) ^ (crc_q[0] ^ byte_q[0] ? 32'hEDB88320 : '0);
      byte_q <= byte_q >> 1;
      left_q <= left_q - 1'b1;
    end else if (valid_i) begin
      byte_q <= byte_i;
      left_q <= 4'd8;
    end
    if (clear_i) begin
      crc_q  <= '1;
      left_q <= '0;
    end
  end
endmodule
