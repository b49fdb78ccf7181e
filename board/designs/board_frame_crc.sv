// CRC-32, as in zlib, of the words of a frame on the video stream (rtl/shading/voxrt_pixel_packer.sv), the lowest byte
// of a word first: of the frame under way, or of the last one.
module board_frame_crc (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        valid_i,  // The stream hands over a word.
  input  logic        first_i,  // It is the first of a frame.
  input  logic [31:0] word_i,
  output logic [31:0] crc_o     // Two clocks after a word; 0 before the first frame.
);
  // Reflected, as in board_crc32.
  localparam logic [31:0] Polynomial = 32'hEDB88320;

  function automatic logic [31:0] next_crc(logic [31:0] crc, logic [31:0] word);
    logic [31:0] next;
    next = crc ^ word;
    for (int i = 0; i < 32; i++) next = (next >> 1) ^ (next[0] ? Polynomial : '0);
    return next;
  endfunction

  logic valid_q, first_q;
  logic [31:0] word_q, crc_q;

  assign crc_o = ~crc_q;

  always_ff @(posedge clk_i) begin
    valid_q <= valid_i;
    first_q <= first_i;
    word_q  <= word_i;
    if (valid_q) crc_q <= next_crc(first_q ? '1 : crc_q, word_q);
    if (!rst_ni) begin
      valid_q <= 1'b0;
      crc_q   <= '1;
    end
  end
endmodule
