// Ten bits per pixel clock to one pair of pins. The bit clock is five times the pixel clock, which is divided from it.
module gowin_serializer #(
  parameter int unsigned Channels = 4  // Pairs: 1 or more.
) (
  input  logic                     pixel_clk_i,
  input  logic                     pixel_rst_ni,
  input  logic                     bit_clk_i,
  input  logic [Channels-1:0][9:0] words_i,       // Bit 0 goes first.
  output logic [Channels-1:0]      pins_o,
  output logic [Channels-1:0]      pins_no
);
  if (Channels < 1) $error("gowin_serializer: Channels must be 1 or more");

  for (genvar c = 0; c < Channels; c++) begin : gen_channel
    logic serial;

    OSER10 u_serial (
      .D0   (words_i[c][0]),
      .D1   (words_i[c][1]),
      .D2   (words_i[c][2]),
      .D3   (words_i[c][3]),
      .D4   (words_i[c][4]),
      .D5   (words_i[c][5]),
      .D6   (words_i[c][6]),
      .D7   (words_i[c][7]),
      .D8   (words_i[c][8]),
      .D9   (words_i[c][9]),
      .FCLK (bit_clk_i),
      .PCLK (pixel_clk_i),
      .RESET(!pixel_rst_ni),
      .Q    (serial)
    );

    TLVDS_OBUF u_pins (
      .I (serial),
      .O (pins_o[c]),
      .OB(pins_no[c])
    );
  end
endmodule
