// Ends a frame that a soft reset has cut: black words up to the last line's end, so that a receiver such as a VDMA stays
// in step. Between voxrt_pixel_packer and the stream; a word is a clock later.
//
// The word that is offered when the reset comes stays. A frame whose first word was not offered yet is dropped whole.
// The next frame waits until this one has ended.
`include "voxrt_assert.svh"

module voxrt_frame_end (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        drop_i,         // For one clock: the packer has dropped what it held.
  input  logic        start_i,        // A frame starts, of this size; 0 counts as 1.
  input  logic [11:0] width_i,
  input  logic [11:0] height_i,
  // From the packer.
  input  logic        s_axis_tvalid,
  output logic        s_axis_tready,
  input  logic [31:0] s_axis_tdata,
  input  logic [ 3:0] s_axis_tkeep,
  input  logic        s_axis_tuser,
  input  logic        s_axis_tlast,
  // The stream.
  output logic        m_axis_tvalid,
  input  logic        m_axis_tready,
  output logic [31:0] m_axis_tdata,
  output logic [ 3:0] m_axis_tkeep,
  output logic        m_axis_tuser,
  output logic        m_axis_tlast
);
  function automatic logic [11:0] at_least_one(logic [11:0] side);
    return side == '0 ? 12'd1 : side;
  endfunction

  logic [11:0] started_width_q, started_height_q;  // Of the frame whose first word is to come.
  logic [13:0] bytes_q;  // Of a line of the frame whose words come.
  logic [11:0] line_words, left_q;  // Words of a line, and those of the present line that are to come.
  logic [11:0] lines_q;  // Lines that are to come, with the present one.
  logic open_q, filling_q, free, takes, fills, last_word;
  logic [3:0] last_keep;

  assign free          = !m_axis_tvalid || m_axis_tready;
  assign s_axis_tready = free && !filling_q && !drop_i;
  assign takes         = s_axis_tvalid && s_axis_tready;
  assign fills         = filling_q && free;
  assign line_words    = bytes_q[13:2] + 12'(bytes_q[1:0] != '0);
  assign last_word     = left_q == 12'd1;
  assign last_keep     = bytes_q[1:0] == '0 ? 4'b1111 : 4'b1111 >> (3'd4 - 3'(bytes_q[1:0]));

  logic [13:0] started_bytes;
  assign started_bytes = 14'(started_width_q) + {1'b0, started_width_q, 1'b0};

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      started_width_q  <= at_least_one(width_i);
      started_height_q <= at_least_one(height_i);
    end
    if (m_axis_tready) m_axis_tvalid <= 1'b0;
    if (takes) begin
      m_axis_tvalid <= 1'b1;
      m_axis_tdata  <= s_axis_tdata;
      m_axis_tkeep  <= s_axis_tkeep;
      m_axis_tuser  <= s_axis_tuser;
      m_axis_tlast  <= s_axis_tlast;
    end
    if (fills) begin
      m_axis_tvalid <= 1'b1;
      m_axis_tdata  <= '0;
      m_axis_tkeep  <= last_word ? last_keep : 4'b1111;
      m_axis_tuser  <= 1'b0;
      m_axis_tlast  <= last_word;
    end
    if (takes || fills) begin
      left_q <= left_q - 1'b1;
      if (last_word) begin
        left_q  <= line_words;
        lines_q <= lines_q - 1'b1;
        if (lines_q == 12'd1) begin
          open_q    <= 1'b0;
          filling_q <= 1'b0;
        end
      end
    end
    if (takes && s_axis_tuser) begin
      bytes_q <= started_bytes;
      lines_q <= started_height_q;
      left_q  <= started_bytes[13:2] + 12'(started_bytes[1:0] != '0) - 1'b1;
      open_q  <= 1'b1;
      if (s_axis_tlast) begin
        left_q  <= 12'd1;
        lines_q <= started_height_q - 1'b1;
        open_q  <= started_height_q != 12'd1;
      end
    end
    if (drop_i && open_q && !(fills && last_word && lines_q == 12'd1)) filling_q <= 1'b1;
    if (!rst_ni) begin
      m_axis_tvalid <= 1'b0;
      open_q        <= 1'b0;
      filling_q     <= 1'b0;
    end
  end

  `VOXRT_ASSERT_STABLE(OfferStays, m_axis_tvalid, m_axis_tready, {
                       m_axis_tdata, m_axis_tkeep, m_axis_tuser, m_axis_tlast})
endmodule
