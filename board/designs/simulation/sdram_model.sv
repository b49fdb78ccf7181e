// A model of an SDR SDRAM of 32 MB (16 bits, 4 banks, 8192 rows, 512 columns) that stops at the first broken rule.
//
// Rules: what is done first after power-on, tRCD, tRP, tRC, tRAS, tRFC, tMRD, tWR, the time between refreshes, a bank
// that is open or not, and both sides driving the data. Times are of speed -7 parts, in picoseconds. Bursts of 8 only.
//
// Times of rules are counted in clocks of PeriodPs. Data are timed by ticks, every change of tick_i: 1.333 ns on a board.
// What is read is there AnswerTicks after the clock edge that CAS latency counts from, and stays HoldTicks beyond the next:
// between, it is noise. These have the way of the clock to the chip, and the data's way back, in them.
module sdram_model #(
  parameter int unsigned PeriodPs      = 13_333,
  parameter int unsigned PowerOnPs     = 200_000_000,
  parameter int unsigned TrcdPs        = 20_000,
  parameter int unsigned TrpPs         = 20_000,
  parameter int unsigned TrcPs         = 65_000,
  parameter int unsigned TrasPs        = 45_000,
  parameter int unsigned TrfcPs        = 66_000,
  parameter int unsigned TwrPs         = 15_000,
  parameter int unsigned TrrdPs        = 15_000,
  parameter int unsigned RefreshPs     = 7_812_500,
  parameter int unsigned AnswerTicks   = 9,
  parameter int unsigned HoldTicks     = 3,
  parameter bit          ChecksDrivers = 1'b1          // dq_driven_i is known.
) (
  input  logic        tick_i,
  input  logic        clk_i,
  input  logic        cke_i,
  input  logic        cs_ni,
  input  logic        ras_ni,
  input  logic        cas_ni,
  input  logic        we_ni,
  input  logic [ 1:0] ba_i,
  input  logic [12:0] a_i,
  input  logic [ 1:0] dqm_i,
  input  logic        dq_driven_i,
  input  logic [15:0] dq_i,
  output logic        dq_driven_o,
  output logic [15:0] dq_o
);
  logic [15:0] memory[1<<24];

  longint unsigned now = 0;  // In picoseconds.
  longint unsigned activated[4], closed[4];  // Automatic precharge closes a bank at its beginning.
  longint unsigned refreshed = 0, mode_set = 0, written = 0;
  logic [12:0] row[4];
  logic [3:0] open = '0, closing = '0;
  logic has_mode = 1'b0, precharged = 1'b0;
  int unsigned refreshes = 0, latency = 0;

  int unsigned beats = 0;  // Beats that the burst still has.
  logic writes, automatic_precharge;
  logic [1:0] bank;
  logic [8:0] column;
  logic pipe_valid[4];
  logic [15:0] pipe[4];
  logic answer_valid = 1'b0, clk_before = 1'b0;
  logic [15:0] answer;
  int unsigned ticks = 0;

  task automatic rule(input logic holds, input string name);
    if (!holds) begin
      $fdisplay(32'h8000_0002, "SDRAM: %s, at %0d ps", name, now);
      $fatal(1);
    end
  endtask

  initial begin
    for (int i = 0; i < 4; i++) begin
      activated[i]  = 0;
      closed[i]     = 0;
      pipe_valid[i] = 1'b0;
    end
  end

  task automatic clock_edge();
    now += 64'(PeriodPs);
    // Automatic precharge.
    for (int i = 0; i < 4; i++) begin
      if (closing[i] && now >= closed[i]) begin
        rule(closed[i] >= activated[i] + 64'(TrasPs), "tRAS");
        open[i]    = 1'b0;
        closing[i] = 1'b0;
      end
    end
    if (has_mode) rule(now - refreshed <= 64'(RefreshPs), "refresh is late");

    if (cke_i && !cs_ni) begin
      if ({ras_ni, cas_ni, we_ni} != 3'b111) begin
        rule(now >= 64'(PowerOnPs), "a command too early after power-on");
        rule(refreshes == 0 || now - refreshed >= 64'(TrfcPs), "tRFC");
        rule(!has_mode || now - mode_set >= 64'(2 * PeriodPs), "tMRD");
      end
      unique case ({
        ras_ni, cas_ni, we_ni
      })
        3'b000: begin
          rule(open == '0 && precharged && refreshes >= 8, "the mode is set before precharge and 8 refreshes");
          rule(a_i[2:0] == 3'd3 && !a_i[3] && (a_i[6:4] == 3'd2 || a_i[6:4] == 3'd3), "mode");
          latency  = 32'(a_i[6:4]);
          has_mode = 1'b1;
          mode_set = now;
        end
        3'b001: begin
          rule(open == '0 && precharged, "refresh with an open bank");
          for (int i = 0; i < 4; i++) rule(now >= closed[i] + 64'(TrpPs), "tRP before refresh");
          refreshed = now;
          refreshes++;
        end
        3'b010: begin
          precharged = 1'b1;
          for (int i = 0; i < 4; i++) begin
            if ((a_i[10] || ba_i == 2'(i)) && open[i]) begin
              rule(now >= activated[i] + 64'(TrasPs), "tRAS");
              rule(now >= written + 64'(TwrPs), "tWR");
              open[i] = 1'b0;
            end
            if (a_i[10] || ba_i == 2'(i)) closed[i] = now;
          end
        end
        3'b011: begin
          rule(has_mode, "activate before the mode is set");
          rule(!open[ba_i], "activate of an open bank");
          rule(activated[ba_i] == 0 || now >= activated[ba_i] + 64'(TrcPs), "tRC");
          rule(now >= closed[ba_i] + 64'(TrpPs), "tRP");
          for (int i = 0; i < 4; i++) rule(activated[i] == 0 || now >= activated[i] + 64'(TrrdPs), "tRRD");
          open[ba_i]      = 1'b1;
          row[ba_i]       = a_i;
          activated[ba_i] = now;
        end
        3'b100, 3'b101: begin
          rule(open[ba_i] && !closing[ba_i], "a burst in a closed bank");
          rule(now >= activated[ba_i] + 64'(TrcdPs), "tRCD");
          rule(beats == 0, "a burst in a burst");
          beats               = 8;
          writes              = !we_ni;
          bank                = ba_i;
          column              = a_i[8:0];
          automatic_precharge = a_i[10];
          if (a_i[10]) begin
            closing[ba_i] = 1'b1;
            closed[ba_i]  = now + 64'(8 * PeriodPs);
            if (!we_ni) closed[ba_i] = now + 64'(7 * PeriodPs) + 64'(TwrPs);
          end
        end
        3'b110: rule(1'b0, "burst stop");
        default: ;
      endcase
    end

    // Data.
    for (int i = 3; i > 0; i--) begin
      pipe_valid[i] = pipe_valid[i-1];
      pipe[i]       = pipe[i-1];
    end
    pipe_valid[0] = 1'b0;
    if (beats != 0) begin
      if (writes) begin
        rule(!ChecksDrivers || dq_driven_i, "nobody drives what is written");
        if (!dqm_i[0]) memory[{bank, row[bank], column}][7:0] = dq_i[7:0];
        if (!dqm_i[1]) memory[{bank, row[bank], column}][15:8] = dq_i[15:8];
        written = now;
      end else begin
        rule(dqm_i == '0, "a read with a mask");
        pipe_valid[0] = 1'b1;
        pipe[0]       = memory[{bank, row[bank], column}];
      end
      column[2:0]++;
      beats--;
    end
    answer_valid = latency != 0 && pipe_valid[latency-1];
    answer       = pipe[latency-1];
  endtask

  always @(tick_i) begin
    ticks++;
    if (clk_i && !clk_before) begin
      ticks = 0;
      clock_edge();
    end
    clk_before = clk_i;
    if (ticks == HoldTicks) begin
      dq_driven_o = 1'b0;
      dq_o        = 16'hDEAD;
    end
    if (ticks == AnswerTicks) begin
      dq_driven_o = answer_valid;
      dq_o        = answer_valid ? answer : 16'hDEAD;
    end
    rule(!ChecksDrivers || !(dq_driven_o && dq_driven_i), "both sides drive the data");
  end
endmodule
