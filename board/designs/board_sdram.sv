// Controller of an SDR SDRAM of 32 MB (16 bits, 4 banks, 8192 rows, 512 columns): reads and writes lines of 32 bytes.
//
// A line is two bursts of 8, the second with automatic precharge; CAS latency 3. While a line streams, the next one
// waits with its row open already, if its bank is another one: a line each 16 clocks, or 21 or 22 after one in the same
// bank, or from a read to a write. Refreshes wait for the lines under way, each 6.7 us. bench/sdram.py measures 16.4
// clocks per line in a row, 17.8 anywhere. Lines that follow each other are in different banks. Answers come in order.
//
// Counts of clocks hold up to 80 MHz, for parts of speed -7 and faster. board_sdram_pins adds one clock on the way out,
// and one and a half on the way in.
module board_sdram
  import board_pkg::*;
#(
  parameter int unsigned ClockHz   = 57_692_307,  // Hz: 12 to 80 million.
  parameter int unsigned PowerOnUs = 200          // The chip is left alone after power-on, us: 1 .. 50,000.
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               request_valid_i,
  output logic               request_ready_o,
  input  logic               request_write_i,
  input  logic       [ 19:0] request_line_i,
  input  logic       [ 15:0] request_mask_i,   // Which half words are written.
  input  logic       [255:0] request_data_i,
  output logic               done_o,           // For one clock, once per request.
  output logic       [255:0] line_o,           // What was read, with done_o.
  // To the pins.
  output sdram_out_t         sdram_o,
  input  logic       [ 15:0] sdram_dq_i
);
  if (ClockHz < 12_000_000 || ClockHz > 80_000_000) $error("board_sdram: ClockHz must be 12 to 80 million");
  if (PowerOnUs < 1 || PowerOnUs > 50_000) $error("board_sdram: PowerOnUs must be 1 to 50,000 us");

  localparam int unsigned PowerOnClocks = (ClockHz / 1000) * PowerOnUs / 1000;
  // 8192 rows in 64 ms, less what the lines under way take.
  localparam int unsigned RefreshClocks = (ClockHz / 1000) * 64 / 8192 - 80;
  localparam int unsigned CountBits = $clog2(PowerOnClocks + 128);
  localparam int unsigned RefreshBits = $clog2(RefreshClocks + 1);
  localparam logic [12:0] Mode = 13'h033;  // Bursts of 8, sequential, CAS latency 3.
  localparam logic [2:0] RefreshWait = 3'd6;  // tRFC.
  localparam logic [1:0] RowWait = 2'd1;  // tRCD, less the clock that sees the row open.
  localparam logic [3:0] CloseAfterRead = 4'd10;  // Clocks from the last burst's command: the burst, tRP.
  localparam logic [3:0] CloseAfterWrite = 4'd11;  // The burst, tWR, tRP.
  localparam logic [4:0] ReadToWrite = 5'd20;  // The chip has let go of the data.
  localparam int unsigned DoneClocks = 21;  // Clocks from a line's first command to its last half word.

  // {RAS, CAS, WE}, low.
  typedef enum logic [2:0] {
    SetMode   = 3'b000,
    Refresh   = 3'b001,
    Precharge = 3'b010,
    Activate  = 3'b011,
    Write     = 3'b100,
    Read      = 3'b101,
    None      = 3'b111
  } command_e;

  typedef enum logic [1:0] {
    PowerOn,
    Prepare,
    Run
  } state_e;

  state_e state_q;
  command_e command_q;
  logic selected_q, refresh_due_q;
  logic [CountBits-1:0] count_q;
  logic [RefreshBits-1:0] refresh_q;
  logic [2:0] refresh_wait_q;

  // The line that waits.
  logic next_valid_q, next_open_q, next_write_q;
  logic [19:0] next_line_q;
  logic [15:0] next_mask_q;
  logic [255:0] next_data_q;
  logic [1:0] row_wait_q;

  // The line that streams.
  logic streams_q, write_q;
  logic [3:0] step_q;
  logic [6:0] place_q;  // {column / 16, bank}.
  logic [15:0] mask_q, dq_q;
  logic [255:0] data_q;
  logic [4:0] turn_q;  // Clocks until a write may start.

  // Banks.
  logic [3:0] open_q;
  logic [3:0][3:0] closes_q;  // Clocks until the banks may be opened.

  logic [DoneClocks-1:0] under_way_q;
  logic [255:0] line_q;
  logic [1:0] ba_q, dqm_q;
  logic [12:0] a_q;
  logic dq_oe_q;
  logic [15:0] dq_out_q;
  logic starts, second, opens, refreshes;
  logic [1:0] next_bank;

  assign next_bank = next_line_q[1:0];
  assign second = streams_q && step_q == 4'd7;
  assign starts    = next_valid_q && next_open_q && row_wait_q == '0 && (!streams_q || step_q == 4'd15) &&
      (!next_write_q || turn_q == '0);
  assign opens     = next_valid_q && !next_open_q && !second && !open_q[next_bank] && closes_q[next_bank] == '0 &&
      refresh_wait_q == '0;
  assign refreshes = refresh_due_q && !next_valid_q && !streams_q && open_q == '0 && closes_q == '0 &&
      refresh_wait_q == '0;

  assign request_ready_o = state_q == Run && !refresh_due_q && !next_valid_q;

  // Flip-flops are 0 after configuration: the chip is not selected until the first clock out of reset.
  assign sdram_o = {1'b1, !selected_q, command_q, ba_q, a_q, dqm_q, dq_oe_q, dq_out_q};
  assign line_o  = line_q;

  always_ff @(posedge clk_i) begin
    command_q     <= None;
    selected_q    <= 1'b1;
    dqm_q   <= '0;
    dq_oe_q <= 1'b0;
    dq_q          <= sdram_dq_i;
    line_q        <= {dq_q, line_q[255:16]};
    under_way_q   <= {under_way_q[DoneClocks-2:0], 1'b0};
    done_o        <= under_way_q[DoneClocks-1];
    refresh_q     <= refresh_q - 1'b1;
    if (refresh_q == '0) begin
      refresh_q     <= RefreshBits'(RefreshClocks);
      refresh_due_q <= 1'b1;
    end
    if (refresh_wait_q != '0) refresh_wait_q <= refresh_wait_q - 1'b1;
    if (row_wait_q != '0) row_wait_q <= row_wait_q - 1'b1;
    if (turn_q != '0) turn_q <= turn_q - 1'b1;
    for (int unsigned b = 0; b < 4; b++) if (closes_q[b] != '0) closes_q[b] <= closes_q[b] - 1'b1;
    count_q <= count_q - 1'b1;

    unique case (state_q)
      PowerOn: begin
        dqm_q <= '1;
        if (count_q == '0) begin
          count_q <= CountBits'(99);
          state_q <= Prepare;
        end
      end
      // All banks closed, eight refreshes ten clocks apart, the mode.
      Prepare: begin
        a_q  <= 13'h400;
        ba_q <= '0;
        unique case (count_q)
          CountBits'(95): command_q <= Precharge;
          CountBits'(90), CountBits'(80), CountBits'(70), CountBits'(60), CountBits'(50), CountBits'(40),
          CountBits'(30), CountBits'(20): command_q <= Refresh;
          CountBits'(10): begin
            command_q <= SetMode;
            a_q <= Mode;
          end
          CountBits'(0): state_q <= Run;
          default: ;
        endcase
      end
      default: begin
        if (request_valid_i && request_ready_o) begin
          next_valid_q <= 1'b1;
          next_open_q  <= 1'b0;
          next_write_q <= request_write_i;
          next_line_q  <= request_line_i;
          next_mask_q  <= request_mask_i;
          next_data_q  <= request_data_i;
        end else if (starts) begin
          next_valid_q <= 1'b0;
        end

        step_q <= step_q + 4'd1;
        if (step_q == 4'd15) streams_q <= 1'b0;
        if (streams_q && step_q != 4'd15 && write_q) begin
          dq_oe_q <= 1'b1;
          dq_out_q    <= data_q[15:0];
          dqm_q   <= {2{!mask_q[0]}};
        end
        data_q <= data_q >> 16;
        mask_q <= mask_q >> 1;

        if (starts) begin
          streams_q      <= 1'b1;
          step_q         <= '0;
          write_q        <= next_write_q;
          place_q        <= next_line_q[6:0];
          under_way_q[0] <= 1'b1;
          command_q      <= next_write_q ? Write : Read;
          ba_q     <= next_bank;
          a_q      <= {4'd0, next_line_q[6:2], 4'd0};
          mask_q         <= next_mask_q >> 1;
          data_q         <= next_data_q >> 16;
          dq_oe_q  <= next_write_q;
          dq_out_q     <= next_data_q[15:0];
          dqm_q    <= next_write_q ? {2{!next_mask_q[0]}} : '0;
          if (!next_write_q) turn_q <= ReadToWrite;
        end else if (second) begin
          command_q              <= write_q ? Write : Read;
          ba_q             <= place_q[1:0];
          a_q              <= {2'b00, 1'b1, 1'b0, place_q[6:2], 1'b1, 3'd0};
          open_q[place_q[1:0]]   <= 1'b0;
          closes_q[place_q[1:0]] <= write_q ? CloseAfterWrite : CloseAfterRead;
        end else if (opens) begin
          command_q         <= Activate;
          ba_q        <= next_bank;
          a_q         <= next_line_q[19:7];
          next_open_q       <= 1'b1;
          open_q[next_bank] <= 1'b1;
          row_wait_q        <= RowWait;
        end else if (refreshes) begin
          command_q      <= Refresh;
          refresh_wait_q <= RefreshWait;
          refresh_due_q  <= 1'b0;
        end
      end
    endcase
    if (!rst_ni) begin
      state_q        <= PowerOn;
      selected_q     <= 1'b0;
      command_q      <= None;
      count_q        <= CountBits'(PowerOnClocks);
      refresh_q      <= RefreshBits'(RefreshClocks);
      refresh_due_q  <= 1'b0;
      refresh_wait_q <= '0;
      next_valid_q   <= 1'b0;
      next_open_q    <= 1'b0;
      streams_q      <= 1'b0;
      open_q         <= '0;
      closes_q       <= '0;
      turn_q         <= '0;
      row_wait_q     <= '0;
      under_way_q    <= '0;
      done_o         <= 1'b0;
    end
  end
endmodule
