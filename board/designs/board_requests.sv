// Requests of the serial line (docs/ecp5_boards.md): received whole, checked, carried out by the bus, answered.
module board_requests
  import board_pkg::*;
#(
  parameter int unsigned GapBits = 22  // A request is dropped after 2**GapBits clocks without a byte: 1 .. 32.
) (
  input  logic           clk_i,
  input  logic           rst_ni,
  // Serial line.
  input  logic           valid_i,
  input  logic           broken_i,
  input  logic    [ 7:0] byte_i,
  output logic           valid_o,
  input  logic           ready_i,
  output logic    [ 7:0] byte_o,
  // Bus.
  output logic           access_valid_o,
  output access_t        access_o,
  input  logic           done_i,
  input  logic    [31:0] data_i,
  input  logic           refused_i,
  // For one clock.
  output logic           request_done_o,
  output logic           request_bad_o
);
  if (GapBits < 1 || GapBits > 32) $error("board_requests: GapBits must be 1 to 32 bits");

  localparam logic [7:0] RequestMark = 8'h56;
  localparam logic [7:0] AnswerMark = 8'h76;
  localparam logic [7:0] Read = 8'd1;
  localparam logic [7:0] Write = 8'd2;

  typedef enum logic [7:0] {
    Done,
    BadCrc,
    Malformed,
    Refused
  } status_e;

  typedef enum logic [3:0] {
    Idle,
    Header,
    Words,
    Crc,
    Check,
    Fetch,
    Access,
    Answer,
    AnswerHeader,
    AnswerFetch,
    AnswerWords,
    AnswerCrc
  } state_e;

  state_e state_q;
  status_e status_q;
  logic [7:0] operation_q, sequence_q, count_q, word_q;
  logic [23:0] address_q;
  logic [2:0] place_q;  // The place of a byte in the header, a word or the CRC.
  logic broken_q, malformed, last_word, answers_words, receives;
  logic [GapBits-1:0] gap_q;

  assign malformed     = !(operation_q inside {Read, Write}) || count_q == '0 || address_q[1:0] != '0;
  assign last_word     = word_q == count_q - 8'd1;
  assign answers_words = operation_q == Read && status_q inside {Done, Refused};
  assign receives      = state_q inside {Idle, Header, Words, Crc};

  // The words of the request, or of the answer. Never read in the clock in which they are written.
  (* no_rw_check *)
  logic [31:0] words_q[256];
  logic [31:0] fetched_q, shift_q, stored;
  logic stores;

  assign stores = (state_q == Words && valid_i && place_q == 3'd3) || (state_q == Access && done_i);
  assign stored = state_q == Words ? {byte_i, shift_q[31:8]} : data_i;

  always_ff @(posedge clk_i) begin
    if (stores) words_q[word_q] <= stored;
    fetched_q <= words_q[word_q];
  end

  // CRC of what is received, and of what is sent.
  logic crc_clear, crc_valid, crc_busy, crc_right, sent;
  logic [31:0] crc;

  assign sent      = valid_o && ready_i;
  assign crc_clear = !rst_ni || state_q == Answer || (state_q == Idle && !(valid_i && byte_i == RequestMark));
  assign crc_valid = receives ? valid_i : sent && state_q != AnswerCrc;

  board_crc32 u_crc (
    .clk_i,
    .clear_i(crc_clear),
    .valid_i(crc_valid),
    .byte_i (receives ? byte_i : byte_o),
    .busy_o (crc_busy),
    .crc_o  (crc),
    .right_o(crc_right)
  );

  assign valid_o = !crc_busy && state_q inside {AnswerHeader, AnswerWords, AnswerCrc};

  always_comb begin
    byte_o = shift_q[7:0];
    if (state_q == AnswerCrc) byte_o = crc[{place_q[1:0], 3'd0}+:8];
    if (state_q == AnswerHeader) begin
      unique case (place_q[1:0])
        2'd0: byte_o = AnswerMark;
        2'd1: byte_o = status_q;
        2'd2: byte_o = sequence_q;
        2'd3: byte_o = answers_words ? count_q : '0;
      endcase
    end
  end

  assign access_o = '{write: operation_q == Write, address: address_q, data: fetched_q};

  always_ff @(posedge clk_i) begin
    access_valid_o <= 1'b0;
    request_done_o <= 1'b0;
    request_bad_o  <= 1'b0;
    gap_q          <= valid_i || state_q == Idle ? '0 : gap_q + 1'b1;

    unique case (state_q)
      Idle: begin
        place_q  <= 3'd1;
        word_q   <= '0;
        broken_q <= 1'b0;
        if (valid_i && !broken_i && byte_i == RequestMark) state_q <= Header;
      end
      Header: begin
        if (valid_i) begin
          place_q <= place_q + 1'b1;
          unique case (place_q)
            3'd1:    operation_q <= byte_i;
            3'd2:    sequence_q <= byte_i;
            3'd3:    count_q <= byte_i;
            default: address_q <= {byte_i, address_q[23:8]};
          endcase
          if (place_q == 3'd6) begin
            place_q <= '0;
            state_q <= operation_q == Write && count_q != '0 ? Words : Crc;
          end
        end
      end
      Words: begin
        if (valid_i) begin
          shift_q <= {byte_i, shift_q[31:8]};
          place_q <= place_q + 1'b1;
          if (place_q == 3'd3) begin
            place_q <= '0;
            word_q  <= word_q + 1'b1;
            if (last_word) state_q <= Crc;
          end
        end
      end
      Crc: begin
        if (valid_i) begin
          place_q <= place_q + 1'b1;
          if (place_q == 3'd3) state_q <= Check;
        end
      end
      Check: begin
        word_q   <= '0;
        status_q <= Done;
        if (!crc_busy) begin
          state_q <= Fetch;
          if (malformed) status_q <= Malformed;
          if (!crc_right || broken_q) status_q <= BadCrc;
          if (malformed || !crc_right || broken_q) begin
            request_bad_o <= 1'b1;
            state_q       <= Answer;
          end
        end
      end
      // The word that is to be written is there a clock after word_q.
      Fetch: state_q <= Access;
      Access: begin
        access_valid_o <= !done_i;
        if (done_i) begin
          if (refused_i) status_q <= Refused;
          word_q         <= word_q + 1'b1;
          address_q      <= address_q + 24'd4;
          request_done_o <= last_word;
          state_q        <= last_word ? Answer : Fetch;
        end
      end
      Answer: begin
        place_q <= '0;
        word_q  <= '0;
        state_q <= AnswerHeader;
      end
      AnswerHeader: begin
        if (sent) begin
          place_q <= place_q + 1'b1;
          if (place_q == 3'd3) begin
            place_q <= '0;
            state_q <= answers_words ? AnswerFetch : AnswerCrc;
          end
        end
      end
      AnswerFetch: begin
        place_q <= 3'd1;
        shift_q <= fetched_q;
        if (place_q == 3'd1) begin
          place_q <= '0;
          state_q <= AnswerWords;
        end
      end
      AnswerWords: begin
        if (sent) begin
          shift_q <= shift_q >> 8;
          place_q <= place_q + 1'b1;
          if (place_q == 3'd3) begin
            place_q <= '0;
            word_q  <= word_q + 1'b1;
            state_q <= last_word ? AnswerCrc : AnswerFetch;
          end
        end
      end
      default: begin
        if (sent) begin
          place_q <= place_q + 1'b1;
          if (place_q == 3'd3) state_q <= Idle;
        end
      end
    endcase

    if (receives && valid_i && broken_i) broken_q <= 1'b1;
    if (receives && state_q != Idle && gap_q == '1) begin
      request_bad_o <= 1'b1;
      state_q       <= Idle;
    end
    if (!rst_ni) begin
      state_q        <= Idle;
      access_valid_o <= 1'b0;
    end
  end
endmodule
