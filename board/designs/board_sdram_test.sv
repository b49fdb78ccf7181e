// Tests the lines of an SDRAM in three stages, one after the other: 256 lines with all bits of the address, the whole
// memory, the whole memory with all bits inverted. A stage writes all of its lines, then reads all.
module board_sdram_test #(
  parameter int unsigned LineBits = 20  // Stages 1 and 2 test 2**LineBits lines: 8 .. 20.
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  // The controller.
  output logic         request_valid_o,
  input  logic         request_ready_i,
  output logic         request_write_o,
  output logic [ 19:0] request_line_o,
  output logic [255:0] request_data_o,
  input  logic         done_i,
  input  logic [255:0] line_i,
  // Results.
  output logic [  1:0] stage_o,          // 3: all stages have ended.
  output logic [ 31:0] lines_o,          // Lines that were compared.
  output logic [ 31:0] wrong_o,          // Those that were wrong.
  output logic [ 15:0] bits_o,           // Bits of the data that were wrong in any half word.
  output logic [ 19:0] first_o           // The first wrong line, if any.
);
  if (LineBits < 8 || LineBits > 20) $error("board_sdram_test: LineBits must be 8 to 20");

  localparam logic [19:0] QuickLast = 20'd255;
  localparam logic [19:0] WholeLast = 20'((21'd1 << LineBits) - 21'd1);

  // The line with a number of a stage.
  function automatic logic [19:0] line_of(logic [19:0] number, logic quick);
    line_of = quick ? {number[3:0], number[7:0], number[7:0]} : number;
  endfunction

  // Neighbouring half words, and lines whose addresses differ in one bit, differ in several bits.
  function automatic logic [255:0] pattern_of(logic [19:0] line, logic inverts);
    for (int unsigned h = 0; h < 16; h++) begin
      pattern_of[16*h+:16] = line[15:0] ^ {line[7:0], line[19:12]} ^ {line[11:4], 4'(h), line[19:16]} ^
          {16{h[0] ^ inverts}};
    end
  endfunction

  logic reads_q, issued_q, quick, inverts, last_issue, last_done;
  logic [19:0] issue_q, done_q, last, line, expected_line;

  assign quick         = stage_o == 2'd0;
  assign inverts       = stage_o == 2'd2;
  assign last          = quick ? QuickLast : WholeLast;
  assign line          = line_of(issue_q, quick);
  assign expected_line = line_of(done_q, quick);
  assign last_issue    = issue_q == last;
  assign last_done     = done_i && done_q == last;

  assign request_valid_o = stage_o != 2'd3 && !issued_q;
  assign request_write_o = !reads_q;
  assign request_line_o  = line;
  assign request_data_o  = pattern_of(line, inverts);

  // A read line, compared in two clocks.
  logic compares_q, compared_q;
  logic [255:0] difference_q;
  logic [19:0] line_q[1:2];
  logic [15:0] bits, bits_q;

  always_comb begin
    bits = '0;
    for (int unsigned h = 0; h < 16; h++) bits |= difference_q[16*h+:16];
  end

  always_ff @(posedge clk_i) begin
    if (request_valid_o && request_ready_i) begin
      issue_q  <= issue_q + 1'b1;
      issued_q <= last_issue;
    end
    if (done_i) done_q <= done_q + 1'b1;
    if (last_done) begin
      issue_q  <= '0;
      done_q   <= '0;
      issued_q <= 1'b0;
      reads_q  <= !reads_q;
      if (reads_q) stage_o <= stage_o + 1'b1;
    end

    compares_q   <= done_i && reads_q;
    difference_q <= line_i ^ pattern_of(expected_line, inverts);
    line_q[1]    <= expected_line;
    compared_q   <= compares_q;
    bits_q       <= bits;
    line_q[2]    <= line_q[1];
    if (compared_q) begin
      lines_o <= lines_o + 1'b1;
      bits_o  <= bits_o | bits_q;
      if (bits_q != '0) begin
        wrong_o <= wrong_o + 1'b1;
        if (wrong_o == '0) first_o <= line_q[2];
      end
    end
    if (!rst_ni) begin
      stage_o    <= '0;
      reads_q    <= 1'b0;
      issued_q   <= 1'b0;
      issue_q    <= '0;
      done_q     <= '0;
      compares_q <= 1'b0;
      compared_q <= 1'b0;
      lines_o    <= '0;
      wrong_o    <= '0;
      bits_o     <= '0;
      first_o    <= '0;
    end
  end
endmodule
