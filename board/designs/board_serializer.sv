// Ten bits per pixel clock to one pin, two per bit clock (DDR). The bit clock is five times the pixel clock, from the same
// PLL.
module board_serializer #(
  parameter int unsigned Channels = 4  // Pins: 1 or more.
) (
  input  logic                     pixel_clk_i,
  input  logic                     pixel_rst_ni,
  input  logic                     bit_clk_i,
  input  logic [Channels-1:0][9:0] words_i,       // Bit 0 goes first.
  output logic [Channels-1:0]      pins_o
);
  if (Channels < 1) $error("board_serializer: Channels must be 1 or more");

  logic pixel_toggle_q;
  always_ff @(posedge pixel_clk_i) pixel_toggle_q <= pixel_rst_ni && !pixel_toggle_q;

  // Words have been still for two bit clocks when they are taken.
  (* ASYNC_REG = "TRUE" *)
  logic [2:0] toggles_q;
  logic load;

  always_ff @(posedge bit_clk_i) begin
    toggles_q <= {toggles_q[1:0], pixel_toggle_q};
    load      <= toggles_q[2] != toggles_q[1];
  end

  for (genvar c = 0; c < Channels; c++) begin : gen_channel
    logic [9:0] bits_q;

    always_ff @(posedge bit_clk_i) bits_q <= load ? words_i[c] : {2'b00, bits_q[9:2]};

    ODDRX1F u_pin (
      .D0  (bits_q[0]),
      .D1  (bits_q[1]),
      .SCLK(bit_clk_i),
      .RST (1'b0),
      .Q   (pins_o[c])
    );
  end
endmodule
