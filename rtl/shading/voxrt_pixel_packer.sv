// Packs pixels of 24 bits into words of 32 bits as AXI4-Stream video: 4 pixels in 3 words. A VDMA writes such words
// into a frame buffer without gaps. The lowest byte of a word is the first; the order of a pixel's bytes is green,
// blue, red:
//
//   word     31:24  23:16  15:8   7:0
//   0        G1     R0     B0     G0
//   1        B2     G2     R1     B1
//   2        R3     B3     G3     R2
//
// Each line starts a new word: where the width is no multiple of 4, the line's last word has null bytes, which tkeep
// marks and which are zero. tuser marks the first word of a frame, tlast the last of a line.
`include "voxrt_assert.svh"

module voxrt_pixel_packer
  import voxrt_pkg::*;
(
  input  logic           clk_i,
  input  logic           rst_ni,
  input  logic           valid_i,
  output logic           ready_o,
  input  colour_t        colour_i,
  input  logic           first_i,        // First pixel of the frame.
  input  logic           line_end_i,
  output logic           m_axis_tvalid,
  input  logic           m_axis_tready,
  output logic    [31:0] m_axis_tdata,
  output logic    [ 3:0] m_axis_tkeep,
  output logic           m_axis_tuser,
  output logic           m_axis_tlast
);
  logic [23:0] kept_q;  // Bytes that did not fit the last word, the first one lowest.
  logic [1:0] kept_bytes_q;
  logic kept_first_q;
  logic flush_q;  // What is kept is the line's last word.
  logic valid_q, user_q, last_q;
  logic [31:0] data_q;
  logic [3:0] keep_q;

  logic free, accepts;
  logic [23:0] pixel;
  logic [47:0] joined;

  assign free    = !valid_q || m_axis_tready;
  assign ready_o = free && !flush_q;
  assign accepts = valid_i && ready_o;
  assign pixel   = {colour_i.red, colour_i.blue, colour_i.green};

  always_comb begin
    unique case (kept_bytes_q)
      2'd0: joined = {24'd0, pixel};
      2'd1: joined = {16'd0, pixel, kept_q[7:0]};
      2'd2: joined = {8'd0, pixel, kept_q[15:0]};
      2'd3: joined = {pixel, kept_q};
    endcase
  end

  always_ff @(posedge clk_i) begin
    if (m_axis_tready) valid_q <= 1'b0;
    if (accepts) begin
      data_q <= joined[31:0];
      user_q <= kept_bytes_q == '0 ? first_i : kept_first_q;
      if (kept_bytes_q == '0) begin
        // Three bytes: a word only at the line's end.
        kept_q       <= pixel;
        kept_first_q <= first_i;
        kept_bytes_q <= line_end_i ? 2'd0 : 2'd3;
        keep_q       <= 4'b0111;
        valid_q      <= line_end_i;
        last_q       <= line_end_i;
      end else begin
        kept_q       <= {8'd0, joined[47:32]};
        kept_first_q <= 1'b0;
        kept_bytes_q <= kept_bytes_q - 2'd1;
        keep_q       <= 4'b1111;
        valid_q      <= 1'b1;
        last_q       <= line_end_i && kept_bytes_q == 2'd1;
        flush_q      <= line_end_i && kept_bytes_q != 2'd1;
      end
    end
    if (flush_q && free) begin
      data_q       <= {16'd0, kept_q[15:8] & {8{kept_bytes_q[1]}}, kept_q[7:0]};
      keep_q       <= {2'b00, kept_bytes_q[1], 1'b1};
      user_q       <= 1'b0;
      valid_q      <= 1'b1;
      last_q       <= 1'b1;
      flush_q      <= 1'b0;
      kept_bytes_q <= '0;
    end
    if (!rst_ni) begin
      valid_q      <= 1'b0;
      flush_q      <= 1'b0;
      kept_bytes_q <= '0;
    end
  end

  assign m_axis_tvalid = valid_q;
  assign m_axis_tdata  = data_q;
  assign m_axis_tkeep  = keep_q;
  assign m_axis_tuser  = user_q;
  assign m_axis_tlast  = last_q;

  `VOXRT_ASSERT_STABLE(OfferStays, m_axis_tvalid, m_axis_tready, {
                       m_axis_tdata, m_axis_tkeep, m_axis_tuser, m_axis_tlast})
endmodule
