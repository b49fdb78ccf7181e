// Lines of a frame on their way to the screen: the core writes them at its own pace, the beam reads them at its pace.
//
// A row of the screen shows the line of the frame that belongs to it, if that is complete when the row begins; else the
// newest line that is complete, or black before the first: pictures never tear. Lines that come too late are skipped.
// The core waits when all 2**LineBits places are taken. A place is free again when the beam has gone on.
module board_line_buffer
  import board_pkg::*;
#(
  parameter int unsigned LineBits   = 4,  // 2**LineBits lines: 4 .. 7.
  // Lines have room for 2**ColumnBits pixels: 10; or 9, for boards that show pixels as 2 x 2 or larger.
  parameter int unsigned ColumnBits = 10
) (
  // System clock.
  input  logic              clk_i,
  input  logic              rst_ni,
  input  logic              valid_i,
  output logic              ready_o,
  input  logic       [23:0] pixel_i,
  input  logic              line_end_i,
  input  logic              drain_i,       // Pixels are dropped.
  input  logic              new_frame_i,   // The pixels of a new frame come from now on; for one clock.
  output logic              row_event_o,
  output row_event_t        row_o,
  // Pixel clock.
  input  logic              pixel_clk_i,
  input  logic              pixel_rst_ni,
  input  logic       [ 1:0] scale_i,
  input  logic              row_begin_i,   // A row begins in a few clocks; for one clock.
  input  logic       [ 9:0] row_i,         // The number of that row.
  input  logic       [ 9:0] column_i,
  output logic       [23:0] pixel_o        // Three clocks after column_i.
);
  if (LineBits < 4 || LineBits > 7) $error("board_line_buffer: LineBits must be 4 to 7 bits");
  if (ColumnBits < 9 || ColumnBits > 10) $error("board_line_buffer: ColumnBits must be 9 or 10");

  localparam int unsigned Lines = 2 ** LineBits;

  // Where the core writes.
  logic [8:0] line_q;  // How many lines of the frame are complete.
  logic [8:0] keep_q;  // The line that the beam shows.
  logic [ColumnBits-1:0] column_q;
  logic ready_q, parity_q, ended_q, restarted_q, accepted;
  logic row_event;
  row_event_t row;
  line_event_t lines;

  assign ready_o  = ready_q || drain_i;
  assign accepted = valid_i && ready_o;

  always_ff @(posedge clk_i) begin
    // This is decided anew after each line. A frame has no more lines than the screen has rows.
    ready_q <= line_q - keep_q < 9'(Lines) && line_q < 9'(Rows) && !(accepted && line_end_i) && !ended_q;
    ended_q <= accepted && line_end_i && !drain_i;
    if (row_event) keep_q <= row.line;
    if (accepted) begin
      if (column_q != '1) column_q <= column_q + 1'b1;
      if (line_end_i) begin
        column_q <= '0;
        line_q   <= line_q + 9'd1;
      end
    end
    if (drain_i) begin
      line_q   <= '0;
      keep_q   <= '0;
      column_q <= '0;
      ready_q  <= 1'b0;
    end
    if (new_frame_i) parity_q <= !parity_q;
    restarted_q <= rst_ni && new_frame_i;
    if (!rst_ni) begin
      parity_q <= 1'b0;
      ended_q  <= 1'b0;
    end
  end

  assign lines       = '{parity: parity_q, lines: line_q};
  assign row_event_o = row_event;
  assign row_o       = row;

  // The lines.
  logic [23:0] data_q[Lines * 2 ** ColumnBits];
  logic write_q;
  logic [LineBits+ColumnBits-1:0] write_place_q, read_place_q;
  logic [23:0] write_pixel_q, read_q;

  always_ff @(posedge clk_i) begin
    write_q       <= accepted && !drain_i;
    write_place_q <= {line_q[LineBits-1:0], column_q};
    write_pixel_q <= pixel_i;
    if (write_q) data_q[write_place_q] <= write_pixel_q;
  end

  // Where the beam reads.
  logic new_lines;
  line_event_t lines_there, lines_q;
  logic parity_seen_q, fresh, blank, has_line, shows_q;
  logic [8:0] wanted, line, shown_q;
  row_event_t row_here;

  assign fresh    = lines_q.parity != parity_seen_q;
  assign blank    = row_i >= 10'(Rows);
  assign wanted   = row_i[8:0] >> scale_i;
  assign has_line = fresh && lines_q.lines != '0 && !blank;
  assign line     = wanted < lines_q.lines ? wanted : lines_q.lines - 9'd1;
  assign row_here = '{
      row: row_i,
      line: has_line ? line : '0,
      underrun: !blank && (!fresh || lines_q.lines <= wanted)
  };

  always_ff @(posedge pixel_clk_i) begin
    if (new_lines) lines_q <= lines_there;
    if (row_begin_i) begin
      shows_q <= has_line;
      shown_q <= line;
      if (row_i == 10'(Rows)) parity_seen_q <= lines_q.parity;
    end
    read_place_q <= {shown_q[LineBits-1:0], ColumnBits'(column_i >> scale_i)};
    read_q       <= data_q[read_place_q];
    pixel_o      <= shows_q ? read_q : '0;
    if (!pixel_rst_ni) begin
      lines_q       <= '0;
      parity_seen_q <= 1'b0;
      shows_q       <= 1'b0;
    end
  end

  board_event #(
    .Width($bits(line_event_t))
  ) u_lines (
    .from_clk_i (clk_i),
    .from_rst_ni(rst_ni),
    .send_i     (ended_q || restarted_q),
    .value_i    (lines),
    .to_clk_i   (pixel_clk_i),
    .received_o (new_lines),
    .value_o    (lines_there)
  );

  board_event #(
    .Width($bits(row_event_t))
  ) u_row (
    .from_clk_i (pixel_clk_i),
    .from_rst_ni(pixel_rst_ni),
    .send_i     (row_begin_i),
    .value_i    (row_here),
    .to_clk_i   (clk_i),
    .received_o (row_event),
    .value_o    (row)
  );
endmodule
